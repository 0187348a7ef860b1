//! What can be wrong with a tree, and where.

/// A slot of a node.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place {
    /// Number of the node.
    pub node: u32,
    /// Slot from 0 to 7.
    pub slot: usize,
}

impl std::fmt::Display for Place {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        write!(f, "slot {} of node {}", self.slot, self.node)
    }
}

/// What is wrong with a tree.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum TreeFault {
    /// There is no root.
    #[error("there is no root node")]
    NoRoot,
    /// The bounds of the tree are not the box of its primitives.
    #[error("the bounds of the tree are not those of its primitives")]
    Bounds,
    /// A reference leads outside the arrays.
    #[error("{0} refers to something that is not there")]
    OutOfRange(Place),
    /// A node or leaf is reached twice: a cycle, or two parents.
    #[error("{0} leads to what was reached before")]
    ReachedTwice(Place),
    /// A ray could hit a free slot.
    #[error("{0} is free, but its box is not the box of nothing")]
    FreeSlotHasBox(Place),
    /// A box does not hold a box below it, or sticks out of the one above.
    #[error("the box of {0} does not hold what is below, or sticks out of the box above")]
    Box(Place),
    /// A leaf has no or too many primitives, or they are of another kind, or not ascending.
    #[error("the leaf in {0} is malformed")]
    Leaf(Place),
    /// Nothing leads to some nodes or leaves.
    #[error("{0} nodes or leaves are not reached from the root")]
    Unreached(usize),
    /// A primitive is in no leaf, or in several although it cannot be cut.
    #[error("primitive {primitive} is in {leaves} leaves")]
    Held {
        /// Its number.
        primitive: usize,
        /// Leaves that hold it.
        leaves: u32,
    },
    /// A triangle was cut, and the boxes of the leaves that hold it leave a gap.
    #[error("the leaves that hold triangle {primitive} do not cover it")]
    Gap {
        /// Its number.
        primitive: usize,
    },
    /// The depth is not as reported, or above [`super::MAX_DEPTH`].
    #[error("the depth is {found}, reported as {reported}")]
    Depth {
        /// As counted.
        found: u32,
        /// As the tree says.
        reported: u32,
    },
}
