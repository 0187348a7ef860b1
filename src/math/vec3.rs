//! Vectors of three lanes.

use std::ops::{Add, AddAssign, Mul, Neg, Sub};

use super::{Lane, Real, three};

/// Three lanes: a point, direction or colour a lane.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Vec3<L> {
    /// First component.
    pub x: L,
    /// Second component.
    pub y: L,
    /// Third component.
    pub z: L,
}

impl<L: Lane> Vec3<L> {
    /// A vector from its components.
    #[inline(always)]
    pub fn new(x: L, y: L, z: L) -> Self {
        Self { x, y, z }
    }
    /// The same scalar vector in each lane.
    #[inline(always)]
    pub fn splat(v: [L::Scalar; 3]) -> Self {
        Self::new(L::splat(v[0]), L::splat(v[1]), L::splat(v[2]))
    }
    /// The same `f32` vector in each lane, exactly.
    #[inline(always)]
    pub fn splat_f32(v: [f32; 3]) -> Self {
        Self::splat(three(|k| L::Scalar::from_f32(v[k])))
    }
    /// The zero vector.
    #[inline(always)]
    pub fn zero() -> Self {
        Self::new(L::zero(), L::zero(), L::zero())
    }
    /// Lane `i` is `vectors(i)`.
    #[inline(always)]
    pub fn gather<'a>(vectors: impl Fn(usize) -> &'a Vec3<L::Scalar>) -> Self
    where
        L::Scalar: 'a,
    {
        Self::new(L::from_fn(|i| vectors(i).x), L::from_fn(|i| vectors(i).y), L::from_fn(|i| vectors(i).z))
    }
    /// A component: 0 is `x`, 1 is `y`, all others `z`.
    #[inline(always)]
    pub fn axis(&self, k: usize) -> L {
        *match k {
            0 => &self.x,
            1 => &self.y,
            _ => &self.z,
        }
    }
    /// Lane `i` as an array.
    #[inline(always)]
    pub fn get(&self, i: usize) -> [L::Scalar; 3] {
        [self.x.get(i), self.y.get(i), self.z.get(i)]
    }
    /// Eight stored `f32` vectors, or the first, exactly.
    #[inline(always)]
    pub fn load_f32(columns: &[[f32; 8]; 3]) -> Self {
        Self::new(L::load_f32(&columns[0]), L::load_f32(&columns[1]), L::load_f32(&columns[2]))
    }
    /// Inner product, summed x, y, z.
    #[inline(always)]
    pub fn dot(self, o: Self) -> L {
        self.x * o.x + self.y * o.y + self.z * o.z
    }
    /// Outer product.
    #[inline(always)]
    pub fn cross(self, o: Self) -> Self {
        Self::new(self.y * o.z - self.z * o.y, self.z * o.x - self.x * o.z, self.x * o.y - self.y * o.x)
    }
    /// Product by component.
    #[inline(always)]
    pub fn scale(self, o: Self) -> Self {
        Self::new(self.x * o.x, self.y * o.y, self.z * o.z)
    }
    /// Squared length.
    #[inline(always)]
    pub fn length_squared(self) -> L {
        self.dot(self)
    }
    /// Length.
    #[inline(always)]
    pub fn length(self) -> L {
        self.length_squared().sqrt()
    }
    /// The vector over its length; NaN for the zero vector.
    #[inline(always)]
    pub fn normalize(self) -> Self {
        self * (L::one() / self.length())
    }
    /// Magnitude by component.
    #[inline(always)]
    pub fn abs(self) -> Self {
        Self::new(self.x.abs(), self.y.abs(), self.z.abs())
    }
    /// The smaller by component.
    #[inline(always)]
    pub fn min(self, o: Self) -> Self {
        Self::new(self.x.min(o.x), self.y.min(o.y), self.z.min(o.z))
    }
    /// The larger by component.
    #[inline(always)]
    pub fn max(self, o: Self) -> Self {
        Self::new(self.x.max(o.x), self.y.max(o.y), self.z.max(o.z))
    }
    /// The largest component.
    #[inline(always)]
    pub fn max_component(self) -> L {
        self.x.max(self.y).max(self.z)
    }
    /// `yes` where the mask is true, `no` elsewhere.
    #[inline(always)]
    pub fn select(mask: L::Mask, yes: Self, no: Self) -> Self {
        Self::new(L::select(mask, yes.x, no.x), L::select(mask, yes.y, no.y), L::select(mask, yes.z, no.z))
    }
    /// The components as `f64`, exactly.
    #[inline(always)]
    pub fn widen(self) -> Vec3<L::Double> {
        Vec3 { x: self.x.widen(), y: self.y.widen(), z: self.z.widen() }
    }
    /// The nearest vector of this lane type.
    #[inline(always)]
    pub fn narrow(v: Vec3<L::Double>) -> Self {
        Self::new(L::narrow(v.x), L::narrow(v.y), L::narrow(v.z))
    }
}

/// Inner product, fused where the build fuses: see [`Lane::mul_add_fast`].
#[inline(always)]
pub fn fused_dot<L: Lane>(a: Vec3<L>, b: Vec3<L>) -> L {
    a.x.mul_add_fast(b.x, a.y.mul_add_fast(b.y, a.z * b.z))
}

/// Outer product, fused where the build fuses: see [`Lane::mul_add_fast`].
#[inline(always)]
pub fn fused_cross<L: Lane>(a: Vec3<L>, b: Vec3<L>) -> Vec3<L> {
    Vec3::new(
        a.y.mul_add_fast(b.z, -(a.z * b.y)),
        a.z.mul_add_fast(b.x, -(a.x * b.z)),
        a.x.mul_add_fast(b.y, -(a.y * b.x)),
    )
}

impl<L: Lane> Add for Vec3<L> {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        Self::new(self.x + o.x, self.y + o.y, self.z + o.z)
    }
}
impl<L: Lane> AddAssign for Vec3<L> {
    #[inline(always)]
    fn add_assign(&mut self, o: Self) {
        *self = *self + o;
    }
}
impl<L: Lane> Sub for Vec3<L> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        Self::new(self.x - o.x, self.y - o.y, self.z - o.z)
    }
}
impl<L: Lane> Mul<L> for Vec3<L> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, s: L) -> Self {
        Self::new(self.x * s, self.y * s, self.z * s)
    }
}
impl<L: Lane> Neg for Vec3<L> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self::new(-self.x, -self.y, -self.z)
    }
}
