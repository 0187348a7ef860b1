//! `octray scenes`: the built-in scenes.

use super::args::ScenesArgs;
use super::error::CliError;
use super::{pipeline, stdio};
use crate::describe::{BuiltinScene, builtin_scenes};

/// Prints the list, or one scene as a scene file.
pub fn run(args: &ScenesArgs) -> Result<(), CliError> {
    let text = match &args.write {
        Some(name) => pipeline::builtin_toml(name)?,
        None => list(builtin_scenes()),
    };
    stdio::print(text.as_bytes())
}

fn list(scenes: &[BuiltinScene]) -> String {
    let width = scenes.iter().map(|scene| scene.usage.len()).max().unwrap_or(0);
    scenes.iter().map(|scene| format!("{:width$}  {}\n", scene.usage, scene.summary)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_list_is_a_table() {
        let scene = |usage, summary| BuiltinScene { name: usage, usage, summary };
        let text = list(&[scene("seed", "the first picture"), scene("terrain:N", "hills")]);
        assert_eq!(text, "seed       the first picture\nterrain:N  hills\n");
        assert_eq!(list(&[]), "");
    }
}
