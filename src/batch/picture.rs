//! One picture of a plan.

use serde::{Deserialize, Serialize};

use super::pattern::is_free;
use crate::film::Aov;
use crate::output::camera_path;

/// One picture: a scene with changes, and the files it becomes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Picture {
    /// What people call it, such as `frame 3, camera left`.
    pub name: String,
    /// Changes to the scene beside those of all pictures, each `key=value`.
    pub sets: Vec<String>,
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Samples a pixel.
    pub spp: u32,
    /// The files.
    pub outputs: Vec<PictureFile>,
    /// Which scene it shows, camera, lights and most settings aside: pictures with the same number share it.
    pub scene: u32,
    /// Which shape that scene has: those with the same number differ in nothing but transforms.
    pub shape: u32,
    /// Number of its first unit.
    pub first_unit: u64,
    /// How many units it is cut into.
    pub units: u64,
}

/// One file of a picture.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PictureFile {
    /// Path below the output folder.
    pub path: String,
    /// Values beside colour.
    pub aovs: Vec<Aov>,
    /// Whether the camera's numbers go beside it.
    pub camera_json: bool,
}

impl PictureFile {
    /// The file of the camera's numbers, if it has one.
    pub(super) fn camera_path(&self) -> Option<String> {
        self.camera_json.then(|| camera_path(self.path.as_ref()).to_string_lossy().into_owned())
    }
}

impl Picture {
    /// Whether all its files lie below the output folder, and none among the state of batches.
    pub(super) fn has_good_paths(&self) -> bool {
        self.outputs.iter().all(|file| is_free(&file.path))
    }

    /// Camera samples in all.
    pub fn samples(&self) -> u64 {
        u64::from(self.size[0]) * u64::from(self.size[1]) * u64::from(self.spp)
    }
}
