//! The binary tree as links, in which a subtree moves by changing a few.

use super::super::MAX_DEPTH;
use super::super::binary::{self, BinaryNode};
use super::super::box8::Box8;
use super::Links;

/// A node. Siblings stand side by side, the first at an odd place; the root is at 0.
#[derive(Clone, Copy)]
struct LinkedNode {
    bounds: Box8,
    /// The first child; 0 for a leaf.
    below: u32,
    /// Where a leaf is in the tree as it came.
    leaf: u32,
}

/// The tree.
pub(super) struct Linked {
    nodes: Vec<LinkedNode>,
    /// By pair of siblings.
    parents: Vec<u32>,
}

/// The other child of the parent of a node that is not the root.
fn sibling(at: u32) -> u32 {
    ((at - 1) ^ 1) + 1
}

fn pair(at: u32) -> usize {
    (at as usize - 1) / 2
}

impl Links for Linked {
    fn len(&self) -> usize {
        self.nodes.len()
    }
    #[inline(always)]
    fn bounds(&self, at: u32) -> Box8 {
        self.nodes[at as usize].bounds
    }
    #[inline(always)]
    fn children(&self, at: u32) -> Option<[u32; 2]> {
        let below = self.nodes[at as usize].below;
        (below != 0).then_some([below, below + 1])
    }
    #[inline(always)]
    fn parent(&self, at: u32) -> u32 {
        self.parents[pair(at)]
    }
    #[inline(always)]
    fn sibling(&self, at: u32) -> u32 {
        sibling(at)
    }
}

impl Linked {
    /// `None` if there are no nodes.
    pub(super) fn of(tree: &[BinaryNode]) -> Option<Self> {
        let node =
            |leaf: usize| LinkedNode { bounds: Box8::of(&tree[leaf].bounds), below: 0, leaf: leaf as u32 };
        let root = (!tree.is_empty()).then(|| node(0))?;
        let (mut nodes, mut parents) = (Vec::with_capacity(tree.len()), Vec::with_capacity(tree.len() / 2));
        nodes.push(root);
        let mut stack = vec![(0, 0)];
        while let Some((from, at)) = stack.pop() {
            let right = tree[from].right as usize;
            if right == 0 {
                continue;
            }
            let below: usize = nodes.len();
            nodes[at].below = below as u32;
            parents.push(at as u32);
            nodes.extend([node(from + 1), node(from + right)]);
            stack.extend([(from + right, below + 1), (from + 1, below)]);
        }
        Some(Self { nodes, parents })
    }

    /// True if a node is another or in the subtree below it.
    pub(super) fn is_below(&self, mut at: u32, above: u32) -> bool {
        while at != above && at != 0 {
            at = self.parent(at);
        }
        at == above
    }

    /// The nodes to which [`Linked::move_beside`] gives other links.
    pub(super) fn linked_by_moving(&self, from: u32, to: u32) -> [u32; 5] {
        [from, sibling(from), self.parent(from), to, self.parent(to)]
    }

    /// Puts a subtree beside a node: under a new parent of both, where the node was.
    ///
    /// **Needs:** neither is the root, and `to` is not in the subtree, nor its sibling, nor its parent.
    pub(super) fn move_beside(&mut self, from: u32, to: u32) {
        let (beside, parent) = (sibling(from), self.parent(from));
        // The sibling replaces the parent, which leaves its own place, next to the subtree, for the node.
        self.put(parent, self.nodes[beside as usize]);
        self.put(beside, self.nodes[to as usize]);
        self.nodes[to as usize].below = from.min(beside);
        self.parents[pair(from)] = to;
        self.fit(to);
        if parent != 0 {
            self.fit(self.parent(parent));
        }
    }

    fn put(&mut self, at: u32, node: LinkedNode) {
        self.nodes[at as usize] = node;
        if node.below != 0 {
            self.parents[pair(node.below)] = at;
        }
    }

    /// Fits the boxes from a node that is no leaf up to the root.
    fn fit(&mut self, mut at: u32) {
        loop {
            let below = self.nodes[at as usize].below;
            self.nodes[at as usize].bounds = self.bounds(below).join(self.bounds(below + 1));
            if at == 0 {
                return;
            }
            at = self.parent(at);
        }
    }

    /// Nodes and what leaves hold in depth-first order, given those from which the tree came; `None` if it became too deep.
    pub(super) fn laid_out<T: Copy>(
        &self,
        tree: &[BinaryNode],
        items: &[T],
    ) -> Option<(Vec<BinaryNode>, Vec<T>)> {
        let (mut nodes, mut order) = (Vec::with_capacity(tree.len()), Vec::with_capacity(items.len()));
        // Nodes with the splits above them, and right children with where the parent went.
        let mut stack = vec![(0, 0, None)];
        while let Some((at, depth, parent)) = stack.pop() {
            let here = nodes.len();
            if let Some(parent) = parent {
                let parent: &mut BinaryNode = &mut nodes[parent];
                parent.right = (here - parent.right as usize) as u32;
            }
            let node = self.nodes[at as usize];
            let Some([left, right]) = self.children(at) else {
                let came = tree[node.leaf as usize];
                nodes.push(came);
                order.extend_from_slice(&items[came.first as usize..][..came.len as usize]);
                continue;
            };
            if depth == MAX_DEPTH {
                return None;
            }
            nodes.push(BinaryNode { bounds: node.bounds.to_aabb(), right: here as u32, first: 0, len: 0 });
            stack.extend([(right, depth + 1, Some(here)), (left, depth + 1, None)]);
        }
        binary::number(&mut nodes);
        Some((nodes, order))
    }
}
