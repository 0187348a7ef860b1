//! Building and traversing the tree.
