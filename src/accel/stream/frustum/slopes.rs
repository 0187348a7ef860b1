//! Slopes of rays, and how far apart they go.

use wide::f32x8;

use crate::math::{Lane, Mask, Vec3, WIDTH};

/// Largest slope: beyond it rays go too far apart, or along another axis.
const MAX_SLOPE: f32 = 2.0;

/// Slopes: of one pyramid in all lanes, or of a packet a lane, or those at which eight boxes are seen.
#[derive(Clone, Copy, Debug)]
pub(super) struct Slopes {
    /// Least and greatest `x / z`.
    pub(super) a: [f32x8; 2],
    /// Least and greatest `y / z`.
    pub(super) b: [f32x8; 2],
}

impl Slopes {
    /// The largest, either way.
    pub(super) fn greatest(&self) -> f32x8 {
        let either = |s: [f32x8; 2]| Lane::max(s[0].abs(), s[1].abs());
        Lane::max(either(self.a), either(self.b))
    }
    /// Those of all lanes, and all between.
    #[inline(always)]
    pub(super) fn whole(&self) -> Self {
        let whole = |s: [f32x8; 2]| [f32x8::splat(least(s[0])), f32x8::splat(greatest(s[1]))];
        Self { a: whole(self.a), b: whole(self.b) }
    }
    /// Those of both, and all between, lane by lane.
    #[inline(always)]
    pub(super) fn union(&self, o: &Self) -> Self {
        let both = |s: [f32x8; 2], o: [f32x8; 2]| [Lane::min(s[0], o[0]), Lane::max(s[1], o[1])];
        Self { a: both(self.a, o.a), b: both(self.b, o.b) }
    }
    /// Lanes in which both have slopes in common.
    #[inline(always)]
    pub(super) fn overlap(&self, o: &Self) -> <f32x8 as Lane>::Mask {
        (self.a[0].le(o.a[1]) & o.a[0].le(self.a[1])) & (self.b[0].le(o.b[1]) & o.b[0].le(self.b[1]))
    }
    /// How far they are from others, at most zero where they have some in common.
    #[inline(always)]
    pub(super) fn apart(&self, a: [f32x8; 2], b: [f32x8; 2]) -> f32x8 {
        let [x, y] = [(self.a, a), (self.b, b)].map(|(s, o)| Lane::max(o[0] - s[1], s[0] - o[1]));
        Lane::max(x, y)
    }
    /// Lanes in which these reach over more than the others, one way or the other.
    #[inline(always)]
    pub(super) fn wider_than(&self, o: &Self) -> <f32x8 as Lane>::Mask {
        let wide = |s: [f32x8; 2]| s[1] - s[0];
        wide(self.a).gt(wide(o.a)) | wide(self.b).gt(wide(o.b))
    }
    /// Those of lane `i`, in all lanes.
    #[inline(always)]
    pub(super) fn splat(&self, i: usize) -> Self {
        let one = |s: [f32x8; 2]| [f32x8::splat(s[0].get(i)), f32x8::splat(s[1].get(i))];
        Self { a: one(self.a), b: one(self.b) }
    }
    /// How much they differ, one way or the other.
    #[inline(always)]
    pub(super) fn width(&self) -> f32x8 {
        Lane::max(self.a[1] - self.a[0], self.b[1] - self.b[0])
    }
    /// How much those of the first lane differ.
    pub(super) fn widest(&self) -> f32 {
        let wide = |s: [f32x8; 2]| s[1] - s[0];
        Lane::max(wide(self.a), wide(self.b)).get(0)
    }
    /// Relative to those of the middle.
    #[inline(always)]
    pub(super) fn about(&self, [a, b]: [f32x8; 2]) -> Self {
        Self { a: [self.a[0] - a, self.a[1] - a], b: [self.b[0] - b, self.b[1] - b] }
    }
}

/// Slopes of directions, their lengths along `z`, and the inverse of that. Lanes that are not asked take the slopes of one that is; without
/// any, zero.
#[inline(always)]
pub(super) fn slopes(d: Vec3<f32x8>, asked: u32) -> Option<(f32x8, f32x8, f32x8, f32x8)> {
    let most = d.z * f32x8::splat(MAX_SLOPE);
    let scale = f32x8::ONE / d.z;
    // Directions so short or long that it overflows or underflows would have slopes of no use.
    let is_normal = scale.ge(f32x8::splat(f32::MIN_POSITIVE)) & scale.le(f32x8::splat(f32::MAX));
    let fits = is_normal & d.x.abs().le(most) & d.y.abs().le(most);
    if asked & !fits.bits() != 0 {
        return None;
    }
    let (a, b) = (d.x * scale, d.y * scale);
    if asked == 0xff {
        return Some((a, b, d.z, scale));
    }
    Some((filled(a, asked), filled(b, asked), Lane::select(Mask::from_bits(asked), d.z, f32x8::ONE), scale))
}

/// The first lane that is asked in place of those that are not; zero without any.
#[inline(always)]
pub(super) fn filled(v: f32x8, asked: u32) -> f32x8 {
    let stand_in = if asked == 0 { 0.0 } else { v.get(asked.trailing_zeros() as usize % WIDTH) };
    Lane::select(Mask::from_bits(asked), v, f32x8::splat(stand_in))
}

/// Least and greatest of the lanes of row `j`, in lane `j`.
#[inline(always)]
pub(super) fn range(rows: [f32x8; WIDTH]) -> [f32x8; 2] {
    let c = f32x8::transpose(rows);
    [fold(c, Lane::min), fold(c, Lane::max)]
}

#[inline(always)]
pub(super) fn greatest(v: f32x8) -> f32 {
    fold(v.to_array(), |a, b| if a > b { a } else { b })
}

#[inline(always)]
pub(super) fn least(v: f32x8) -> f32 {
    fold(v.to_array(), |a, b| if a < b { a } else { b })
}

/// Three rounds, not a chain of seven.
#[inline(always)]
fn fold<T: Copy>(v: [T; WIDTH], f: impl Fn(T, T) -> T) -> T {
    let [a, b, c, d] = [f(v[0], v[4]), f(v[1], v[5]), f(v[2], v[6]), f(v[3], v[7])];
    f(f(a, c), f(b, d))
}
