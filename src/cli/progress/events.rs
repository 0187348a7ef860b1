//! Progress as JSON objects.

use std::time::Duration;

use serde_json::{Value, json};

use crate::cli::error::CliError;
use crate::cli::pipeline::Progress;
use crate::cli::rhythm::time_left;

/// How far a render is.
pub(super) fn progress_event(progress: &Progress, elapsed: Duration) -> Value {
    json!({
        "event": "progress",
        "pixels_done": progress.pixels_done,
        "pixels_total": progress.pixels_total,
        "rays": progress.rays,
        "elapsed_s": elapsed.as_secs_f64(),
        "left_s": time_left(progress, elapsed).map(|left| left.as_secs_f64()),
    })
}

/// How it failed.
pub(super) fn failed_event(error: &CliError) -> Value {
    json!({ "event": "failed", "exit_code": error.exit() as u8, "error": error.to_string() })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cli::Exit;
    use crate::cli::rhythm::tests::{progress, seconds};

    #[test]
    fn events_are_one_line() {
        let event = progress_event(&progress(1, 4), seconds(2.0));
        assert_eq!((&event["event"], &event["left_s"]), (&json!("progress"), &json!(6.0)));
        let event = failed_event(&CliError::new(Exit::Scene, "two\nlines \"quoted\""));
        assert!(!event.to_string().contains('\n'));
        assert_eq!(event["exit_code"], 3);
    }
}
