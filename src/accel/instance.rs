//! Groups seen through instances: where they are, and rays on their way into their space.

use super::Accel;
use super::leaf::PreparedRays;
use super::node::ChildRef;
use super::query::Query;
use crate::geometry::{Geometry, Instance};
use crate::intersect::{RayLanes, Tier};
use crate::math::{Aabb, Lane, Transform, Vec3, WIDTH, gamma, three};

/// Roundoffs, in the space of an instance and of the largest coordinate there, by which a ray may pass a box that holds a
/// hit: the 36 of boxes of a tree, and a few for the rounding of the ray; the rest is slack.
const LOCAL_ROUNDOFFS: u32 = 64;

/// Boxes of instances allow for rays that start this many times as far out as any instance.
const REACH: f32 = 2.0;

/// Where a tree starts, and what roundoffs are relative to there.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct TreeRoot {
    pub(super) node: u32,
    /// The largest coordinate in the tree.
    pub(super) scale: f32,
    pub(super) way_in: WayIn,
}

/// What rounding does to rays on their way into the spaces of instances, beyond what boxes allow for.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct WayIn {
    /// How much larger roundoffs there may be than in the world, at most; 0 without instances.
    stretch: f32,
    /// The largest coordinate of an origin that boxes allow for.
    reach: f32,
}

impl TreeRoot {
    /// A tree without instances.
    pub(super) fn new(node: u32, bounds: &Aabb) -> Self {
        Self { node, scale: bounds.magnitude(), way_in: WayIn::default() }
    }

    /// What roundoffs are relative to for rays, beside the coordinates of their origin: more than the coordinates of the
    /// tree for rays that come from farther out than boxes of instances allow for.
    #[inline(always)]
    pub(super) fn scale_for<L: Lane>(self, origin: Vec3<L>) -> L {
        let scale = L::constant(f64::from(self.scale));
        let WayIn { stretch, reach } = self.way_in;
        if stretch == 0.0 {
            return scale;
        }
        let beyond = (origin.abs().max_component() - L::constant(f64::from(reach))).max(L::zero());
        scale + beyond * L::constant(f64::from(stretch))
    }
}

/// The tree of a group seen through an instance.
#[derive(Clone, Debug)]
pub(super) struct PlacedTree {
    /// Row of the instance.
    pub(super) row: u32,
    pub(super) tree: TreeRoot,
    pub(super) to_world: Transform,
}

impl PlacedTree {
    /// An instance, still to be placed.
    pub(super) fn new(row: u32) -> Self {
        Self { row, tree: TreeRoot::default(), to_world: Transform::IDENTITY }
    }
}

/// Boxes of all instances of a scene.
pub(super) struct Placement {
    pub(super) boxes: Vec<Aabb>,
    pub(super) way_in: WayIn,
}

impl Placement {
    /// The instances of a scene, given the boxes of its groups.
    ///
    /// A ray is rounded on its way into the space of an instance, relative to the largest coordinate there, whichever axis
    /// it is on. Back in the world that is more where the transform stretches: boxes are widened there, in the space of the
    /// instance, by roundoffs of its own largest coordinate and of the farthest origin as seen from there.
    pub(super) fn of(geometry: &Geometry, groups: &[Aabb]) -> Self {
        let bare = |i: &Instance| i.to_world.bounds(&groups[i.group]);
        let whole = geometry.instances.iter().fold(Aabb::EMPTY, |all, i| all.join(bare(i)));
        let reach = REACH * whole.magnitude();
        let around = |i: &Instance| {
            let local = groups[i.group];
            let origin = greatest_row_sum(i.to_world.inverse_rows(), f64::from(reach));
            let size = f64::from(local.magnitude()) + origin;
            let world = i.to_world.bounds(&local.padded((size * f64::from(gamma(LOCAL_ROUNDOFFS))) as f32));
            world.padded(world.magnitude() * gamma(LOCAL_ROUNDOFFS))
        };
        let stretch = |i: &Instance| {
            let linear = |rows: [[f64; 4]; 3]| greatest_row_sum(rows.map(|[x, y, z, _]| [x, y, z, 0.0]), 1.0);
            linear(i.to_world.rows()) * linear(i.to_world.inverse_rows())
        };
        let stretch = geometry.instances.iter().map(stretch).fold(0.0, f64::max) as f32;
        Self { boxes: geometry.instances.iter().map(around).collect(), way_in: WayIn { stretch, reach } }
    }
}

/// The largest coordinate that an affine map can give a point whose own are at most `size`.
fn greatest_row_sum(rows: [[f64; 4]; 3], size: f64) -> f64 {
    let sum = |[x, y, z, w]: [f64; 4]| (x.abs() + y.abs() + z.abs()) * size + w.abs();
    rows.map(sum).into_iter().fold(0.0, f64::max)
}

impl Accel {
    /// Rays in the space of an instance; `t` keeps its meaning, since directions keep their lengths' ratio.
    #[inline(always)]
    pub(crate) fn local_rays<L: Lane>(to_world: &Transform, ray: &RayLanes<L>) -> RayLanes<L> {
        Self::through(to_world.inverse_rows().map(|row| row.map(L::Double::splat)), ray)
    }

    /// Each ray in the space of an instance of its own.
    #[inline(always)]
    pub(super) fn local_to_each<L: Lane>(placed: &[&PlacedTree; WIDTH], ray: &RayLanes<L>) -> RayLanes<L> {
        let rows = placed.map(|placed| placed.to_world.inverse_rows());
        Self::through(three(|r| std::array::from_fn(|c| L::Double::from_fn(|i| rows[i][r][c]))), ray)
    }

    /// The images of rays, given the rows of the map.
    #[inline(always)]
    fn through<L: Lane>([r0, r1, r2]: [[L::Double; 4]; 3], ray: &RayLanes<L>) -> RayLanes<L> {
        let (o, d) = (ray.origin.widen(), ray.direction.widen());
        let linear = |[x, y, z, _]: [L::Double; 4], v: Vec3<L::Double>| x * v.x + y * v.y + z * v.z;
        let direction = Vec3 { x: linear(r0, d), y: linear(r1, d), z: linear(r2, d) };
        let origin = Vec3 { x: linear(r0, o) + r0[3], y: linear(r1, o) + r1[3], z: linear(r2, o) + r2[3] };
        RayLanes { origin: Vec3::narrow(origin), direction: Vec3::narrow(direction), ..*ray }
    }

    /// The instance of a leaf.
    pub(super) fn placed(&self, leaf: ChildRef) -> &PlacedTree {
        &self.instances[leaf.index() as usize]
    }

    /// Takes a query through the instance of a leaf, in the space of its group.
    #[inline(never)]
    pub(super) fn visit_instance<T: Tier, Q: Query<T::Wide>>(
        &self,
        leaf: ChildRef,
        ray: &RayLanes<T::Wide>,
        query: &mut Q,
        traverse: impl FnOnce(TreeRoot, &PreparedRays<T>, &mut Q),
    ) {
        let placed = self.placed(leaf);
        let local = Self::local_rays(&placed.to_world, ray);
        query.enter_instance(placed.row + 1);
        traverse(placed.tree, &PreparedRays::new(local, placed.tree), query);
        query.enter_instance(0);
    }
}
