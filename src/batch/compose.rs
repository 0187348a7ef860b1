//! Sums to pictures, and pictures to the bytes of files.

use std::collections::HashMap;

use super::BatchError;
use super::part::Part;
use super::picture::{Picture, PictureFile};
use crate::film::{
    AovSample, AovSet, BlockNode, Film, Plane, PlaneValues, TileSums, joined, node_places, total,
};
use crate::output::{Format, OutputError, camera_json, encode};
use crate::scene::Scene;
use crate::wavefront::{Rect, mean, pixels};

/// Sums of one tile over some blocks.
struct Layer<'a> {
    sums: &'a TileSums,
    places: Vec<(u32, u64)>,
    samples: u32,
}

/// The picture that parts make up; what none of them has is black and seen by nothing.
pub(super) fn film(size: [u32; 2], aovs: AovSet, parts: &[Part]) -> Film {
    let mut film = Film::new(size[0], size[1]);
    film.planes = aovs.planes(film.pixels.len());
    let mut layers: HashMap<Rect, Vec<Layer>> = HashMap::new();
    for part in parts {
        for (&tile, sums) in part.tiles.iter().zip(&part.sums) {
            let Some(sums) = sums else { continue };
            let (blocks, samples) = (part.unit.blocks(), part.unit.samples.len() as u32);
            let places = node_places(blocks.start, blocks.end);
            layers.entry(tile).or_default().push(Layer { sums, places, samples });
        }
    }
    let pixels_there: usize = layers.keys().map(|tile| tile[2] as usize * tile[3] as usize).sum();
    if pixels_there < film.pixels.len() && !aovs.is_empty() {
        (0..film.pixels.len()).for_each(|at| AovSample::default().store(aovs, &mut film.planes, at));
    }
    let mut list = Vec::new();
    for (tile, mut layers) in layers {
        layers.sort_by_key(|layer| layer.places.first().map(|&(level, index)| index << level));
        pixels(tile, &mut list);
        store(&mut film, &list, &layers);
    }
    film
}

fn store(film: &mut Film, pixels: &[[u32; 2]], layers: &[Layer]) {
    let width = film.width as usize;
    let places = || pixels.iter().map(|&[x, y]| y as usize * width + x as usize).enumerate();
    for (k, at) in places() {
        film.pixels[at] = mean(sum(layers, (k, pixels.len())));
    }
    for layer in layers.iter().filter(|layer| !layer.sums.aovs.is_empty()) {
        places().for_each(|(k, at)| store_aovs(&mut film.planes, &layer.sums.aovs, (k, pixels.len()), at));
    }
    if let Some(PlaneValues::Uint(counts)) = sample_counts(&mut film.planes) {
        let samples = layers.iter().map(|layer| layer.samples).sum();
        places().for_each(|(_, at)| counts[at] = samples);
    }
}

/// The sum of one pixel of a tile.
fn sum(layers: &[Layer], (pixel, pixels): (usize, usize)) -> [f32; 4] {
    let node = |layer: &Layer, node: usize| layer.sums.nodes[node * pixels + pixel];
    if let [whole] = layers {
        return total((0..whole.places.len()).map(|n| node(whole, n)));
    }
    joined(layers.iter().flat_map(|layer| {
        let places = layer.places.iter().enumerate();
        places.map(move |(n, &(level, index))| BlockNode { level, index, sum: node(layer, n) })
    }))
}

fn sample_counts(planes: &mut [Plane]) -> Option<&mut PlaneValues> {
    let name = crate::film::Aov::SampleCount.channels()[0];
    planes.iter_mut().find(|plane| plane.name == name).map(|plane| &mut plane.values)
}

fn store_aovs(planes: &mut [Plane], bits: &[u32], (pixel, pixels): (usize, usize), at: usize) {
    for (channel, plane) in planes.iter_mut().enumerate() {
        let bits = bits[channel * pixels + pixel];
        match &mut plane.values {
            PlaneValues::Float(values) => values[at] = f32::from_bits(bits),
            PlaneValues::Uint(values) => values[at] = bits,
        }
    }
}

/// The bits of a tile's values beside colour, channel by channel.
pub(super) fn aov_bits(aovs: AovSet, seen: &[AovSample]) -> Vec<u32> {
    if seen.is_empty() {
        return Vec::new();
    }
    let mut planes = aovs.planes(seen.len());
    for (at, sample) in seen.iter().enumerate() {
        sample.store(aovs, &mut planes, at);
    }
    let bits = |plane: Plane| match plane.values {
        PlaneValues::Float(values) => values.into_iter().map(f32::to_bits).collect(),
        PlaneValues::Uint(values) => values,
    };
    planes.into_iter().flat_map(bits).collect()
}

/// Paths and bytes of all files of a picture.
pub(super) fn files(
    picture: &Picture,
    scene: &Scene,
    film: Film,
) -> Result<Vec<(String, Vec<u8>)>, BatchError> {
    let mut files: Vec<(String, Vec<u8>)> = Vec::new();
    for file in &picture.outputs {
        files.push((file.path.clone(), encoded(file, scene, &film)?));
        // Outputs that differ in nothing but their endings have one camera file.
        let camera = file.camera_path().filter(|camera| files.iter().all(|(path, _)| path != camera));
        if let Some(path) = camera {
            let camera = camera_json(&scene.camera, scene.settings.size, None);
            files.push((path, format!("{camera:#}\n").into_bytes()));
        }
    }
    Ok(files)
}

fn encoded(file: &PictureFile, scene: &Scene, film: &Film) -> Result<Vec<u8>, BatchError> {
    let cannot_write = |cause| OutputError::Write { path: file.path.clone().into(), cause };
    let format = Format::from_path(file.path.as_ref())?;
    let mut bytes = Vec::new();
    if film.planes.is_empty() {
        encode(film, format, scene.settings.tone, &mut bytes).map_err(cannot_write)?;
        return Ok(bytes);
    }
    let wanted = |plane: &&Plane| file.aovs.iter().any(|aov| aov.channels().contains(&plane.name.as_str()));
    let planes = film.planes.iter().filter(wanted).cloned().collect();
    let film = Film { width: film.width, height: film.height, pixels: film.pixels.clone(), planes };
    encode(&film, format, scene.settings.tone, &mut bytes).map_err(cannot_write)?;
    Ok(bytes)
}
