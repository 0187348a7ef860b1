//! Pixel filters, applied by sampling them.
//!
//! A sample is shot through a place drawn from the filter, so it counts for its own pixel alone: pixels stay independent,
//! and a filter of any width costs nothing. **Source:** Ernst, Stamminger and Greiner, Filter Importance Sampling, 2006.

use super::quantile::Quantiles;
use crate::math::Lane;

/// A separable reconstruction filter; `radius` is half its width.
///
/// **Units:** pixels. **Needs:** finite numbers, `radius >= 0`, `sigma > 0`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PixelFilter {
    /// Constant. Radius 0.5 is the pixel itself.
    Box {
        /// Half the width.
        radius: f32,
    },
    /// Falls linearly to zero.
    Tent {
        /// Half the width.
        radius: f32,
    },
    /// A bell, lowered so that it is zero at the radius.
    Gaussian {
        /// Half the width.
        radius: f32,
        /// Standard deviation of the bell before it is cut.
        sigma: f32,
    },
    /// The cubic of Mitchell and Netravali (Reconstruction Filters in Computer Graphics, 1988), stretched to the radius.
    Mitchell {
        /// Half the width; 2 is the cubic as published.
        radius: f32,
        /// Blur; 1/3 in the paper.
        b: f32,
        /// Ringing; 1/3 in the paper.
        c: f32,
    },
}

impl PixelFilter {
    /// Half the width, in pixels.
    pub fn radius(&self) -> f32 {
        match *self {
            Self::Box { radius }
            | Self::Tent { radius }
            | Self::Gaussian { radius, .. }
            | Self::Mitchell { radius, .. } => radius,
        }
    }

    /// True if some places count negatively, so that weights differ in sign.
    ///
    /// Then a pixel is the weighted sum over the sum of weights; otherwise the sum over the number of samples.
    pub fn has_negative_lobes(&self) -> bool {
        (0..=256).any(|k| self.value(f64::from(k) / 256.0) < -1e-9)
    }

    /// The filter along one axis at `t` radii from the centre, up to a factor.
    fn value(&self, t: f64) -> f64 {
        match *self {
            Self::Box { .. } => 1.0,
            Self::Tent { .. } => 1.0 - t,
            Self::Gaussian { radius, sigma } => {
                let bell = |t: f64| libm::exp(-0.5 * (t * f64::from(radius) / f64::from(sigma)).powi(2));
                bell(t) - bell(1.0)
            }
            Self::Mitchell { b, c, .. } => Cubic::new(b, c).value(2.0 * t),
        }
    }

    /// The filter made ready for sampling.
    pub fn sampler(&self) -> FilterSampler {
        let table = || Quantiles::new(|t| self.value(t).abs());
        let shape = match *self {
            Self::Box { .. } => Shape::Box,
            Self::Tent { .. } => Shape::Tent,
            Self::Gaussian { .. } => Shape::Bell(table()),
            Self::Mitchell { b, c, .. } => Shape::Cubic(table(), Cubic::new(b, c)),
        };
        FilterSampler { radius: self.radius(), shape }
    }
}

/// Draws places from a [`PixelFilter`].
#[derive(Clone, Debug, PartialEq)]
pub struct FilterSampler {
    radius: f32,
    shape: Shape,
}

#[derive(Clone, Debug, PartialEq)]
enum Shape {
    Box,
    Tent,
    Bell(Quantiles),
    Cubic(Quantiles, Cubic),
}

impl FilterSampler {
    /// An offset from the pixel centre and a weight of +1 or -1, from two numbers in `[0, 1)`.
    ///
    /// Offsets have the density of the filter's magnitude, each monotone in its number; the weight is the filter's sign.
    ///
    /// **Accuracy:** box and tent exact to rounding; Gaussian and Mitchell within 7e-5 in distribution, from a table.
    #[inline(always)]
    pub fn sample<L: Lane>(&self, u: L, v: L) -> (L, L, L) {
        let radius = L::constant(f64::from(self.radius));
        let place = |x: L, y: L, weight: L| (x * radius, y * radius, weight);
        match &self.shape {
            Shape::Box => place(u + u - L::one(), v + v - L::one(), L::one()),
            Shape::Tent => place(tent(u), tent(v), L::one()),
            Shape::Bell(table) => place(table.sample(u), table.sample(v), L::one()),
            Shape::Cubic(table, cubic) => {
                let (x, y) = (table.sample(u), table.sample(v));
                place(x, y, cubic.sign(x) * cubic.sign(y))
            }
        }
    }
}

/// The inverse distribution function of `1 - |t|` on `[-1, 1]`.
#[inline(always)]
fn tent<L: Lane>(u: L) -> L {
    let centred = u + u - L::one();
    (L::one() - (L::one() - centred.abs()).sqrt()).with_sign_of(centred)
}

/// The cubic of Mitchell and Netravali, times 6, in Horner's form; the outer part with its double root at 2 split off, which
/// keeps the sign right close to it.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Cubic {
    /// `inner[0] + x^2 (inner[1] + x inner[2])` for `x < 1`.
    inner: [f64; 3],
    /// `(2 - x)^2 (outer[0] + x outer[1])` for `x >= 1`.
    outer: [f64; 2],
}

impl Cubic {
    fn new(b: f32, c: f32) -> Self {
        let (b, c) = (f64::from(b), f64::from(c));
        let inner = [6.0 - 2.0 * b, -18.0 + 12.0 * b + 6.0 * c, 12.0 - 9.0 * b - 6.0 * c];
        Self { inner, outer: [2.0 * b + 6.0 * c, -(b + 6.0 * c)] }
    }

    /// The value at `x` in `[0, 2]`.
    fn value(&self, x: f64) -> f64 {
        let [i0, i2, i3] = self.inner;
        let [o0, o1] = self.outer;
        if x < 1.0 { i0 + x * x * (i2 + x * i3) } else { (2.0 - x).powi(2) * (o0 + x * o1) }
    }

    /// -1 where the cubic is negative at `t` radii from the centre, else 1.
    #[inline(always)]
    fn sign<L: Lane>(&self, t: L) -> L {
        let x = t.abs() + t.abs();
        let [i0, i2, i3] = self.inner.map(L::constant);
        let [o0, o1] = self.outer.map(L::constant);
        let value = L::select(x.lt(L::one()), i0 + x * x * (i2 + x * i3), o0 + x * o1);
        L::select(value.lt(L::zero()), -L::one(), L::one())
    }
}

#[cfg(test)]
mod tests;
