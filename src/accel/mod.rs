//! Building and traversing the tree.

mod assemble;
pub mod block;
pub mod brute;
pub mod build;
mod cover;
mod descend;
mod entry;
mod instance;
mod leaf;
pub mod node;
mod order;
mod packet;
mod pending;
pub mod query;
mod ray_scene;
mod refit;
mod region;
mod single;
pub mod stream;
#[cfg(test)]
mod tests;
mod traversal;
mod unchecked;
pub mod validate;
pub mod visits;

use block::{Block, CylinderBlock, SphereBlock, TriangleBlock};
use node::Node8;

use crate::geometry::Group;
use crate::math::Aabb;
use instance::{PlacedTree, TreeRoot};

pub use build::Quality;
pub(crate) use ray_scene::lanes;
pub use ray_scene::{Primitive, RayScene, RaySceneBuilder, RaySceneError};
pub use refit::RefitError;
pub use traversal::{Hint, Traversal};

/// Trees of all groups of a scene, and their leaves, packed.
#[derive(Clone, Debug)]
pub struct Accel {
    nodes: Vec<Node8>,
    triangles: Vec<TriangleBlock>,
    spheres: Vec<SphereBlock>,
    cylinders: Vec<CylinderBlock>,
    /// In the order of their leaves.
    instances: Vec<PlacedTree>,
    planes: Vec<[[f32; 3]; 2]>,
    groups: Vec<BuiltGroup>,
    world: TreeRoot,
    bounds: Aabb,
    stack_bound: usize,
}

/// A group as it was built.
#[derive(Clone, Debug)]
struct BuiltGroup {
    root: TreeRoot,
    rows: Group,
}

impl Accel {
    /// Kind number of leaves that hold instances.
    const INSTANCE: u8 = build::SOLITARY;

    /// Box of everything but planes, which have none.
    pub fn bounds(&self) -> Aabb {
        self.bounds
    }
    /// True if groups are seen through instances.
    fn has_instances(&self) -> bool {
        !self.instances.is_empty()
    }
    /// Nodes of all trees.
    pub fn node_count(&self) -> usize {
        self.nodes.len()
    }
    /// Leaves of all trees.
    pub fn leaf_count(&self) -> usize {
        self.triangles.len() + self.spheres.len() + self.cylinders.len() + self.instances.len()
    }
    /// Places in leaves that are taken: as many as primitives and instances, and more where triangles are cut.
    pub fn reference_count(&self) -> usize {
        fn held<B: Block>(blocks: &[B]) -> usize {
            blocks.iter().map(|block| block.count() as usize).sum()
        }
        held(&self.triangles) + held(&self.spheres) + held(&self.cylinders) + self.instances.len()
    }
    /// Name and bytes of each array.
    pub fn memory(&self) -> Vec<(String, u64)> {
        let sizes = [
            ("tree.nodes", size_of_val(&self.nodes[..])),
            ("tree.triangle_blocks", size_of_val(&self.triangles[..])),
            ("tree.sphere_blocks", size_of_val(&self.spheres[..])),
            ("tree.cylinder_blocks", size_of_val(&self.cylinders[..])),
            ("tree.instances", size_of_val(&self.instances[..])),
        ];
        sizes.map(|(name, size)| (name.to_owned(), size as u64)).to_vec()
    }
}
