//! Frame numbers: `7`, `1-100`, `1-100x10`, `1,3,5..9`.

use super::axis::MOST_PICTURES;

/// The frames that `text` lists, in the order written, each once.
pub(super) fn parse(text: &str) -> Result<Vec<i64>, String> {
    let mut frames = Vec::new();
    for part in text.split(',').map(str::trim) {
        range(part, &mut frames)?;
    }
    let mut seen = std::collections::HashSet::with_capacity(frames.len());
    match frames.iter().find(|&&frame| !seen.insert(frame)) {
        Some(frame) => Err(format!("has frame {frame} twice")),
        None => Ok(frames),
    }
}

fn range(part: &str, frames: &mut Vec<i64>) -> Result<(), String> {
    let bad = || format!("`{part}` is not a range of frames: expected such as 1-100, 1-100x10 or 1,3,5..9");
    let number = |text: &str| text.trim().parse::<i64>().map_err(|_| bad());
    let (span, step) = match part.split_once('x') {
        Some((span, step)) => (span, number(step)?),
        None => (part, 1),
    };
    // A leading minus belongs to the number.
    let dash = span.char_indices().skip(1).find(|&(_, c)| c == '-').map(|(at, _)| at);
    let (first, last) = match (span.split_once(".."), dash) {
        (Some((first, last)), _) => (number(first)?, number(last)?),
        (None, Some(at)) => (number(&span[..at])?, number(&span[at + 1..])?),
        (None, None) => (number(span)?, number(span)?),
    };
    if step < 1 || last < first {
        return Err(format!("`{part}` runs backwards: the first frame comes first, the step is at least 1"));
    }
    let count = last.abs_diff(first) / step.unsigned_abs() + 1;
    if count as usize > MOST_PICTURES || frames.len() + count as usize > MOST_PICTURES {
        return Err(format!("`{part}` makes more than {MOST_PICTURES} frames"));
    }
    frames.extend((0..count as i64).map(|k| first + k * step));
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_steps_and_lists() {
        assert_eq!(parse("7").unwrap(), [7]);
        assert_eq!(parse("1-4").unwrap(), [1, 2, 3, 4]);
        assert_eq!(parse("1,3,5..9").unwrap(), [1, 3, 5, 6, 7, 8, 9]);
        assert_eq!(parse(" 0-20x10 , 5 ").unwrap(), [0, 10, 20, 5]);
        assert_eq!(parse("-2--1").unwrap(), [-2, -1]);
        assert_eq!(parse("-1..1").unwrap(), [-1, 0, 1]);
    }

    #[test]
    fn bad_ranges_are_named() {
        for (text, word) in [
            ("", "not a range"),
            ("a", "`a`"),
            ("1-", "`1-`"),
            ("5-1", "backwards"),
            ("1-9x0", "backwards"),
            ("1-3,2", "frame 2 twice"),
            ("0-9223372036854775807", "more than"),
        ] {
            let error = parse(text).unwrap_err();
            assert!(error.contains(word), "{text}: {error}");
        }
    }
}
