//! A job to its pictures.

use std::collections::HashMap;
use std::path::Path;

use super::assets::Files;
use super::axis::{Choice, choices};
use super::job::{Job, JobCamera, Output};
use super::keyframes::Track;
use super::pattern::{self, Names};
use super::picture::{Picture, PictureFile};
use super::source::Source;
use super::{BatchError, frames};
use crate::output::Format;

/// The pictures of a job: choices of the sweep, for each all cameras, for each all frames. `files` sees the scene of each.
pub(super) fn pictures(job: &Job, source: &Source, files: &mut Files) -> Result<Vec<Picture>, BatchError> {
    let plan = Axes::of(job).map_err(BatchError::Job)?;
    let common = job.common_sets();
    let mut pictures = Vec::new();
    for (number, choice) in plan.choices.iter().enumerate() {
        for camera in &plan.cameras {
            for &frame in &plan.frames {
                let picture = plan.picture(job, (number, choice), *camera, frame).map_err(BatchError::Job)?;
                pictures.push(checked(picture, source, &common, files)?);
            }
        }
    }
    distinct(&pictures).map_err(BatchError::Job)?;
    Ok(pictures)
}

/// A job's axes.
struct Axes<'a> {
    choices: Vec<Choice>,
    cameras: Vec<Option<&'a JobCamera>>,
    frames: Vec<Option<i64>>,
    tracks: Vec<Track<'a>>,
}

impl<'a> Axes<'a> {
    fn of(job: &'a Job) -> Result<Self, String> {
        if job.output.is_empty() {
            return Err("the job has no [[output]]".into());
        }
        if !job.keyframes.is_empty() && job.frames.is_none() {
            return Err("keyframes need `frames`".into());
        }
        let frames = match &job.frames {
            Some(text) => {
                frames::parse(text).map_err(|e| format!("frames: {e}"))?.into_iter().map(Some).collect()
            }
            None => vec![None],
        };
        let cameras = match job.camera.is_empty() {
            true => vec![None],
            false => job.camera.iter().map(Some).collect(),
        };
        let tracks = job.keyframes.iter().map(Track::new).collect::<Result<_, _>>()?;
        Ok(Self { choices: choices(&job.sweep, job.sweep_mode)?, cameras, frames, tracks })
    }

    fn picture(
        &self,
        job: &Job,
        (number, choice): (usize, &Choice),
        camera: Option<&JobCamera>,
        frame: Option<i64>,
    ) -> Result<Picture, String> {
        let of_camera =
            camera.iter().flat_map(|c| c.set.iter().map(|(key, value)| format!("camera.{key}={value}")));
        let of_frame =
            frame.iter().flat_map(|&frame| self.tracks.iter().map(move |track| track.at(frame as f64)));
        let of_choice = choice.iter().map(|(key, value)| format!("{key}={value}"));
        let name = camera.map(|c| c.name.as_str());
        let names = Names { job: &job.name, frame, camera: name, choice: number, values: choice };
        let file = |output: &Output| file(output, &names);
        Ok(Picture {
            name: title(&names),
            sets: of_camera.chain(of_frame).chain(of_choice).collect(),
            size: [0; 2],
            spp: 0,
            outputs: job.output.iter().map(file).collect::<Result<_, _>>()?,
            first_unit: 0,
            units: 0,
        })
    }
}

fn file(output: &Output, names: &Names) -> Result<PictureFile, String> {
    let path = pattern::path(&output.path, names)?;
    let format = Format::from_path(Path::new(&path)).map_err(|error| error.to_string())?;
    if format != Format::Exr && !output.aovs.is_empty() {
        return Err(format!("output `{path}`: {format} has no place for AOVs: use exr"));
    }
    let camera_json = output.camera_json.unwrap_or(!output.aovs.is_empty());
    Ok(PictureFile { path, aovs: output.aovs.clone(), camera_json })
}

/// What people call a picture.
fn title(names: &Names) -> String {
    let frame = names.frame.map(|frame| format!("frame {frame}"));
    let camera = names.camera.map(|camera| format!("camera {camera}"));
    let values = names.values.iter().map(|(key, value)| format!("{key} = {value}"));
    let parts: Vec<String> = frame.into_iter().chain(camera).chain(values).collect();
    if parts.is_empty() { "the picture".into() } else { parts.join(", ") }
}

/// The picture with what its scene says.
fn checked(
    picture: Picture,
    source: &Source,
    common: &[String],
    files: &mut Files,
) -> Result<Picture, BatchError> {
    let sets: Vec<String> = common.iter().chain(&picture.sets).cloned().collect();
    let scene = source
        .with(&sets)
        .map_err(|error| BatchError::Picture { picture: picture.name.clone(), source: error })?;
    files.see(&scene);
    Ok(Picture { size: scene.render.size, spp: scene.render.spp, ..picture })
}

/// No two pictures share a file.
fn distinct(pictures: &[Picture]) -> Result<(), String> {
    let mut owner: HashMap<String, &str> = HashMap::new();
    for picture in pictures {
        for file in &picture.outputs {
            if let Some(other) = owner.insert(file.path.clone(), &picture.name) {
                let (path, name) = (&file.path, &picture.name);
                return Err(format!(
                    "output `{path}` would hold both {other} and {name}: name what differs in it, such as {{camera}}, {{sweep}} or {{key}}"
                ));
            }
        }
    }
    Ok(())
}
