//! Numbers of the scene file that may be written in two ways: once for all axes or channels, or one by one.

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{Deserializer, SeqAccess, Visitor};
use serde::ser::Serializer;
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::fmt;

/// A colour or a coefficient per channel: `0.5` (grey) or `[r, g, b]`, linear sRGB.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rgb(pub [f64; 3]);

/// Scale factors: `2` (all axes) or `[x, y, z]`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Factors(pub [f64; 3]);

impl Rgb {
    /// Black.
    pub const BLACK: Rgb = Rgb([0.0; 3]);
    /// White.
    pub const WHITE: Rgb = Rgb([1.0; 3]);

    /// The grey of one value.
    #[must_use]
    pub const fn grey(value: f64) -> Rgb {
        Rgb([value; 3])
    }
}

/// Accepts a number or an array of exactly three.
struct NumberOrThree;

impl<'de> Visitor<'de> for NumberOrThree {
    type Value = [f64; 3];

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a number or an array of three numbers")
    }

    fn visit_f64<E>(self, value: f64) -> Result<[f64; 3], E> {
        Ok([value; 3])
    }

    fn visit_i64<E>(self, value: i64) -> Result<[f64; 3], E> {
        Ok([value as f64; 3])
    }

    fn visit_u64<E>(self, value: u64) -> Result<[f64; 3], E> {
        Ok([value as f64; 3])
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<[f64; 3], A::Error> {
        let mut three = [0.0; 3];
        for (i, slot) in three.iter_mut().enumerate() {
            *slot = seq.next_element()?.ok_or_else(|| serde::de::Error::invalid_length(i, &self))?;
        }
        match seq.next_element::<f64>()? {
            None => Ok(three),
            Some(_) => Err(serde::de::Error::invalid_length(4, &self)),
        }
    }
}

/// Writes one number where all three are equal: what a person would write.
fn write_shortest<S: Serializer>(three: &[f64; 3], serializer: S) -> Result<S::Ok, S::Error> {
    let [x, y, z] = *three;
    if x == y && y == z { serializer.serialize_f64(x) } else { three.serialize(serializer) }
}

fn number_or_three(generator: &mut SchemaGenerator, description: &str) -> Schema {
    json_schema!({
        "description": description,
        "anyOf": [generator.subschema_for::<f64>(), generator.subschema_for::<[f64; 3]>()],
    })
}

macro_rules! number_or_three {
    ($name:ident, $description:literal) => {
        impl<'de> Deserialize<'de> for $name {
            fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                deserializer.deserialize_any(NumberOrThree).map($name)
            }
        }

        impl Serialize for $name {
            fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                write_shortest(&self.0, serializer)
            }
        }

        impl JsonSchema for $name {
            fn schema_name() -> Cow<'static, str> {
                stringify!($name).into()
            }

            fn json_schema(generator: &mut SchemaGenerator) -> Schema {
                number_or_three(generator, $description)
            }
        }
    };
}

number_or_three!(Rgb, "A colour or coefficient in linear sRGB: one number for grey, or [r, g, b].");
number_or_three!(Factors, "Scale factors: one number for all axes, or [x, y, z].");
