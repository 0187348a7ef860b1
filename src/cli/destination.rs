//! Where a picture goes and in which format.

use std::fmt;
use std::io::IsTerminal;
use std::path::{Path, PathBuf};

use super::args::RenderArgs;
use super::error::{CliError, Exit};
use crate::film::{Aov, AovSet, Film, Tone};
use crate::output::{self, Format, Written};
use crate::scene::Scene;

/// Where a picture goes and in which format.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Destination {
    /// Nothing for standard output.
    path: Option<PathBuf>,
    format: Format,
}

impl Destination {
    /// The destination that the command line asks for.
    pub(super) fn of(args: &RenderArgs) -> Result<Self, CliError> {
        if args.output.as_deref() == Some(Path::new("-")) {
            return Ok(Self { path: None, format: args.format.unwrap_or(Format::Ppm) });
        }
        let path = args.output.clone().unwrap_or_else(|| {
            let format = args.format.unwrap_or(Format::Png);
            format!("{}.{format}", args.scene.scene.stem()).into()
        });
        let format = args.format.map_or_else(|| Format::from_path(&path), Ok)?;
        Ok(Self { path: Some(path), format })
    }

    /// Fails now if writing would fail later.
    pub(super) fn check(&self) -> Result<(), CliError> {
        match &self.path {
            Some(path) => Ok(output::check_writable(path)?),
            None if std::io::stdout().is_terminal() => {
                Err(CliError::new(Exit::Usage, "a picture is not for a terminal: redirect standard output"))
            }
            None => Ok(()),
        }
    }

    /// Fails now if the format has no place for values beside colour that are asked for, or if the camera's numbers could not
    /// be written beside them.
    pub(super) fn check_planes(&self, aovs: AovSet) -> Result<(), CliError> {
        if !aovs.is_empty() && self.format != Format::Exr {
            let names: Vec<&str> = aovs.iter().map(Aov::name).collect();
            let what = format!("{self}: {} cannot hold {}: use exr", self.format, names.join(", "));
            return Err(CliError::new(Exit::Usage, what));
        }
        match self.camera_path(aovs) {
            Some(camera) => Ok(output::check_writable(&camera)?),
            None => Ok(()),
        }
    }

    /// Where the camera's numbers go: beside a picture with values that need them; beside standard output is no place.
    fn camera_path(&self, aovs: AovSet) -> Option<PathBuf> {
        self.path.as_ref().filter(|_| !aovs.is_empty()).map(|path| output::camera_path(path))
    }

    /// Whether writing may wait for a reader, unlike writing a regular file.
    pub(super) fn may_block(&self) -> bool {
        let is_special = |path: &PathBuf| std::fs::metadata(path).is_ok_and(|found| !found.is_file());
        self.path.as_ref().is_none_or(is_special)
    }

    /// Writes the picture.
    pub(super) fn write(&self, film: &Film, tone: Tone) -> Result<Written, CliError> {
        Ok(match &self.path {
            Some(path) => output::write_file(path, film, self.format, tone)?,
            None => output::write_stdout(film, self.format, tone)?,
        })
    }

    /// Writes the camera's numbers, if they have a place.
    pub(super) fn write_camera(&self, scene: &Scene, crop: Option<[u32; 4]>) -> Result<(), CliError> {
        let Some(path) = self.camera_path(scene.settings.aovs) else { return Ok(()) };
        let camera = output::camera_json(&scene.camera, scene.settings.size, crop);
        Ok(output::write_atomically(&path, format!("{camera:#}\n").as_bytes())?)
    }
}

impl fmt::Display for Destination {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.path {
            Some(path) => write!(f, "{}", path.display()),
            None => f.write_str("standard output"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cli::{Args, Verb};
    use clap::Parser;

    fn destination(line: &str) -> Result<(String, Format), Exit> {
        let words = ["octray", "render"].into_iter().chain(line.split_whitespace());
        let Verb::Render(args) = Args::parse_from(words).verb else { unreachable!() };
        Destination::of(&args).map(|found| (found.to_string(), found.format)).map_err(|error| error.exit())
    }

    fn found(path: &str, format: Format) -> Result<(String, Format), Exit> {
        Ok((path.to_owned(), format))
    }

    #[test]
    fn the_default_is_the_scenes_name_in_the_current_folder() {
        assert_eq!(destination(""), found("seed.png", Format::Png));
        assert_eq!(destination("scenes/a.toml"), found("a.png", Format::Png));
        assert_eq!(destination("terrain:100 --format exr"), found("terrain-100.exr", Format::Exr));
        assert_eq!(destination("-"), found("stdin.png", Format::Png));
    }

    #[test]
    fn the_format_wins_over_the_extension() {
        assert_eq!(destination("-o b/a.pfm"), found("b/a.pfm", Format::Pfm));
        assert_eq!(destination("-o a.png --format ppm"), found("a.png", Format::Ppm));
        assert_eq!(destination("-o /dev/null --format ppm"), found("/dev/null", Format::Ppm));
        assert_eq!(destination("-o a.jpg"), Err(Exit::Usage));
    }

    #[test]
    fn standard_output_gets_ppm_unless_told() {
        assert_eq!(destination("-o -"), found("standard output", Format::Ppm));
        assert_eq!(destination("-o - --format png"), found("standard output", Format::Png));
    }
}
