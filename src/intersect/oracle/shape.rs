//! What lines are asked against.

/// A cylinder with its axis from `from` to `to`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cylinder {
    /// Centre of the first cap.
    pub from: [f64; 3],
    /// Centre of the second cap.
    pub to: [f64; 3],
    /// Radius, positive.
    pub radius: f64,
    /// Closed by caps, or open at both ends.
    pub capped: bool,
}

/// A primitive. **Needs:** finite numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape {
    /// Three corners; edges and corners belong to it.
    Triangle([[f64; 3]; 3]),
    /// A sphere.
    Sphere {
        /// Centre.
        center: [f64; 3],
        /// Radius, positive.
        radius: f64,
    },
    /// A cylinder.
    Cylinder(Cylinder),
    /// A box along the axes, which counts as solid: faces belong to it.
    Box {
        /// Least coordinates.
        min: [f64; 3],
        /// Greatest coordinates.
        max: [f64; 3],
    },
}

impl Shape {
    /// The shape with its surface moved outwards by `by`, or inwards; nothing where nothing would be left, and for a
    /// triangle, which has no inside.
    ///
    /// **Accuracy:** some roundoffs of `f64` in each coordinate.
    pub fn grown(&self, by: f64) -> Option<Self> {
        match *self {
            Self::Triangle(_) => None,
            Self::Sphere { center, radius } => {
                let radius = radius + by;
                (radius > 0.0).then_some(Self::Sphere { center, radius })
            }
            Self::Cylinder(c) => c.grown(by).map(Self::Cylinder),
            Self::Box { min, max } => {
                let (min, max) = (min.map(|x| x - by), max.map(|x| x + by));
                (0..3).all(|k| min[k] <= max[k]).then_some(Self::Box { min, max })
            }
        }
    }

    /// The largest magnitude of a coordinate of the surface, give or take a factor of two.
    pub fn magnitude(&self) -> f64 {
        let of = |points: &[[f64; 3]]| points.iter().flatten().fold(0.0, |m: f64, x| m.max(x.abs()));
        match self {
            Self::Triangle(corners) => of(corners),
            Self::Sphere { center, radius } => of(&[*center]) + radius,
            Self::Cylinder(c) => of(&[c.from, c.to]) + c.radius,
            Self::Box { min, max } => of(&[*min, *max]),
        }
    }
}

impl Cylinder {
    fn grown(&self, by: f64) -> Option<Self> {
        let axis: [f64; 3] = std::array::from_fn(|k| self.to[k] - self.from[k]);
        let length = axis.iter().map(|x| x * x).sum::<f64>().sqrt();
        let radius = self.radius + by;
        if radius <= 0.0 || length + 2.0 * by <= 0.0 {
            return None;
        }
        let moved = |p: [f64; 3], by: f64| std::array::from_fn(|k| p[k] + by * (axis[k] / length));
        Some(Self { from: moved(self.from, -by), to: moved(self.to, by), radius, ..*self })
    }
}
