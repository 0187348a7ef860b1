//! Text to standard output and standard error.

use std::io::{self, Write};

use super::error::{CliError, Exit};

/// Writes a line to standard error, or nothing if nobody listens there.
pub(super) fn say(line: &str) {
    let _ = writeln!(io::stderr().lock(), "{line}");
}

/// Writes `text` to standard output. A reader that has seen enough and left is no error.
pub(super) fn print(text: &[u8]) -> Result<(), CliError> {
    let mut stdout = io::stdout().lock();
    match stdout.write_all(text).and_then(|()| stdout.flush()) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
            Err(CliError::new(Exit::Failed, "cannot write standard output").because(error))
        }
        _ => Ok(()),
    }
}
