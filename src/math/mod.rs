//! Numbers: lanes, vectors, boxes, transforms, rounding bounds.
