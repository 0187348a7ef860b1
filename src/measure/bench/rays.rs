//! Rays and answers as plain columns: what every engine is given, and what it fills.

use std::ops::Range;

use crate::accel::stream::Apex;
use crate::math::WIDTH;

/// What `prim` holds where a ray hit nothing.
pub const NO_HIT: u32 = u32::MAX;

/// Rays as columns.
///
/// **Shape:** all columns have the same length. Neighbours in the columns are neighbours in the picture.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RaySet {
    /// Where the rays start, by axis.
    pub origin: [Vec<f32>; 3],
    /// Where they go, by axis.
    pub direction: [Vec<f32>; 3],
    /// Hits at or before it do not count.
    pub t_min: Vec<f32>,
    /// Hits at or beyond it do not count.
    pub t_max: Vec<f32>,
    /// What all rays have in common, as whoever sends them knows.
    pub apex: Option<Apex>,
}

impl RaySet {
    /// Appends a ray.
    pub fn push(&mut self, origin: [f32; 3], direction: [f32; 3], [t_min, t_max]: [f32; 2]) {
        for k in 0..3 {
            self.origin[k].push(origin[k]);
            self.direction[k].push(direction[k]);
        }
        self.t_min.push(t_min);
        self.t_max.push(t_max);
    }
    /// Number of rays.
    pub fn len(&self) -> usize {
        self.t_max.len()
    }
    /// True if there are none.
    pub fn is_empty(&self) -> bool {
        self.t_max.is_empty()
    }
    /// All of them.
    pub fn columns(&self) -> RayColumns<'_> {
        RayColumns {
            origin: self.origin.each_ref().map(|c| &c[..]),
            direction: self.direction.each_ref().map(|c| &c[..]),
            t_min: &self.t_min,
            t_max: &self.t_max,
            apex: self.apex,
        }
    }
}

/// Some rays of a set.
#[derive(Clone, Copy, Debug)]
pub struct RayColumns<'a> {
    /// As in [`RaySet`].
    pub origin: [&'a [f32]; 3],
    /// As in [`RaySet`].
    pub direction: [&'a [f32]; 3],
    /// As in [`RaySet`].
    pub t_min: &'a [f32],
    /// As in [`RaySet`].
    pub t_max: &'a [f32],
    /// As in [`RaySet`].
    pub apex: Option<Apex>,
}

impl<'a> RayColumns<'a> {
    /// Number of rays.
    pub fn len(&self) -> usize {
        self.t_max.len()
    }
    /// True if there are none.
    pub fn is_empty(&self) -> bool {
        self.t_max.is_empty()
    }
    /// The rays of a range.
    pub fn slice(&self, range: Range<usize>) -> RayColumns<'a> {
        RayColumns {
            origin: self.origin.map(|c| &c[range.clone()]),
            direction: self.direction.map(|c| &c[range.clone()]),
            t_min: &self.t_min[range.clone()],
            t_max: &self.t_max[range],
            apex: self.apex,
        }
    }
    /// Origin and direction of a ray.
    pub fn ray(&self, i: usize) -> [[f32; 3]; 2] {
        [self.origin.map(|c| c[i]), self.direction.map(|c| c[i])]
    }
    /// Eight values of a column from `first` on; beyond its end the last one again.
    #[inline(always)]
    pub fn eight(column: &[f32], first: usize) -> [f32; WIDTH] {
        match column[first..].first_chunk() {
            Some(eight) => *eight,
            None => std::array::from_fn(|i| column[(first + i).min(column.len() - 1)]),
        }
    }
}

/// The nearest hit of each ray, as columns.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Hits {
    /// Distance; means nothing where nothing was hit.
    pub t: Vec<f32>,
    /// Number of a [`crate::PrimId`], or [`NO_HIT`].
    pub prim: Vec<u32>,
}

impl Hits {
    /// No hit for any of `len` rays.
    pub fn new(len: usize) -> Self {
        Self { t: vec![0.0; len], prim: vec![NO_HIT; len] }
    }
    /// How many rays hit something.
    pub fn count(&self) -> usize {
        self.prim.iter().filter(|&&prim| prim != NO_HIT).count()
    }
    /// All of them, to be filled.
    pub fn columns(&mut self) -> HitColumns<'_> {
        HitColumns { t: &mut self.t, prim: &mut self.prim }
    }
}

/// Some hits, to be filled.
#[derive(Debug)]
pub struct HitColumns<'a> {
    /// As in [`Hits`].
    pub t: &'a mut [f32],
    /// As in [`Hits`].
    pub prim: &'a mut [u32],
}

impl HitColumns<'_> {
    /// Writes up to eight hits from `first` on; what lies beyond the end is dropped.
    #[inline(always)]
    pub fn put_eight(&mut self, first: usize, t: [f32; WIDTH], prim: [u32; WIDTH]) {
        match (self.t[first..].first_chunk_mut(), self.prim[first..].first_chunk_mut()) {
            (Some(to_t), Some(to_prim)) => (*to_t, *to_prim) = (t, prim),
            _ => {
                let left = self.t.len() - first;
                self.t[first..].copy_from_slice(&t[..left]);
                self.prim[first..].copy_from_slice(&prim[..left]);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_packet_repeats_its_last_ray_and_drops_its_answers() {
        let column: Vec<f32> = (0..11).map(|i| i as f32).collect();
        assert_eq!(RayColumns::eight(&column, 0), [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0]);
        assert_eq!(RayColumns::eight(&column, 8), [8.0, 9.0, 10.0, 10.0, 10.0, 10.0, 10.0, 10.0]);
        let mut hits = Hits::new(11);
        hits.columns().put_eight(8, [1.0; 8], [7; 8]);
        assert_eq!(hits.count(), 3);
        hits.columns().put_eight(0, [1.0; 8], [7; 8]);
        assert_eq!(hits.count(), 11);
    }
}
