//! Rays, hits and primitive kernels.
