//! `octray scenes`: the built-in scenes.

use super::args::ScenesArgs;
use super::error::CliError;
use super::{pipeline, stdio};

/// Prints the list, or one scene as a scene file.
pub fn run(args: &ScenesArgs) -> Result<(), CliError> {
    let text = match &args.write {
        Some(name) => pipeline::builtin_toml(name)?,
        None => list(&pipeline::builtin_scenes()?),
    };
    stdio::print(text.as_bytes())
}

fn list(scenes: &[pipeline::BuiltIn]) -> String {
    let width = scenes.iter().map(|scene| scene.name.len()).max().unwrap_or(0);
    scenes.iter().map(|scene| format!("{:width$}  {}\n", scene.name, scene.summary)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_list_is_a_table() {
        let scene = |name, summary| pipeline::BuiltIn { name, summary };
        let text = list(&[scene("seed", "the first picture"), scene("terrain:N", "hills")]);
        assert_eq!(text, "seed       the first picture\nterrain:N  hills\n");
        assert_eq!(list(&[]), "");
    }
}
