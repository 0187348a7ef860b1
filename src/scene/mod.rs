//! The scene as compiled.
