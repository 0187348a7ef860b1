//! Names of output files.

use std::path::{Component, Path};

use super::store::STATE_ENDING;

/// What stands for what in one picture's paths.
pub(super) struct Names<'a> {
    /// `{name}`: the job.
    pub(super) job: &'a str,
    /// `####`, where the job has frames.
    pub(super) frame: Option<i64>,
    /// `{camera}`, where the job has several.
    pub(super) camera: Option<&'a str>,
    /// `{sweep}`: number of the choice, from 0.
    pub(super) choice: usize,
    /// `{key}`: the values chosen.
    pub(super) values: &'a [(String, toml::Value)],
}

/// The path of a picture's file.
///
/// Where there are frames and the pattern has no `#`, `.####` goes before the ending.
pub(super) fn path(pattern: &str, names: &Names) -> Result<String, String> {
    let pattern = match names.frame {
        Some(_) if !pattern.contains('#') => with_frame(pattern),
        _ => pattern.to_owned(),
    };
    let path = braces(&hashes(&pattern, names.frame.unwrap_or(0)), names)?;
    if !is_below(&path) {
        return Err(format!(
            "output `{}` must lie below the output folder: neither absolute nor with `..` or the character 0",
            path.escape_debug()
        ));
    }
    let path = plain(&path);
    match state_above(&path) {
        Some(folder) => {
            Err(format!("output `{path}` must not lie in `{folder}`: such folders hold the state of batches"))
        }
        None => Ok(path),
    }
}

/// The folder of a path, if any, that a batch may keep its state in: `NAME.octray`, in any case of letters.
fn state_above(path: &str) -> Option<&str> {
    let (folders, _) = path.rsplit_once('/')?;
    folders.split('/').find(|folder| folder.to_lowercase().ends_with(STATE_ENDING))
}

/// The path without `.` and doubled separators: one spelling for one file.
fn plain(path: &str) -> String {
    path.split('/').filter(|part| !matches!(*part, "" | ".")).collect::<Vec<_>>().join("/")
}

/// Whether a path stays in the folder that it starts from, and out of the state of batches.
pub(super) fn is_free(path: &str) -> bool {
    is_below(path) && state_above(path).is_none()
}

fn is_below(path: &str) -> bool {
    let plain = |part: Component| matches!(part, Component::Normal(_) | Component::CurDir);
    !path.is_empty() && !path.contains('\0') && Path::new(path).components().all(plain)
}

fn with_frame(pattern: &str) -> String {
    let name = pattern.rfind('/').map_or(0, |slash| slash + 1);
    match pattern[name..].rfind('.') {
        Some(dot) => format!("{}.####{}", &pattern[..name + dot], &pattern[name + dot..]),
        None => format!("{pattern}.####"),
    }
}

/// Every run of `#` becomes the frame with at least as many digits.
fn hashes(pattern: &str, frame: i64) -> String {
    let mut text = String::new();
    let mut rest = pattern;
    while let Some(at) = rest.find('#') {
        let digits = rest[at..].bytes().take_while(|&b| b == b'#').count();
        let width = digits + usize::from(frame < 0);
        text.push_str(&rest[..at]);
        text.push_str(&format!("{frame:0width$}"));
        rest = &rest[at + digits..];
    }
    text + rest
}

fn braces(pattern: &str, names: &Names) -> Result<String, String> {
    let mut text = String::new();
    let mut rest = pattern;
    while let Some(at) = rest.find('{') {
        let end = rest[at..].find('}').ok_or_else(|| format!("output `{pattern}`: `{{` without `}}`"))? + at;
        text.push_str(&rest[..at]);
        text.push_str(&named(&rest[at + 1..end], names).map_err(|e| format!("output `{pattern}`: {e}"))?);
        rest = &rest[end + 1..];
    }
    Ok(text + rest)
}

fn named(name: &str, names: &Names) -> Result<String, String> {
    match name {
        "name" => return Ok(names.job.to_owned()),
        "sweep" => return Ok(format!("{:04}", names.choice)),
        "camera" => return names.camera.map(file_name).ok_or("`{camera}`: the job has no [[camera]]".into()),
        _ => {}
    }
    match names.values.iter().find(|(key, _)| key == name) {
        Some((_, value)) => Ok(file_name(&value.to_string())),
        None => {
            let keys = names.values.iter().map(|(key, _)| key.as_str());
            let known: Vec<String> =
                ["name", "camera", "sweep"].into_iter().chain(keys).map(|k| format!("{{{k}}}")).collect();
            Err(format!("there is no `{{{name}}}`: known are {}", known.join(", ")))
        }
    }
}

/// The text with only what file names can hold everywhere.
fn file_name(text: &str) -> String {
    let plain = |c: char| if c.is_alphanumeric() || "-+._".contains(c) { c } else { '_' };
    text.trim_matches(['"', '[', ']', '\'']).replace(", ", "_").chars().map(plain).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn made(pattern: &str) -> Result<String, String> {
        let values = [("camera.fov_deg".to_owned(), 30.0.into()), ("k".to_owned(), "a/b".into())];
        path(
            pattern,
            &Names { job: "turn", frame: Some(7), camera: Some("left"), choice: 2, values: &values },
        )
    }

    #[test]
    fn patterns_are_filled() {
        assert_eq!(made("turn.####.exr").unwrap(), "turn.0007.exr");
        assert_eq!(made("a/b.exr").unwrap(), "a/b.0007.exr");
        assert_eq!(
            made("{name}/{camera}/{sweep}-{camera.fov_deg}-#.png").unwrap(),
            "turn/left/0002-30.0-7.png"
        );
        assert_eq!(made("#{k}.png").unwrap(), "7a_b.png");
        assert_eq!(made("./a//./#.png").unwrap(), "a/7.png");
        assert_eq!(hashes("##", -3), "-03");
    }

    #[test]
    fn paths_stay_below_the_output_folder() {
        for pattern in ["/a.#.png", "../a.#.png", "a/../../b.#.png"] {
            assert!(made(pattern).unwrap_err().contains("below the output folder"));
        }
        assert!(made("{fov}.png").unwrap_err().contains("{camera.fov_deg}"));
        assert!(made("{name.png").unwrap_err().contains("without"));
    }
}
