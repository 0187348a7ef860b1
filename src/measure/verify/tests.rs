//! Bounds hold, and faults are found.
