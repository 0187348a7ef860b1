//! Accumulation in a fixed order and the tone curve.
