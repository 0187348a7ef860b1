//! `octray schema`: the JSON Schemas of scene and job files.

use super::args::{SchemaArgs, SchemaOf};
use super::error::CliError;
use super::stdio;
use crate::{batch, describe};

/// Prints the schema.
pub fn run(args: &SchemaArgs) -> Result<(), CliError> {
    let schema = match args.of {
        SchemaOf::Scene => describe::schema(),
        SchemaOf::Job => batch::job::schema(),
    };
    stdio::print(format!("{schema}\n").as_bytes())
}
