//! Values between keyframes.

use schemars::JsonSchema;
use serde::Deserialize;
use toml::Value;

use super::key;
use super::whole::whole;

/// Values of one key at some frames.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Keyframes {
    /// The key, as for `--set`.
    #[serde(deserialize_with = "key::one")]
    pub key: String,
    /// Frames, ascending.
    pub frames: Vec<f64>,
    /// A number or an array of numbers for each.
    #[schemars(with = "Vec<NumberOrNumbers>")]
    pub values: Vec<Value>,
    /// What lies between.
    #[serde(default)]
    pub interpolation: Interpolation,
}

/// How values between keyframes are found. Before the first and after the last keyframe its value holds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Interpolation {
    /// Straight lines.
    #[default]
    Linear,
    /// Smooth curves through all values.
    CatmullRom,
}

/// A value of a keyframe, for the schema.
#[derive(JsonSchema)]
#[serde(untagged)]
#[expect(dead_code, reason = "only its schema is used")]
enum NumberOrNumbers {
    Number(f64),
    Numbers(Vec<f64>),
}

/// A track of numbers over frames.
pub(super) struct Track<'a> {
    keyframes: &'a Keyframes,
    /// Components of each value.
    points: Vec<Vec<f64>>,
}

impl<'a> Track<'a> {
    /// A track that [`Track::at`] cannot fail on.
    pub(super) fn new(keyframes: &'a Keyframes) -> Result<Self, String> {
        let (frames, values) = (&keyframes.frames, &keyframes.values);
        let fault = |what: String| Err(format!("keyframes of `{}`: {what}", keyframes.key));
        if frames.is_empty() || frames.len() != values.len() {
            return fault(format!("{} frames and {} values: one value a frame", frames.len(), values.len()));
        }
        if !frames.windows(2).all(|w| w[0] < w[1]) {
            return fault("the frames must ascend".into());
        }
        if !frames.iter().all(|frame| frame.is_finite()) {
            return fault("frames are numbers, neither infinite nor nan".into());
        }
        let Some(points) = values.iter().map(components).collect::<Option<Vec<_>>>() else {
            return fault("values are numbers or arrays of numbers".into());
        };
        if points.iter().any(|point| point.len() != points[0].len()) {
            return fault("values have different lengths".into());
        }
        Ok(Self { keyframes, points })
    }

    /// `key=value` at a frame.
    pub(super) fn at(&self, frame: f64) -> String {
        let frames = &self.keyframes.frames;
        let after = frames.partition_point(|&f| f <= frame);
        let value = match after {
            0 => self.points[0].clone(),
            n if n == frames.len() => self.points[n - 1].clone(),
            n => self.between(n - 1, (frame - frames[n - 1]) / (frames[n] - frames[n - 1])),
        };
        let numbers: Vec<Value> = value.into_iter().map(|x| whole(&Value::Float(x))).collect();
        let text = match &self.keyframes.values[0] {
            Value::Array(_) => Value::Array(numbers).to_string(),
            _ => numbers[0].to_string(),
        };
        format!("{}={text}", self.keyframes.key)
    }

    /// `s` of the way from keyframe `k` to the next.
    fn between(&self, k: usize, s: f64) -> Vec<f64> {
        let component = |c: usize| {
            let (a, b) = (self.points[k][c], self.points[k + 1][c]);
            match self.keyframes.interpolation {
                Interpolation::Linear => a + (b - a) * s,
                Interpolation::CatmullRom => {
                    let length = self.keyframes.frames[k + 1] - self.keyframes.frames[k];
                    hermite([a, b], [self.slope(k, c) * length, self.slope(k + 1, c) * length], s)
                }
            }
        };
        (0..self.points[k].len()).map(component).collect()
    }

    /// Change a frame at a keyframe: that between its neighbours, at the ends that to the only neighbour.
    fn slope(&self, k: usize, c: usize) -> f64 {
        let (low, high) = (k.saturating_sub(1), (k + 1).min(self.points.len() - 1));
        let frames = &self.keyframes.frames;
        (self.points[high][c] - self.points[low][c]) / (frames[high] - frames[low])
    }
}

/// The cubic with these values and slopes at 0 and 1.
fn hermite([a, b]: [f64; 2], [m, n]: [f64; 2], s: f64) -> f64 {
    let (s2, s3) = (s * s, s * s * s);
    a * (2.0 * s3 - 3.0 * s2 + 1.0) + m * (s3 - 2.0 * s2 + s) + b * (3.0 * s2 - 2.0 * s3) + n * (s3 - s2)
}

fn components(value: &Value) -> Option<Vec<f64>> {
    let number = |value: &Value| value.as_float().or(value.as_integer().map(|i| i as f64));
    match value {
        Value::Array(values) => values.iter().map(number).collect(),
        value => number(value).map(|x| vec![x]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn keyframes(text: &str) -> Keyframes {
        toml::from_str(text).unwrap()
    }

    fn value(track: &Track, frame: f64) -> f64 {
        track.at(frame).strip_prefix("k=").unwrap().parse().unwrap()
    }

    #[test]
    fn lines_hold_their_ends() {
        let k = keyframes("key='k'\nframes=[1, 3, 7]\nvalues=[0, 4, 0]");
        let track = Track::new(&k).unwrap();
        let found = [-5.0, 1.0, 2.0, 3.0, 4.0, 7.0, 9.0].map(|f| value(&track, f));
        assert_eq!(found, [0.0, 0.0, 2.0, 4.0, 3.0, 0.0, 0.0]);
    }

    /// A curve through points of a straight line is that line, however unevenly they lie.
    #[test]
    fn curves_go_through_their_values_and_keep_lines_straight() {
        let k = keyframes("key='k'\nframes=[0, 1, 5, 6]\nvalues=[0, 2, 10, 12]\ninterpolation='catmull_rom'");
        let track = Track::new(&k).unwrap();
        for frame in [0.0, 0.5, 1.0, 2.0, 4.9, 5.0, 5.5, 6.0] {
            assert!((value(&track, frame) - 2.0 * frame).abs() < 1e-12, "{frame}");
        }
        let k = keyframes("key='k'\nframes=[0, 1, 2]\nvalues=[0, 1, 0]\ninterpolation='catmull_rom'");
        let track = Track::new(&k).unwrap();
        assert_eq!(value(&track, 1.0), 1.0);
        assert!((value(&track, 0.999) - value(&track, 1.001)).abs() < 1e-9, "no kink at the top");
    }

    #[test]
    fn vectors_stay_vectors() {
        let k = keyframes("key='k'\nframes=[0, 2]\nvalues=[[0, 1, 2], [2, 1, 0]]");
        assert_eq!(Track::new(&k).unwrap().at(1.0), "k=[1, 1, 1]");
    }

    /// Keys that count things take the whole numbers of a track, and refuse what lies between.
    #[test]
    fn whole_numbers_stay_whole() {
        let k = keyframes("key='k'\nframes=[0, 2, 4]\nvalues=[1, 3, 4.0]");
        let track = Track::new(&k).unwrap();
        let found = [0.0, 1.0, 2.0, 3.0, 4.0].map(|frame| track.at(frame));
        assert_eq!(found, ["k=1", "k=2", "k=3", "k=3.5", "k=4"]);
    }

    #[test]
    fn bad_tracks_are_named() {
        for (text, word) in [
            ("frames=[]\nvalues=[]", "one value a frame"),
            ("frames=[1]\nvalues=[1, 2]", "one value a frame"),
            ("frames=[nan]\nvalues=[1]", "neither infinite"),
            ("frames=[1, inf]\nvalues=[1, 2]", "neither infinite"),
            ("frames=[2, 1]\nvalues=[1, 2]", "ascend"),
            ("frames=[1, 2]\nvalues=['a', 'b']", "numbers"),
            ("frames=[1, 2]\nvalues=[1, [2, 3]]", "lengths"),
        ] {
            let k = keyframes(&format!("key='k'\n{text}"));
            let error = Track::new(&k).err().unwrap();
            assert!(error.contains("`k`") && error.contains(word), "{error}");
        }
    }
}
