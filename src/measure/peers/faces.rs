//! What the crates in Rust have in common: triangles only, one ray at a time.

use std::time::Instant;

use crate::intersect::{PrimId, PrimKind};
use crate::measure::bench::{BuildReport, Engine, HitColumns, NO_HIT, RayColumns, Subject};

/// A tree over the triangles of a subject.
pub(super) trait Faces: Sync {
    /// Name of the crate.
    const NAME: &'static str;
    /// How it builds.
    const MODE: &'static str;

    /// Builds the tree.
    fn build(corners: &[[[f32; 3]; 3]]) -> Self;
    /// Distance and number of the nearest triangle.
    fn nearest(&self, ray: [[f32; 3]; 2], range: [f32; 2]) -> Option<(f32, usize)>;
    /// Whether there is any triangle.
    fn any(&self, ray: [[f32; 3]; 2], range: [f32; 2]) -> bool;
}

/// A tree as an engine.
pub(super) struct FacesEngine<F>(F);

impl<F: Faces> FacesEngine<F> {
    /// Builds the tree of a subject. **Errors:** a subject with other things than triangles.
    pub(super) fn build(subject: &Subject) -> Result<(Self, BuildReport), String> {
        let triangles = &subject.geometry.triangles;
        if subject.primitive_count() > triangles.len() || !subject.geometry.instances.is_empty() {
            return Err("it knows triangles alone".into());
        }
        let corners: Vec<[[f32; 3]; 3]> = (0..triangles.len()).map(|row| triangles.corners(row)).collect();
        let start = Instant::now();
        let tree = F::build(&corners);
        let seconds = start.elapsed().as_secs_f64();
        let build = BuildReport::new(F::NAME, F::MODE, corners.len(), seconds, None);
        Ok((Self(tree), build))
    }
}

fn range(rays: &RayColumns<'_>, i: usize) -> [f32; 2] {
    [rays.t_min[i], rays.t_max[i]]
}

impl<F: Faces> Engine for FacesEngine<F> {
    fn name(&self) -> &'static str {
        F::NAME
    }
    fn mode(&self) -> String {
        F::MODE.into()
    }
    fn closest(&self, rays: RayColumns<'_>, hits: HitColumns<'_>) {
        for i in 0..rays.len() {
            let found = self.0.nearest(rays.ray(i), range(&rays, i));
            let (t, prim) =
                found.map_or((0.0, NO_HIT), |(t, row)| (t, PrimId::new(PrimKind::Triangle, row).0));
            (hits.t[i], hits.prim[i]) = (t, prim);
        }
    }
    fn any(&self, rays: RayColumns<'_>, occluded: &mut [bool]) {
        for (i, occluded) in occluded.iter_mut().enumerate() {
            *occluded = self.0.any(rays.ray(i), range(&rays, i));
        }
    }
}
