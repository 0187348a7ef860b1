//! Building and traversing the tree.

mod assemble;
pub mod block;
pub mod brute;
pub mod build;
mod cover;
mod descend;
mod leaf;
pub mod node;
mod order;
mod packet;
pub mod query;
mod ray_scene;
mod refit;
mod single;
pub mod stream;
#[cfg(test)]
mod tests;
mod traversal;
mod unchecked;
pub mod validate;
pub mod visits;

use block::{Block, CylinderBlock, InstanceBlock, SphereBlock, TriangleBlock};
use node::{ChildRef, Node8};

use crate::geometry::Group;
use crate::intersect::{PrimKind, RayLanes, Tier};
use crate::math::{Aabb, Lane, Transform, Vec3};
use leaf::PreparedRays;
use query::Query;

pub use build::Quality;
pub(crate) use ray_scene::lanes;
pub use ray_scene::{Primitive, RayScene, RaySceneBuilder, RaySceneError};
pub use refit::RefitError;
pub use traversal::{Hint, Traversal};

/// Trees of all groups of a scene, and their leaves, packed.
#[derive(Debug)]
pub struct Accel {
    nodes: Vec<Node8>,
    triangles: Vec<TriangleBlock>,
    spheres: Vec<SphereBlock>,
    cylinders: Vec<CylinderBlock>,
    instance_blocks: Vec<InstanceBlock>,
    instances: Vec<PlacedTree>,
    planes: Vec<[[f32; 3]; 2]>,
    groups: Vec<BuiltGroup>,
    world: TreeRoot,
    bounds: Aabb,
    stack_bound: usize,
}

/// Where the tree of a group starts, and the largest coordinate in it.
#[derive(Clone, Copy, Debug, Default)]
struct TreeRoot {
    node: u32,
    scale: f32,
}

/// A group as it was built.
#[derive(Clone, Debug)]
struct BuiltGroup {
    root: TreeRoot,
    rows: Group,
}

/// The tree of a group seen through an instance.
#[derive(Clone, Debug)]
struct PlacedTree {
    tree: TreeRoot,
    to_world: Transform,
}

impl Accel {
    /// Kind number of leaves that hold instances.
    const INSTANCE: u8 = 4;

    /// Box of everything but planes, which have none.
    pub fn bounds(&self) -> Aabb {
        self.bounds
    }
    /// Nodes of all trees.
    pub fn node_count(&self) -> usize {
        self.nodes.len()
    }
    /// Leaves of all trees.
    pub fn leaf_count(&self) -> usize {
        self.triangles.len() + self.spheres.len() + self.cylinders.len() + self.instance_blocks.len()
    }
    /// Places in leaves that are taken: as many as primitives and instances, and more where triangles are cut.
    pub fn reference_count(&self) -> usize {
        fn held<B: Block>(blocks: &[B]) -> usize {
            blocks.iter().map(|block| block.count() as usize).sum()
        }
        let instances = self.instance_blocks.iter().map(|block| block.len as usize).sum::<usize>();
        held(&self.triangles) + held(&self.spheres) + held(&self.cylinders) + instances
    }
    /// Name and bytes of each array.
    pub fn memory(&self) -> Vec<(String, u64)> {
        let sizes = [
            ("tree.nodes", size_of_val(&self.nodes[..])),
            ("tree.triangle_blocks", size_of_val(&self.triangles[..])),
            ("tree.sphere_blocks", size_of_val(&self.spheres[..])),
            ("tree.cylinder_blocks", size_of_val(&self.cylinders[..])),
            ("tree.instances", size_of_val(&self.instance_blocks[..]) + size_of_val(&self.instances[..])),
        ];
        sizes.map(|(name, size)| (name.to_owned(), size as u64)).to_vec()
    }

    /// All nodes, and the root of the world's tree among them, for walks that count.
    pub(crate) fn nodes(&self) -> (&[Node8], ChildRef) {
        (&self.nodes, ChildRef::node(self.world.node))
    }
    /// Largest coordinate of the world's tree.
    pub(crate) fn scale(&self) -> f32 {
        self.world.scale
    }
    /// Ids of the primitives in a leaf; none in a leaf of instances.
    pub(crate) fn leaf_ids(&self, leaf: ChildRef) -> &[u32] {
        fn counted(block: &impl Block) -> &[u32] {
            &block.ids()[..block.count() as usize]
        }
        let i = leaf.index() as usize;
        match leaf.kind() {
            k if k == PrimKind::Triangle as u8 => counted(&self.triangles[i]),
            k if k == PrimKind::Sphere as u8 => counted(&self.spheres[i]),
            k if k == PrimKind::Cylinder as u8 => counted(&self.cylinders[i]),
            _ => &[],
        }
    }

    /// Rays in the space of an instance; `t` keeps its meaning, since directions keep their lengths' ratio.
    #[inline(always)]
    fn local_rays<L: Lane>(to_world: &Transform, ray: &RayLanes<L>) -> RayLanes<L> {
        let rows = to_world.inverse_rows().map(|r| r.map(L::Double::splat));
        let (o, d) = (ray.origin.widen(), ray.direction.widen());
        let linear = |[x, y, z, _]: [L::Double; 4], v: Vec3<L::Double>| x * v.x + y * v.y + z * v.z;
        let [r0, r1, r2] = rows;
        let direction = Vec3 { x: linear(r0, d), y: linear(r1, d), z: linear(r2, d) };
        let origin = Vec3 { x: linear(r0, o) + r0[3], y: linear(r1, o) + r1[3], z: linear(r2, o) + r2[3] };
        RayLanes { origin: Vec3::narrow(origin), direction: Vec3::narrow(direction), ..*ray }
    }

    /// Takes a query through each instance of a leaf, in the space of its group.
    #[inline(never)]
    fn visit_instances<T: Tier, Q: Query<T::Wide>>(
        &self,
        leaf: ChildRef,
        ray: &RayLanes<T::Wide>,
        query: &mut Q,
        mut traverse: impl FnMut(u32, &PreparedRays<T>, &mut Q),
    ) {
        let block = &self.instance_blocks[leaf.index() as usize];
        for &row in &block.rows[..block.len as usize] {
            let placed = &self.instances[row as usize];
            let local = Self::local_rays(&placed.to_world, ray);
            query.enter_instance(row + 1);
            traverse(placed.tree.node, &PreparedRays::new(local, placed.tree.scale), query);
        }
        query.enter_instance(0);
    }
}
