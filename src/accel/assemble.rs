//! From the columns of a scene to its trees: one for the world, one for each group that an instance shows.

use std::ops::Range;

use super::block::{CylinderBlock, SphereBlock, TriangleBlock};
use super::build::{BLOCK_BYTES, BuildPrimitive, Cuttable, KINDS, MAX_DEPTH, Quality, Tree, tree_over};
use super::instance::{PlacedTree, Placement, TreeRoot};
use super::{Accel, BuiltGroup, unchecked};
use crate::geometry::{Geometry, Group, Instance, Triangles, row3};
use crate::intersect::PrimKind;
use crate::math::{Aabb, WIDTH};
use rayon::prelude::*;

// What the builder bounds memory by.
const _: () = assert!(size_of::<TriangleBlock>() == BLOCK_BYTES[PrimKind::Triangle as usize]);

/// A tree with what its primitive numbers mean.
struct GroupTree {
    tree: Tree,
    /// Kind and row of each primitive number.
    rows: Rows,
}

/// The triangles of a group, which come first in its numbering.
struct GroupTriangles<'a> {
    triangles: &'a Triangles,
    rows: Range<usize>,
}

impl Cuttable for GroupTriangles<'_> {
    #[inline]
    fn corners(&self, primitive: u32) -> Option<[[f32; 3]; 3]> {
        let n = primitive as usize;
        (n < self.rows.len()).then(|| self.triangles.corners(self.rows.start + n))
    }
    #[inline]
    fn is_cuttable(&self, primitive: u32) -> bool {
        (primitive as usize) < self.rows.len()
    }
}

/// Primitives of a group in one numbering: kinds one after the other.
struct Rows {
    triangles: Range<usize>,
    spheres: Range<usize>,
    cylinders: Range<usize>,
}

impl Rows {
    /// The row of a primitive number among the columns of its kind; for an instance its own number.
    fn row(&self, kind: u8, number: u32) -> u32 {
        let n = number as usize;
        let (triangles, spheres) = (self.triangles.len(), self.spheres.len());
        let row = match kind {
            k if k == PrimKind::Triangle as u8 => self.triangles.start + n,
            k if k == PrimKind::Sphere as u8 => self.spheres.start + n - triangles,
            k if k == PrimKind::Cylinder as u8 => self.cylinders.start + n - triangles - spheres,
            _ => n - triangles - spheres - self.cylinders.len(),
        };
        row as u32
    }
}

impl Accel {
    /// Builds the trees over all primitives of a scene.
    ///
    /// The result is the same for any number of threads. The current rayon pool is used.
    pub fn build(geometry: &Geometry) -> Self {
        Self::build_with(geometry, Quality::default())
    }

    /// [`Accel::build`] with more or less work. Hits are the same.
    pub fn build_with(geometry: &Geometry, quality: Quality) -> Self {
        let mut accel = Self::empty();
        let mut roots = vec![TreeRoot::default(); geometry.groups.len()];
        let mut bounds = vec![Aabb::EMPTY; geometry.groups.len()];
        for (i, group) in geometry.groups.iter().enumerate().skip(1) {
            let built = group_tree(geometry, group, &[], quality);
            bounds[i] = built.tree.bounds;
            roots[i] = accel.append(geometry, built);
        }
        let placed = Placement::of(geometry, &bounds);
        let world = geometry.groups.first().cloned().unwrap_or_default();
        let built = group_tree(geometry, &world, &placed.boxes, quality);
        accel.bounds = built.tree.bounds;
        accel.world = TreeRoot { way_in: placed.way_in, ..accel.append(geometry, built) };
        if let Some(root) = roots.first_mut() {
            *root = accel.world;
        }
        let group = |(root, rows): (TreeRoot, &Group)| BuiltGroup { root, rows: rows.clone() };
        accel.groups = roots.into_iter().zip(&geometry.groups).map(group).collect();
        accel.place(geometry);
        accel
    }

    /// Puts instances and planes where the geometry has them.
    pub(super) fn place(&mut self, geometry: &Geometry) {
        for placed in &mut self.instances {
            let Instance { group, to_world, .. } = geometry.instances[placed.row as usize];
            (placed.tree, placed.to_world) = (self.groups[group].root, to_world);
        }
        let p = &geometry.planes;
        self.planes = (0..p.len()).map(|i| [row3(&p.point, i), row3(&p.normal, i)]).collect();
    }

    fn empty() -> Self {
        Self {
            nodes: Vec::new(),
            triangles: Vec::new(),
            spheres: Vec::new(),
            cylinders: Vec::new(),
            instances: Vec::new(),
            planes: Vec::new(),
            groups: Vec::new(),
            world: TreeRoot::default(),
            bounds: Aabb::EMPTY,
            stack_bound: 0,
        }
    }

    /// Appends a tree and its packed leaves to the shared arrays.
    fn append(&mut self, geometry: &Geometry, GroupTree { mut tree, rows }: GroupTree) -> TreeRoot {
        let mut by = [0; KINDS];
        by[0] = self.nodes.len() as u32;
        by[PrimKind::Triangle as usize] = self.triangles.len() as u32;
        by[PrimKind::Sphere as usize] = self.spheres.len() as u32;
        by[PrimKind::Cylinder as usize] = self.cylinders.len() as u32;
        by[Self::INSTANCE as usize] = self.instances.len() as u32;
        tree.offset(&by);
        let root = TreeRoot::new(by[0], &tree.bounds);
        pack(&mut self.triangles, &tree, &rows, PrimKind::Triangle as u8, |r| {
            TriangleBlock::pack(geometry, r)
        });
        pack(&mut self.spheres, &tree, &rows, PrimKind::Sphere as u8, |r| SphereBlock::pack(geometry, r));
        pack(&mut self.cylinders, &tree, &rows, PrimKind::Cylinder as u8, |r| {
            CylinderBlock::pack(geometry, r)
        });
        let placed = tree.leaves_of(Self::INSTANCE).iter().flat_map(|leaf| tree.primitives(leaf));
        self.instances.extend(placed.map(|&number| PlacedTree::new(rows.row(Self::INSTANCE, number))));
        let entries = 7 * tree.max_depth.min(MAX_DEPTH) as usize + WIDTH;
        // A ray may be in the world's tree and in one group's at a time.
        self.stack_bound = self.stack_bound.max(2 * entries);
        if self.nodes.is_empty() {
            self.nodes = tree.nodes;
        } else {
            unchecked::reserve(&mut self.nodes, tree.nodes.len());
            self.nodes.append(&mut tree.nodes);
        }
        root
    }
}

/// Packs all leaves of a kind.
fn pack<B: Send>(to: &mut Vec<B>, tree: &Tree, rows: &Rows, kind: u8, block: impl Fn(&[u32]) -> B + Sync) {
    let pack = |leaf: &super::build::Leaf| {
        let mut row = [0; WIDTH];
        let numbers = tree.primitives(leaf);
        for (to, &number) in row.iter_mut().zip(numbers) {
            *to = rows.row(kind, number);
        }
        block(&row[..numbers.len()])
    };
    let leaves = tree.leaves_of(kind);
    unchecked::reserve(to, leaves.len());
    to.par_extend(leaves.par_iter().map(pack));
}

/// The tree over the rows of a group, and in the world over its instances too.
fn group_tree(geometry: &Geometry, group: &Group, instances: &[Aabb], quality: Quality) -> GroupTree {
    let Group { triangles, spheres, cylinders } = group.clone();
    let of = |bounds: Aabb, kind: PrimKind| BuildPrimitive { bounds, kind: kind as u8 };
    let rows = |rows: &Range<usize>| rows.clone().into_par_iter();
    let primitives = rows(&triangles).map(|row| of(geometry.triangles.bounds(row), PrimKind::Triangle));
    let primitives =
        primitives.chain(rows(&spheres).map(|row| of(geometry.spheres.bounds(row), PrimKind::Sphere)));
    let primitives =
        primitives.chain(rows(&cylinders).map(|row| of(geometry.cylinders.bounds(row), PrimKind::Cylinder)));
    let placed = |&bounds: &Aabb| BuildPrimitive { bounds, kind: Accel::INSTANCE };
    let cuttable = GroupTriangles { triangles: &geometry.triangles, rows: triangles.clone() };
    let tree = tree_over(primitives.chain(instances.par_iter().map(placed)), quality, &cuttable);
    GroupTree { tree, rows: Rows { triangles, spheres, cylinders } }
}
