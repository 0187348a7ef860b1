//! The scene exactly as the user wrote it.
