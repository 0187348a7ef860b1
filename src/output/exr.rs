//! OpenEXR: 32-bit linear light in the channels R, G, B, and one channel (float or uint) for each plane, through the `exr` crate.

use std::io::{self, Cursor, Write};

use exr::prelude::{
    AnyChannel, AnyChannels, Encoding, Error, FlatSamples, Image, ReadChannels, ReadLayers, SmallVec,
    WritableImage, read,
};

use crate::film::{Film, Plane, PlaneValues};

const COLOURS: [&str; 3] = ["R", "G", "B"];

/// Writes `film` in lossless ZIP blocks of 16 rows, always in the same order.
pub(super) fn write(film: &Film, writer: &mut dyn Write) -> io::Result<()> {
    let size = (film.width as usize, film.height as usize);
    let image = Image::from_encoded_channels(size, Encoding::SMALL_LOSSLESS, channels(film));
    // The format patches its offset table at the end, so it needs a place to seek in.
    let mut bytes = Cursor::new(Vec::new());
    // On this thread alone: the crate would start one thread for each core, whatever number the user asked for.
    image.write().non_parallel().to_buffered(&mut bytes).map_err(into_io)?;
    writer.write_all(bytes.get_ref())
}

/// The film in the first layer that has R, G and B; every other channel becomes a plane.
pub(super) fn decode(bytes: &[u8]) -> Result<Film, String> {
    let image = read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .first_valid_layer()
        .all_attributes()
        .from_buffered(Cursor::new(bytes))
        .map_err(|error| error.to_string())?;
    let layer = image.layer_data;
    let mut planes: Vec<Plane> = layer.channel_data.list.into_iter().map(plane).collect();
    let [red, green, blue] = COLOURS.map(|name| take(&mut planes, name));
    let (red, green, blue) = (red?, green?, blue?);
    let pixels = (0..red.len()).map(|i| [red[i], green[i], blue[i]]).collect();
    let (width, height) = (layer.size.0 as u32, layer.size.1 as u32);
    let film = Film::from_pixels(width, height, pixels).ok_or("the channels differ in size")?;
    Ok(Film { planes, ..film })
}

fn channels(film: &Film) -> AnyChannels<FlatSamples> {
    let colours = COLOURS.iter().enumerate().map(|(index, &name)| {
        AnyChannel::new(name, FlatSamples::F32(film.pixels.iter().map(|pixel| pixel[index]).collect()))
    });
    let planes = film.planes.iter().map(|plane| AnyChannel::new(plane.name.as_str(), samples(&plane.values)));
    AnyChannels::sort(colours.chain(planes).collect::<SmallVec<_>>())
}

fn samples(values: &PlaneValues) -> FlatSamples {
    match values {
        PlaneValues::Float(values) => FlatSamples::F32(values.clone()),
        PlaneValues::Uint(values) => FlatSamples::U32(values.clone()),
    }
}

fn plane(channel: AnyChannel<FlatSamples>) -> Plane {
    let values = match channel.sample_data {
        FlatSamples::U32(values) => PlaneValues::Uint(values),
        FlatSamples::F32(values) => PlaneValues::Float(values),
        half => PlaneValues::Float(half.values_as_f32().collect()),
    };
    Plane { name: channel.name.to_string(), values }
}

/// Removes the plane of this name.
fn take(planes: &mut Vec<Plane>, name: &str) -> Result<Vec<f32>, String> {
    let index = planes.iter().position(|plane| plane.name == name);
    match index.map(|index| planes.remove(index).values) {
        Some(PlaneValues::Float(values)) => Ok(values),
        Some(PlaneValues::Uint(_)) => Err(format!("channel {name} holds whole numbers, not light")),
        None => {
            let others: String = planes.iter().map(|plane| format!(" {}", plane.name)).collect();
            Err(format!(
                "has no channel {name}; others there:{}",
                if others.is_empty() { " none" } else { &others }
            ))
        }
    }
}

fn into_io(error: Error) -> io::Error {
    match error {
        Error::Io(error) => error,
        other => io::Error::other(other),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn planes_and_odd_values_come_back() {
        let mut film =
            Film::from_pixels(2, 1, vec![[1.0, f32::INFINITY, -3.0], [1e-40, 0.1, 65505.0]]).unwrap();
        let depth = PlaneValues::Float(vec![1.5, f32::INFINITY]);
        film.planes.push(Plane { name: "depth.Z".into(), values: depth });
        film.planes.push(Plane { name: "id.object".into(), values: PlaneValues::Uint(vec![u32::MAX, 0]) });
        let mut bytes = Vec::new();
        write(&film, &mut bytes).unwrap();
        assert_eq!(decode(&bytes), Ok(film));
    }

    #[test]
    fn a_file_without_colour_is_named() {
        let depth = AnyChannel::new("Z", FlatSamples::F32(vec![1.0]));
        let channels = AnyChannels::sort([depth].into_iter().collect::<SmallVec<_>>());
        let mut bytes = Cursor::new(Vec::new());
        Image::from_channels((1, 1), channels).write().to_buffered(&mut bytes).unwrap();
        assert_eq!(decode(bytes.get_ref()), Err("has no channel R; others there: Z".into()));
    }

    #[test]
    fn values_that_are_no_number_stay() {
        let mut bytes = Vec::new();
        write(&Film::from_pixels(1, 1, vec![[f32::NAN, 0.0, 1.0]]).unwrap(), &mut bytes).unwrap();
        assert!(decode(&bytes).unwrap().pixels[0][0].is_nan());
    }
}
