//! Errors of serde and the TOML reader in the words of a scene file: keys, tables, arrays, strings and numbers.

use super::Diagnostic;
use super::check::nearest;
use super::locate::Sources;

/// An error of a file that has no `--set` beside it, as [`explain`].
pub(crate) fn explain_in(name: &str, text: &str, error: &toml::de::Error) -> Diagnostic {
    explain(&Sources { name, text, sets: &[] }, error)
}

/// An error of the TOML or type layer in the words of a scene file, with the nearest valid name.
pub(super) fn explain(sources: &Sources<'_>, error: &toml::de::Error) -> Diagnostic {
    let (message, help) = reword(error.message().trim_end());
    sources.diagnose(error.span().map_or(0, |span| span.start), message, help)
}

/// Serde's words for unknown and missing names, which carry the valid ones in backticks, and for wrong types.
fn reword(message: &str) -> (String, Option<String>) {
    let names: Vec<&str> = message.split('`').skip(1).step_by(2).collect();
    let reworded = |what: &str| match names.split_first() {
        Some((found, valid)) => (format!("{what} `{found}`"), Some(suggest(found, valid))),
        None => (message.to_owned(), None),
    };
    if message.starts_with("unknown field") {
        reworded("unknown key")
    } else if message.starts_with("unknown variant") {
        reworded("unknown value")
    } else if let Some(rest) = message.strip_prefix("missing field") {
        (format!("missing key{rest}"), None)
    } else {
        (mismatch(message), None)
    }
}

/// The nearest of some valid names, if one is near, and all of them.
pub(crate) fn suggest(found: &str, valid: &[&str]) -> String {
    let all = valid.join(", ");
    match nearest(found, valid.iter().copied()) {
        Some(near) => format!("did you mean `{near}`? valid here: {all}"),
        None => format!("valid here: {all}"),
    }
}

/// What was found and what was expected, without names of types of ours.
fn mismatch(message: &str) -> String {
    // From the end: what was found may be a string with these words inside.
    let Some((found, expected)) = message.rsplit_once(", expected ") else {
        return message.replace("wanted", "expected");
    };
    let expected = of_toml(expected);
    let found = match found.strip_prefix("invalid type: ").unwrap_or(found) {
        "map" => "invalid type: table".to_owned(),
        "sequence" => "invalid type: array".to_owned(),
        // Arrays pass for structs as far as they go.
        length if expected == "a table" && length.starts_with("invalid length") => {
            "invalid type: array".to_owned()
        }
        _ => found.replacen(": floating point `", ": float `", 1),
    };
    format!("{found}, expected {expected}")
}

/// What serde expects, as TOML calls it.
fn of_toml(expected: &str) -> &str {
    match expected {
        "f32" | "f64" => "a number",
        "u32" => "a whole number from 0 to 4294967295",
        "u64" | "usize" => "a whole number, at least 0",
        "a sequence" => "an array",
        "a map" => "a table",
        "path string" => "a string",
        _ if expected.starts_with("struct ") => "a table",
        _ => expected,
    }
}
