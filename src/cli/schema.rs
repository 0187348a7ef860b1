//! `octray schema`: the JSON Schema of scene files.

use super::error::CliError;
use super::{pipeline, stdio};

/// Prints the schema.
pub fn run() -> Result<(), CliError> {
    stdio::print(pipeline::schema()?.as_bytes())
}
