//! Building and traversing the tree.

pub mod build;
pub mod node;
pub mod validate;
