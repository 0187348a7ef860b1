//! Which object of the scene file each primitive belongs to.

use crate::intersect::PrimKind;

/// Where the rows of each object of the world begin, one entry an object; rows of groups are known by their instance.
#[derive(Clone, Debug, Default)]
pub struct ObjectRows {
    /// First row and number, ascending; by [`PrimKind`] number less one.
    starts: [Vec<(u32, u32)>; 4],
    wanted: bool,
}

impl ObjectRows {
    /// An empty table, which stays empty unless it is wanted.
    pub(super) fn wanted(wanted: bool) -> Self {
        Self { wanted, ..Self::default() }
    }

    /// Notes that the rows of a kind from `row` on are those of object `number`.
    pub(super) fn begin(&mut self, kind: PrimKind, row: usize, number: u32) {
        if self.wanted {
            self.starts[kind as usize - 1].push((row as u32, number));
        }
    }

    /// The number of the object that a row of the world belongs to; 0 if nobody wanted to know.
    pub fn object(&self, kind: PrimKind, row: u32) -> u32 {
        let starts = &self.starts[kind as usize - 1];
        let after = starts.partition_point(|&(first, _)| first <= row);
        after.checked_sub(1).map_or(0, |at| starts[at].1)
    }
}

/// The number of the first object of each kind: kinds follow each other.
#[derive(Clone, Copy, Debug)]
pub(super) struct FirstNumbers {
    pub(super) sphere: u32,
    pub(super) cylinder: u32,
    pub(super) triangle: u32,
    pub(super) quad: u32,
    pub(super) plane: u32,
    pub(super) mesh: u32,
    pub(super) instance: u32,
}

impl FirstNumbers {
    /// For these objects and so many planes.
    pub(super) fn of(objects: &crate::describe::Objects<'_>, planes: usize) -> Self {
        let sphere = 1;
        let cylinder = sphere + objects.spheres.len() as u32;
        let triangle = cylinder + objects.cylinders.len() as u32;
        let quad = triangle + objects.triangles.len() as u32;
        let plane = quad + objects.quads.len() as u32;
        let mesh = plane + planes as u32;
        let instance = mesh + objects.meshes.len() as u32;
        Self { sphere, cylinder, triangle, quad, plane, mesh, instance }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_belong_to_the_object_that_began_last() {
        let mut rows = ObjectRows::wanted(true);
        for (row, number) in [(0, 3), (12, 4), (12, 5), (14, 6)] {
            rows.begin(PrimKind::Triangle, row, number);
        }
        let found = [0, 11, 12, 13, 14, 99].map(|row| rows.object(PrimKind::Triangle, row));
        assert_eq!(found, [3, 3, 5, 5, 6, 6]);
        assert_eq!(rows.object(PrimKind::Sphere, 0), 0);
    }
}
