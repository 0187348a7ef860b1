//! `octray schema`: the JSON Schema of scene files.

use super::error::CliError;
use super::stdio;
use crate::describe::schema;

/// Prints the schema.
pub fn run() -> Result<(), CliError> {
    stdio::print(format!("{}\n", schema()).as_bytes())
}
