//! All values beside colour of one pixel, and their way to the planes.

use super::{Aov, AovSet, Plane, PlaneValues};

/// What the ray through the centre of one pixel found; the default is nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AovSample {
    /// See [`Aov::Depth`].
    pub depth: f32,
    /// See [`Aov::Position`].
    pub position: [f32; 3],
    /// See [`Aov::GeometricNormal`].
    pub geometric_normal: [f32; 3],
    /// See [`Aov::ShadingNormal`].
    pub shading_normal: [f32; 3],
    /// See [`Aov::Uv`].
    pub uv: [f32; 2],
    /// See [`Aov::Albedo`].
    pub albedo: [f32; 3],
    /// See [`Aov::ObjectId`].
    pub object: u32,
    /// See [`Aov::PrimitiveId`].
    pub primitive: u32,
    /// See [`Aov::MaterialId`].
    pub material: u32,
    /// See [`Aov::Hit`].
    pub hit: bool,
}

impl Default for AovSample {
    fn default() -> Self {
        Self {
            depth: f32::INFINITY,
            position: [0.0; 3],
            geometric_normal: [0.0; 3],
            shading_normal: [0.0; 3],
            uv: [0.0; 2],
            albedo: [0.0; 3],
            object: 0,
            primitive: 0,
            material: 0,
            hit: false,
        }
    }
}

impl AovSample {
    /// Writes the pixel `at` of the planes that [`AovSet::planes`] made; sample counts are not its matter.
    pub fn store(&self, set: AovSet, planes: &mut [Plane], at: usize) {
        let mut planes = planes.iter_mut();
        for aov in set.iter() {
            for channel in 0..aov.channels().len() {
                match &mut planes.next().expect("a plane for each channel").values {
                    PlaneValues::Float(values) => values[at] = self.float(aov, channel),
                    PlaneValues::Uint(values) if aov != Aov::SampleCount => values[at] = self.uint(aov),
                    PlaneValues::Uint(_) => {}
                }
            }
        }
    }

    fn float(&self, aov: Aov, channel: usize) -> f32 {
        match aov {
            Aov::Depth => self.depth,
            Aov::Position => self.position[channel],
            Aov::GeometricNormal => self.geometric_normal[channel],
            Aov::ShadingNormal => self.shading_normal[channel],
            Aov::Uv => self.uv[channel],
            Aov::Albedo => self.albedo[channel],
            _ => unreachable!("{} is a whole number", aov.name()),
        }
    }

    fn uint(&self, aov: Aov) -> u32 {
        match aov {
            Aov::ObjectId => self.object,
            Aov::PrimitiveId => self.primitive,
            Aov::MaterialId => self.material,
            _ => u32::from(self.hit),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_go_to_the_planes_of_their_names() {
        let set: AovSet = [Aov::ObjectId, Aov::Depth, Aov::Uv].into_iter().collect();
        let mut planes = set.planes(2);
        AovSample { depth: 2.0, uv: [0.25, 0.75], object: 7, ..Default::default() }.store(
            set,
            &mut planes,
            0,
        );
        AovSample::default().store(set, &mut planes, 1);
        let found: Vec<_> = planes.iter().map(|plane| (plane.name.as_str(), &plane.values)).collect();
        let expected = [
            ("depth.Z", &PlaneValues::Float(vec![2.0, f32::INFINITY])),
            ("uv.U", &PlaneValues::Float(vec![0.25, 0.0])),
            ("uv.V", &PlaneValues::Float(vec![0.75, 0.0])),
            ("id.object", &PlaneValues::Uint(vec![7, 0])),
        ];
        assert_eq!(found, expected);
    }
}
