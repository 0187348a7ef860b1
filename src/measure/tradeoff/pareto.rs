//! What nothing beats.

use super::report::Row;

/// Errors that differ by less than this share count as the same.
const SAME: f64 = 0.01;

/// Marks the rows that no other beats: is faster and not noticeably worse, or better and no slower.
pub fn mark_front(rows: &mut [Row], error: impl Fn(&Row) -> f64) {
    let points: Vec<[f64; 2]> = rows.iter().map(|row| [row.times.median_s, error(row)]).collect();
    let beats = |[t, e]: &[f64; 2], [time, error]: &[f64; 2]| {
        t <= time && *e <= error * (1.0 + SAME) && (t < time || e < error)
    };
    for (row, point) in rows.iter_mut().zip(&points) {
        row.on_front = !points.iter().any(|other| beats(other, point));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::tradeoff::report::tests::row;

    fn front(points: &[[f64; 2]]) -> Vec<bool> {
        let mut rows: Vec<Row> = points.iter().map(|&[time, error]| row(time, error)).collect();
        mark_front(&mut rows, |row| row.figures.rmse);
        rows.iter().map(|row| row.on_front).collect()
    }

    #[test]
    fn only_what_is_faster_or_better_than_all_others_is_left() {
        assert_eq!(
            front(&[[1.0, 0.5], [2.0, 0.1], [2.0, 0.2], [3.0, 0.1], [0.5, 0.9]]),
            [true, true, false, false, true]
        );
        assert_eq!(front(&[[1.0, 0.5], [2.0, 0.499]]), [true, false], "no gain that could be seen");
        assert_eq!(front(&[[1.0, 0.5], [1.0, 0.5]]), [true, true], "equal ones do not beat each other");
        assert_eq!(front(&[]), [false; 0]);
    }
}
