//! New boxes for primitives that moved: the tree keeps its shape, so nothing is sorted or split.

use rayon::prelude::*;

use super::Accel;
use super::block::{Block, CylinderBlock, SphereBlock, TriangleBlock};
use super::instance::{PlacedTree, Placement, TreeRoot};
use super::node::ChildRef;
use crate::geometry::Geometry;
use crate::intersect::{PrimId, PrimKind};
use crate::math::{Aabb, WIDTH};

/// Why a tree cannot take other places for its primitives.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "the tree was built over other {what}: refitting moves primitives, it neither adds, removes nor regroups them"
)]
pub struct RefitError {
    /// What is not the same.
    pub what: &'static str,
}

/// Boxes of the leaves of each kind; `None` for a leaf whose triangles stand where they stood, whose box may be smaller
/// than theirs because they are cut.
struct LeafBoxes {
    triangles: Vec<Option<Aabb>>,
    spheres: Vec<Aabb>,
    cylinders: Vec<Aabb>,
}

impl Accel {
    /// Moves the primitives and instances to where `geometry` has them; groups, rows and instances must be those that the
    /// tree was built over.
    ///
    /// Hits are those of a new tree. Rays visit more of this one, the more the order of things has changed. The current
    /// rayon pool is used.
    ///
    /// **Errors:** [`RefitError`]; the tree is as it was.
    pub fn refit(&mut self, geometry: &Geometry) -> Result<(), RefitError> {
        self.check_same_topology(geometry)?;
        let boxes = self.repack(geometry);
        let mut bounds = vec![Aabb::EMPTY; self.groups.len()];
        for (group, bounds) in bounds.iter_mut().enumerate().skip(1) {
            *bounds = self.refit_group(group, &boxes, &[]);
        }
        let placed = Placement::of(geometry, &bounds);
        if !self.groups.is_empty() {
            self.bounds = self.refit_group(0, &boxes, &placed.boxes);
            self.world = TreeRoot { way_in: placed.way_in, ..self.groups[0].root };
        }
        self.place(geometry);
        Ok(())
    }

    fn check_same_topology(&self, geometry: &Geometry) -> Result<(), RefitError> {
        let same = |same: bool, what| if same { Ok(()) } else { Err(RefitError { what }) };
        let rows = self.groups.iter().map(|group| &group.rows);
        same(rows.eq(&geometry.groups), "groups")?;
        same(self.instances.len() == geometry.instances.len(), "instances")?;
        let shows = |placed: &PlacedTree| {
            let group = geometry.instances[placed.row as usize].group;
            self.groups.get(group).is_some_and(|group| group.root.node == placed.tree.node)
        };
        same(self.instances.iter().all(shows), "instances")?;
        same(self.planes.len() == geometry.planes.len(), "planes")
    }

    /// Fills the blocks anew, and gives their boxes.
    fn repack(&mut self, geometry: &Geometry) -> LeafBoxes {
        let triangles = self.triangles.par_iter_mut().map(|block| {
            let (rows, len) = rows(block);
            let packed = TriangleBlock::pack(geometry, &rows[..len]);
            let stands = packed.stands_as(block);
            *block = packed;
            (!stands).then(|| around(&rows[..len], |row| geometry.triangles.bounds(row)))
        });
        let triangles = triangles.collect();
        let spheres = self.spheres.par_iter_mut().map(|block| {
            let (rows, len) = rows(block);
            *block = SphereBlock::pack(geometry, &rows[..len]);
            around(&rows[..len], |row| geometry.spheres.bounds(row))
        });
        let spheres = spheres.collect();
        let cylinders = self.cylinders.par_iter_mut().map(|block| {
            let (rows, len) = rows(block);
            *block = CylinderBlock::pack(geometry, &rows[..len]);
            around(&rows[..len], |row| geometry.cylinders.bounds(row))
        });
        LeafBoxes { triangles, spheres, cylinders: cylinders.collect() }
    }

    /// New boxes for the tree of a group, leaves first; gives the box of all.
    fn refit_group(&mut self, group: usize, boxes: &LeafBoxes, placed: &[Aabb]) -> Aabb {
        let start = self.groups[group].root.node as usize;
        let later = self.groups.iter().map(|group| group.root.node as usize).filter(|&node| node > start);
        let end = later.min().unwrap_or(self.nodes.len());
        let mut bounds = vec![Aabb::EMPTY; end - start];
        // Below comes after: a node's children have their boxes when its turn comes.
        for at in (start..end).rev() {
            for slot in 0..WIDTH {
                let child = self.nodes[at].child[slot];
                if child.is_empty() {
                    continue;
                }
                let own = if child.is_node() {
                    bounds[child.index() as usize - start]
                } else {
                    self.leaf_box(child, boxes, placed).unwrap_or(self.nodes[at].bounds(slot))
                };
                self.nodes[at].set_bounds(slot, &own);
                bounds[at - start] = bounds[at - start].join(own);
            }
        }
        let whole = bounds.first().copied().unwrap_or(Aabb::EMPTY);
        self.groups[group].root = TreeRoot::new(start as u32, &whole);
        whole
    }

    fn leaf_box(&self, leaf: ChildRef, boxes: &LeafBoxes, placed: &[Aabb]) -> Option<Aabb> {
        const TRIANGLE: u8 = PrimKind::Triangle as u8;
        const SPHERE: u8 = PrimKind::Sphere as u8;
        const CYLINDER: u8 = PrimKind::Cylinder as u8;
        let at = leaf.index() as usize;
        match leaf.kind() {
            TRIANGLE => boxes.triangles[at],
            SPHERE => Some(boxes.spheres[at]),
            CYLINDER => Some(boxes.cylinders[at]),
            _ => Some(placed[self.instances[at].row as usize]),
        }
    }
}

/// The rows of a block's primitives, and how many there are.
fn rows(block: &impl Block) -> ([u32; WIDTH], usize) {
    let len = block.count() as usize;
    let mut rows = [0; WIDTH];
    for (row, &id) in rows.iter_mut().zip(&block.ids()[..len]) {
        *row = PrimId(id).row() as u32;
    }
    (rows, len)
}

fn around(rows: &[u32], bounds: impl Fn(usize) -> Aabb) -> Aabb {
    rows.iter().fold(Aabb::EMPTY, |all, &row| all.join(bounds(row as usize)))
}
