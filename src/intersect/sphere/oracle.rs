//! The plain version.
