//! The binary tree as it stands, to look at before it is turned into links.

use super::super::binary::BinaryNode;
use super::super::box8::Box8;
use super::Links;

/// The nodes, and the parent of each.
pub(super) struct Standing<'a> {
    nodes: &'a [BinaryNode],
    parents: Vec<u32>,
}

impl<'a> Standing<'a> {
    /// `None` if there are no nodes.
    pub(super) fn of(nodes: &'a [BinaryNode]) -> Option<Self> {
        let mut parents = vec![0; nodes.len()];
        for (at, node) in nodes.iter().enumerate().filter(|(_, node)| node.right != 0) {
            parents[at + 1] = at as u32;
            parents[at + node.right as usize] = at as u32;
        }
        (!nodes.is_empty()).then_some(Self { nodes, parents })
    }
}

impl Links for Standing<'_> {
    fn len(&self) -> usize {
        self.nodes.len()
    }
    #[inline(always)]
    fn bounds(&self, at: u32) -> Box8 {
        Box8::of(&self.nodes[at as usize].bounds)
    }
    #[inline(always)]
    fn children(&self, at: u32) -> Option<[u32; 2]> {
        let right = self.nodes[at as usize].right;
        (right != 0).then_some([at + 1, at + right])
    }
    #[inline(always)]
    fn parent(&self, at: u32) -> u32 {
        self.parents[at as usize]
    }
    #[inline(always)]
    fn sibling(&self, at: u32) -> u32 {
        let parent = self.parent(at);
        if at == parent + 1 { parent + self.nodes[parent as usize].right } else { parent + 1 }
    }
}
