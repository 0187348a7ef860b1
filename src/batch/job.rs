//! The job file, exactly as written.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use schemars::JsonSchema;
use serde::Deserialize;
use serde::de::{Deserializer, Error};
use toml::Value;

pub use super::axis::{Sweep, SweepMode};
pub use super::keyframes::{Interpolation, Keyframes};
use super::{BatchError, key};
use crate::describe::words::explain_in;
use crate::describe::{self, BuildQuality, Tier};
use crate::film::Aov;

/// A job, as written. Field names are the keys of the file.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Job {
    /// Scene file or mesh, relative to the job file, or the name of a built-in scene.
    pub scene: String,
    /// Width and height in pixels, in place of the scene's.
    #[serde(default, deserialize_with = "size")]
    pub size: Option<[u32; 2]>,
    /// Samples a pixel, in place of the scene's.
    pub spp: Option<u32>,
    /// Most bounces of a path, in place of the scene's.
    pub max_depth: Option<u32>,
    /// Seed, in place of the scene's.
    pub seed: Option<u64>,
    /// Whether all pictures have that seed, or each one of its own that follows from it.
    #[serde(default)]
    pub seed_mode: SeedMode,
    /// Tier, in place of the scene's.
    pub tier: Option<Tier>,
    /// Work that goes into trees, in place of the scene's.
    pub build_quality: Option<BuildQuality>,
    /// Frames, such as `1-100` or `1,3,5..9`; one picture without a number if not given.
    pub frames: Option<String>,
    /// Values in place of the scene's, by key as for `--set`.
    #[serde(default, deserialize_with = "key::map")]
    #[schemars(with = "BTreeMap<String, serde_json::Value>")]
    pub set: BTreeMap<String, Value>,
    /// Values that change from picture to picture, by key as for `--set`.
    #[serde(default, deserialize_with = "key::map")]
    pub sweep: BTreeMap<String, Sweep>,
    /// Whether every value meets every other one, or each only its fellows of the same place.
    #[serde(default)]
    pub sweep_mode: SweepMode,
    /// `[[camera]]`: every picture is taken by each.
    #[serde(default)]
    pub camera: Vec<JobCamera>,
    /// `[[keyframes]]`: values that change from frame to frame.
    #[serde(default)]
    pub keyframes: Vec<Keyframes>,
    /// `[[output]]`: the files of each picture, at least one.
    #[schemars(length(min = 1))]
    pub output: Vec<Output>,
    /// Folder of the job file: relative paths start here. Not part of the file.
    #[serde(skip)]
    pub folder: PathBuf,
    /// The job file's name without its ending. Not part of the file.
    #[serde(skip)]
    pub name: String,
}

/// Which pictures have which seed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum SeedMode {
    /// All have the job's or the scene's: what does not change from picture to picture has the same noise.
    #[default]
    Same,
    /// Each has one of its own, that follows from the job's or the scene's and the picture's number.
    PerPicture,
}

/// One camera.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct JobCamera {
    /// Its name, for `{camera}` in paths.
    pub name: String,
    /// Values in place of the scene's camera, by the camera's keys.
    #[serde(default, deserialize_with = "key::map")]
    #[schemars(with = "BTreeMap<String, serde_json::Value>")]
    pub set: BTreeMap<String, Value>,
}

/// One file of each picture.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Output {
    /// Path below the output folder; `####` is the frame, `{name}`, `{camera}`, `{sweep}` and `{key}` what they say.
    pub path: String,
    /// Values beside colour, for EXR.
    #[serde(default)]
    pub aovs: Vec<Aov>,
    /// Write the camera's numbers beside it. Default: where there are AOVs.
    pub camera_json: Option<bool>,
}

/// The JSON Schema of job files.
#[must_use]
pub fn schema() -> String {
    let schema = schemars::schema_for!(Job);
    serde_json::to_string_pretty(&schema).expect("a schema is plain JSON")
}

impl Job {
    /// The job in a file.
    ///
    /// **Errors:** [`BatchError`] with file, line and what was expected.
    pub fn read(path: &Path) -> Result<Self, BatchError> {
        let bytes = std::fs::read(path).map_err(|cause| BatchError::read(path, cause))?;
        let text = String::from_utf8(bytes).map_err(|error| {
            let line = 1 + error.as_bytes()[..error.utf8_error().valid_up_to()]
                .iter()
                .filter(|&&b| b == b'\n')
                .count();
            BatchError::Job(format!("{}:{line}: is no text in UTF-8", path.display()))
        })?;
        let mut job = Self::parse(&text, &path.display().to_string())?;
        job.folder = path.parent().unwrap_or(Path::new("")).to_owned();
        job.name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        Ok(job)
    }

    fn parse(text: &str, name: &str) -> Result<Self, BatchError> {
        toml::from_str(text).map_err(|error| {
            let explained = explain_in(name, text, &error).to_string();
            BatchError::Job(match describe::parse(text, name) {
                Ok(_) => format!("{explained}\n  note: this is a scene; the job file of a batch names it: scene = \"{name}\""),
                Err(_) => explained,
            })
        })
    }

    /// The settings that apply to all pictures, as `key=value`.
    pub(super) fn common_sets(&self) -> Vec<String> {
        let settings = [
            ("render.size", self.size.map(|[width, height]| format!("[{width}, {height}]"))),
            ("render.spp", self.spp.map(|spp| spp.to_string())),
            ("render.max_depth", self.max_depth.map(|depth| depth.to_string())),
            ("render.seed", self.seed.map(|seed| seed.to_string())),
            ("render.tier", self.tier.and_then(quoted)),
            ("render.build_quality", self.build_quality.and_then(quoted)),
            ("render.aovs", self.aovs()),
        ];
        let given = settings.into_iter().filter_map(|(key, value)| Some(format!("{key}={}", value?)));
        let set = self.set.iter().map(|(key, value)| format!("{key}={value}"));
        set.chain(given).collect()
    }

    /// All values beside colour that any output wants.
    fn aovs(&self) -> Option<String> {
        let mut wanted: Vec<Aov> = self.output.iter().flat_map(|output| output.aovs.clone()).collect();
        wanted.sort_unstable();
        wanted.dedup();
        let names: Vec<String> = wanted.iter().map(|aov| format!("\"{}\"", aov.name())).collect();
        (!names.is_empty()).then(|| format!("[{}]", names.join(", ")))
    }
}

/// Two numbers and no third, which would else be left out without a word.
fn size<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<[u32; 2]>, D::Error> {
    let sides = Vec::<u32>::deserialize(deserializer)?;
    let size = <[u32; 2]>::try_from(sides);
    size.map(Some).map_err(|sides| Error::invalid_length(sides.len(), &"[width, height] in pixels"))
}

/// A name as a scene file has it.
fn quoted(name: impl serde::Serialize) -> Option<String> {
    Value::try_from(name).ok().map(|name| name.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn settings_become_changes_to_the_scene() {
        let job = Job::parse(
            "scene='seed'\nsize=[4,3]\ntier='exact'\n[set]\n'camera.fov_deg'=3\n[[output]]\npath='a.exr'\naovs=['uv','depth']",
            "job.toml",
        );
        let expected = [
            "camera.fov_deg=3",
            "render.size=[4, 3]",
            "render.tier=\"exact\"",
            "render.aovs=[\"depth\", \"uv\"]",
        ];
        assert_eq!(job.unwrap().common_sets(), expected);
    }

    #[test]
    fn errors_name_file_line_and_what_was_expected() {
        for (text, words) in [
            ("scene='seed'\nspp='many'\n", ["job.toml:2:5", "a whole number"]),
            ("scene=3\n", ["job.toml:1", "a string"]),
            ("scene='seed'\n[set]\n[[output]]\npath='a.exr'\n[sweep]\nx=3", ["job.toml:6:3", "or table"]),
            ("scene='seed'\nssp=3\n[[output]]\npath='a.exr'", ["job.toml:2", "did you mean `spp`"]),
            ("scene='seed'\n", ["job.toml:1", "output"]),
            ("scene='seed'\n[[output]]\npath='a.exr'\naovs=['normal']", ["job.toml:4", "shading_normal"]),
            ("scene=", ["job.toml:1", ""]),
        ] {
            let error = Job::parse(text, "job.toml").unwrap_err().to_string();
            assert!(words.iter().all(|word| error.contains(word)), "{error}");
        }
    }
}
