//! Axis-aligned boxes.

/// A box that holds everything from `min` to `max`, both included.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb {
    /// Least coordinates.
    pub min: [f32; 3],
    /// Greatest coordinates.
    pub max: [f32; 3],
}

impl Aabb {
    /// The box of nothing: joining it to another gives the other.
    pub const EMPTY: Self = Self { min: [f32::INFINITY; 3], max: [f32::NEG_INFINITY; 3] };

    /// The smallest `f32` box around points given in `f64`.
    pub fn around(points: impl IntoIterator<Item = [f64; 3]>) -> Self {
        points.into_iter().fold(Self::EMPTY, |b, p| Self {
            min: std::array::from_fn(|k| b.min[k].min(round_down(p[k]))),
            max: std::array::from_fn(|k| b.max[k].max(round_up(p[k]))),
        })
    }
    /// The smallest box around both.
    pub fn join(self, o: Self) -> Self {
        Self {
            min: std::array::from_fn(|k| self.min[k].min(o.min[k])),
            max: std::array::from_fn(|k| self.max[k].max(o.max[k])),
        }
    }
    /// The box with a point added.
    pub fn join_point(self, p: [f32; 3]) -> Self {
        self.join(Self { min: p, max: p })
    }
    /// The part that both cover; may be empty.
    pub fn intersection(self, o: Self) -> Self {
        Self {
            min: std::array::from_fn(|k| self.min[k].max(o.min[k])),
            max: std::array::from_fn(|k| self.max[k].min(o.max[k])),
        }
    }
    /// True if no point is inside.
    pub fn is_empty(&self) -> bool {
        !(0..3).all(|k| self.min[k] <= self.max[k])
    }
    /// True if `o` lies inside, faces included.
    pub fn contains(&self, o: &Self) -> bool {
        o.is_empty() || (0..3).all(|k| self.min[k] <= o.min[k] && o.max[k] <= self.max[k])
    }
    /// Middle of the box; without overflow.
    pub fn center(&self) -> [f32; 3] {
        std::array::from_fn(|k| 0.5 * self.min[k] + 0.5 * self.max[k])
    }
    /// Edge lengths; zero for an empty box.
    pub fn size(&self) -> [f32; 3] {
        std::array::from_fn(|k| (self.max[k] - self.min[k]).max(0.0))
    }
    /// Half the surface area, which is what the surface area heuristic compares.
    pub fn half_area(&self) -> f32 {
        let [x, y, z] = self.size();
        x * y + y * z + z * x
    }
    /// The largest magnitude of a coordinate; zero for an empty box.
    pub fn magnitude(&self) -> f32 {
        if self.is_empty() {
            return 0.0;
        }
        (0..3).fold(0.0, |m: f32, k| m.max(self.min[k].abs()).max(self.max[k].abs()))
    }
    /// The box grown by `by` on every side.
    pub fn padded(self, by: f32) -> Self {
        Self {
            min: std::array::from_fn(|k| (self.min[k] - by).next_down()),
            max: std::array::from_fn(|k| (self.max[k] + by).next_up()),
        }
    }
    /// The eight corners.
    pub fn corners(&self) -> [[f32; 3]; 8] {
        std::array::from_fn(|i| {
            std::array::from_fn(|k| if i >> k & 1 == 0 { self.min[k] } else { self.max[k] })
        })
    }
}

/// The largest `f32` not above `x`.
fn round_down(x: f64) -> f32 {
    let y = x as f32;
    if f64::from(y) > x { y.next_down() } else { y }
}

/// The smallest `f32` not below `x`.
fn round_up(x: f64) -> f32 {
    let y = x as f32;
    if f64::from(y) < x { y.next_up() } else { y }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn around_encloses_what_f32_cannot_hold() {
        let p = [0.1, 1e40, -1e40];
        let b = Aabb::around([p]);
        let holds = |k: usize| f64::from(b.min[k]) <= p[k] && p[k] <= f64::from(b.max[k]);
        assert!((0..3).all(holds), "{b:?}");
    }

    #[test]
    fn the_empty_box_is_neutral_and_empty() {
        let b = Aabb { min: [0.0; 3], max: [1.0; 3] };
        assert_eq!(Aabb::EMPTY.join(b), b);
        assert!(Aabb::EMPTY.is_empty() && b.contains(&Aabb::EMPTY));
        assert_eq!(Aabb::EMPTY.half_area(), 0.0);
    }
}
