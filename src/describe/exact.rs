//! Arrays of a fixed length. Left to themselves, TOML readers take what they need and drop the rest of a longer one.

use serde::Deserialize;
use serde::de::{Deserializer, Error, IgnoredAny, SeqAccess, Visitor};
use std::fmt;
use std::marker::PhantomData;

/// Reads arrays inside a type, refusing those that are longer: for `#[serde(deserialize_with = "exact::read")]`.
pub(crate) fn read<'de, T: Exact<'de>, D: Deserializer<'de>>(deserializer: D) -> Result<T, D::Error> {
    T::Strict::deserialize(deserializer).map(T::of)
}

/// Types with arrays of a fixed length inside.
pub(crate) trait Exact<'de> {
    /// What is read in place of it.
    type Strict: Deserialize<'de>;

    fn of(strict: Self::Strict) -> Self;
}

macro_rules! number {
    ($($number:ty),*) => {$(
        impl<'de> Exact<'de> for $number {
            type Strict = Self;

            fn of(strict: Self) -> Self {
                strict
            }
        }
    )*};
}

number!(f64, u32);

impl<'de, T: Exact<'de>> Exact<'de> for Option<T> {
    type Strict = Option<T::Strict>;

    fn of(strict: Self::Strict) -> Self {
        strict.map(T::of)
    }
}

impl<'de, T: Exact<'de>> Exact<'de> for Vec<T> {
    type Strict = Vec<T::Strict>;

    fn of(strict: Self::Strict) -> Self {
        strict.into_iter().map(T::of).collect()
    }
}

impl<'de, T: Exact<'de>, const N: usize> Exact<'de> for [T; N] {
    type Strict = Array<T::Strict, N>;

    fn of(strict: Self::Strict) -> Self {
        strict.0.map(T::of)
    }
}

/// An array that is neither shorter nor longer.
pub(crate) struct Array<T, const N: usize>([T; N]);

impl<'de, T: Deserialize<'de>, const N: usize> Deserialize<'de> for Array<T, N> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_seq(Elements(PhantomData)).map(Self)
    }
}

/// Takes the elements of an array.
struct Elements<T, const N: usize>(PhantomData<T>);

impl<'de, T: Deserialize<'de>, const N: usize> Visitor<'de> for Elements<T, N> {
    type Value = [T; N];

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "an array of length {N}")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<[T; N], A::Error> {
        let mut elements = Vec::with_capacity(N);
        while elements.len() < N {
            let next = seq.next_element()?;
            elements.push(next.ok_or_else(|| A::Error::invalid_length(elements.len(), &self))?);
        }
        let mut length = N;
        while seq.next_element::<IgnoredAny>()?.is_some() {
            length += 1;
        }
        let right = elements.try_into().ok().filter(|_| length == N);
        right.ok_or_else(|| A::Error::invalid_length(length, &self))
    }
}
