//! Where rays that go nearly the same way, or not far, enter the tree: below what all of them would go through alike.
//!
//! Plainly: each ray starts at the root. Departure: the nodes near the root are tested once against what is around all rays, a
//! pyramid or a box, and what that meets becomes a node of its own, made for these rays.
//!
//! **Source:** the entry points of Reshetov, Soupikov and Hurley, Multi-Level Ray Tracing Algorithm, 2005. Changed: up to eight
//! entries side by side.

use super::Accel;
use super::node::{ChildRef, Node8};
use crate::math::{Aabb, WIDTH};

/// Most nodes that are looked into.
const MOST: usize = 24;

/// Up to eight children of any nodes.
struct Children {
    list: [(Aabb, ChildRef); WIDTH],
    count: usize,
}

/// Where some rays enter the tree.
#[derive(Clone, Copy, Debug)]
pub(super) struct Entry {
    /// Over all that they may hit.
    pub(super) node: Node8,
    /// How many nodes it stands for.
    pub(super) spared: usize,
}

/// The entry to the tree below a root, given which children of a node rays may meet, as bits.
pub(super) fn enter(accel: &Accel, root: u32, meets: impl Fn(&Node8) -> u32) -> Entry {
    let mut children = Children { list: [(Aabb::EMPTY, ChildRef::node(root)); WIDTH], count: 1 };
    let (mut at, mut spared) = (0, 0);
    for _ in 0..MOST {
        if at == children.count {
            break;
        }
        let (_, child) = children.list[at];
        let replaced = child.is_node() && children.replace(at, &accel.nodes[child.index() as usize], &meets);
        spared += usize::from(replaced);
        at += usize::from(!replaced);
    }
    Entry { node: children.into_node(), spared }
}

impl Children {
    /// Puts what rays may meet of the children of a node in place of child `at`; false if there is no room.
    fn replace(&mut self, at: usize, node: &Node8, meets: &impl Fn(&Node8) -> u32) -> bool {
        let mut met = meets(node);
        if self.count - 1 + met.count_ones() as usize > WIDTH {
            return false;
        }
        self.count -= 1;
        self.list[at] = self.list[self.count];
        while met != 0 {
            let slot = met.trailing_zeros() as usize & 7;
            met &= met - 1;
            self.list[self.count] = (node.bounds(slot), node.child[slot]);
            self.count += 1;
        }
        true
    }

    fn into_node(self) -> Node8 {
        let mut node = Node8::EMPTY;
        for (slot, (bounds, child)) in self.list[..self.count].iter().enumerate() {
            node.set_bounds(slot, bounds);
            node.child[slot] = *child;
        }
        node
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::accel::region::Region;
    use crate::accel::tests::scenes::scattered_spheres;
    use crate::intersect::testing::dice::Dice;
    use crate::intersect::{Ray, RayLanes, Watertight};

    /// Leaves that a region reaches, in order of their numbers, and how many nodes it goes through.
    fn reached(accel: &Accel, from: Node8, region: &Region) -> (Vec<u32>, usize) {
        let (mut leaves, mut nodes) = (Vec::new(), vec![from]);
        let mut visited = 0;
        while let Some(node) = nodes.pop() {
            visited += 1;
            let met = region.children(&node);
            for child in (0..WIDTH).filter(|slot| met >> slot & 1 != 0).map(|slot| node.child[slot]) {
                match child.is_node() {
                    true => nodes.push(accel.nodes[child.index() as usize]),
                    false => leaves.push(child.bits()),
                }
            }
        }
        leaves.sort_unstable();
        (leaves, visited)
    }

    #[test]
    fn an_entry_leads_to_all_that_the_root_leads_to() {
        let dice = &mut Dice(3);
        let accel = Accel::build(&scattered_spheres(3_000, dice));
        let (mut spared, mut found) = (0, 0);
        for _ in 0..500 {
            let (start, far) = (dice.point(), dice.magnitude(-2.0, 0.3).abs());
            let ends = start.map(|x| x as f32 + (far * dice.between(-1.0, 1.0)) as f32);
            let direction = std::array::from_fn(|k| ends[k] - start[k] as f32);
            let ray = Ray { t_max: 1.0, ..Ray::new(start.map(|x| x as f32), direction) };
            let one = RayLanes::from(&ray);
            let region = Region::around::<Watertight>(&[RayLanes::gather(|_| &one)], accel.world);
            let region = region.expect("it ends");
            let entry = enter(&accel, accel.world.node, |node| region.children(node));
            let (leaves, from_root) = reached(&accel, accel.nodes[accel.world.node as usize], &region);
            let (entered, from_entry) = reached(&accel, entry.node, &region);
            assert_eq!(entered, leaves);
            // The entry is a node as well.
            assert_eq!(from_entry + entry.spared, from_root + 1);
            (spared, found) = (spared + entry.spared, found + leaves.len());
        }
        assert!(spared > 1_000 && found > 5_000, "{spared} {found}");
    }
}
