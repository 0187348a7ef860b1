//! A job to its pictures.

use std::path::Path;

use rayon::prelude::*;

use super::assets::Files;
use super::axis::{Choice, MOST_PICTURES, choices};
use super::job::{Job, JobCamera, Output, SeedMode};
use super::keyframes::Track;
use super::likeness::{Likeness, Numbers};
use super::pattern::{self, Names};
use super::picture::{Picture, PictureFile};
use super::source::Source;
use super::whole::whole;
use super::{BatchError, distinct, frames, seed};
use crate::output::Format;

/// Pictures that are made at a time: enough for all threads, and a fault in the first of a million is told soon.
const AT_A_TIME: usize = 4096;

/// The pictures of a job: choices of the sweep, for each all cameras, for each all frames. `files` sees the scene of each.
pub(super) fn pictures(job: &Job, source: &Source, files: &mut Files) -> Result<Vec<Picture>, BatchError> {
    let axes = Axes::of(job).map_err(BatchError::Job)?;
    let common = job.common_sets();
    let count = axes.count().map_err(BatchError::Job)?;
    let (mut pictures, mut known) = (Vec::with_capacity(count), Numbers::default());
    for first in (0..count).step_by(AT_A_TIME) {
        let numbers = first..count.min(first + AT_A_TIME);
        let made: Vec<_> =
            numbers.into_par_iter().map(|number| axes.checked(number, job, source, &common)).collect();
        for made in made {
            let (picture, likeness, seen) = made?;
            let (scene, shape) = known.of(likeness);
            files.join(seen);
            pictures.push(Picture { scene, shape, ..picture });
        }
    }
    distinct::check(&pictures).map_err(BatchError::Job)?;
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
        one_source(job)?;
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

    /// How many pictures there are.
    fn count(&self) -> Result<usize, String> {
        let count = (self.choices.len().checked_mul(self.cameras.len()))
            .and_then(|count| count.checked_mul(self.frames.len()));
        let count = count.filter(|&count| count <= MOST_PICTURES);
        count.ok_or_else(|| {
            format!(
                "sweep, cameras and frames make more than {MOST_PICTURES} pictures: cut the job into several"
            )
        })
    }

    /// Picture `number` with what its scene says, what that scene is like, and its files.
    fn checked(
        &self,
        number: usize,
        job: &Job,
        source: &Source,
        common: &[String],
    ) -> Result<(Picture, Option<Likeness>, Files), BatchError> {
        let (frames, cameras) = (self.frames.len(), self.cameras.len());
        let (frame, camera, choice) = (number % frames, number / frames % cameras, number / frames / cameras);
        let picture = self.picture(job, choice, self.cameras[camera], self.frames[frame]);
        let mut picture = picture.map_err(BatchError::Job)?;
        let sets: Vec<String> = common.iter().chain(&picture.sets).cloned().collect();
        let scene = source
            .with(&sets)
            .map_err(|error| BatchError::Picture { picture: picture.name.clone(), source: error })?;
        if job.seed_mode == SeedMode::PerPicture {
            let seed = seed::of_picture(scene.render.seed, number as u64);
            picture.sets.push(format!("render.seed={seed}"));
        }
        let mut files = Files::default();
        files.see(&scene);
        let picture = Picture { size: scene.render.size, spp: scene.render.spp, ..picture };
        let likeness = Likeness::of(&scene, &picture.sets);
        Ok((picture, likeness, files))
    }

    fn picture(
        &self,
        job: &Job,
        number: usize,
        camera: Option<&JobCamera>,
        frame: Option<i64>,
    ) -> Result<Picture, String> {
        let choice = &self.choices[number];
        let of_camera =
            camera.iter().flat_map(|c| c.set.iter().map(|(key, value)| format!("camera.{key}={value}")));
        let of_frame =
            frame.iter().flat_map(|&frame| self.tracks.iter().map(move |track| track.at(frame as f64)));
        let of_choice = choice.iter().map(|(key, value)| format!("{key}={}", whole(value)));
        let name = camera.map(|c| c.name.as_str());
        let names = Names { job: &job.name, frame, camera: name, choice: number, values: choice };
        let file = |output: &Output| file(output, &names);
        Ok(Picture {
            name: title(&names),
            sets: of_camera.chain(of_frame).chain(of_choice).collect(),
            size: [0; 2],
            spp: 0,
            outputs: job.output.iter().map(file).collect::<Result<_, _>>()?,
            scene: 0,
            shape: 0,
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

/// No key has its values from two places, of which one would be for nothing.
fn one_source(job: &Job) -> Result<(), String> {
    for (at, keyframes) in job.keyframes.iter().enumerate() {
        let key = &keyframes.key;
        if job.keyframes[..at].iter().any(|other| other.key == *key) {
            return Err(format!("`{key}` has keyframes twice: put all of them into one [[keyframes]]"));
        }
        if job.sweep.contains_key(key) {
            return Err(format!("`{key}` is swept and has keyframes: only one of them can set it"));
        }
    }
    Ok(())
}
