//! Embree 4's structures and numbers, as its C interface lays them out.

use std::ffi::{c_int, c_uint, c_void};

/// A device, scene or geometry of Embree.
pub(super) type Handle = *mut c_void;

/// `geomID` of a ray that hit nothing.
pub(super) const NO_GEOMETRY: c_uint = c_uint::MAX;

/// Scene flag: no ray is lost between triangles.
pub(super) const ROBUST: c_int = 1 << 2;
/// Query flag: neighbouring rays go nearly the same way.
pub(super) const COHERENT: c_int = 1 << 16;

pub(super) const TRIANGLE: c_int = 0;
/// Line segments with a radius at each end, closed by disks.
pub(super) const CONE_LINEAR_CURVE: c_int = 15;
pub(super) const SPHERE_POINT: c_int = 50;
/// A scene seen through a transform.
pub(super) const INSTANCE: c_int = 121;

pub(super) const INDEX_BUFFER: c_int = 0;
pub(super) const VERTEX_BUFFER: c_int = 1;

pub(super) const UINT: c_int = 0x5001;
pub(super) const UINT3: c_int = 0x5003;
pub(super) const FLOAT3: c_int = 0x9003;
pub(super) const FLOAT4: c_int = 0x9004;
/// Three rows of four numbers.
pub(super) const ROWS_3X4: c_int = 0x9134;

/// One ray.
#[repr(C, align(16))]
#[derive(Clone, Copy, Default)]
pub(super) struct Ray {
    pub(super) origin: [f32; 3],
    pub(super) t_near: f32,
    pub(super) direction: [f32; 3],
    pub(super) time: f32,
    pub(super) t_far: f32,
    pub(super) mask: c_uint,
    pub(super) id: c_uint,
    pub(super) flags: c_uint,
}

/// What one ray hit. The last word is there since 4.3 and harmless before.
#[repr(C, align(16))]
#[derive(Clone, Copy, Default)]
pub(super) struct Hit {
    pub(super) normal: [f32; 3],
    pub(super) uv: [f32; 2],
    pub(super) prim: c_uint,
    pub(super) geometry: c_uint,
    pub(super) instance: c_uint,
    pub(super) instance_prim: c_uint,
}

/// One ray and its hit.
#[repr(C, align(16))]
#[derive(Clone, Copy, Default)]
pub(super) struct RayHit {
    pub(super) ray: Ray,
    pub(super) hit: Hit,
}

/// Eight rays.
#[repr(C, align(32))]
#[derive(Clone, Copy, Default)]
pub(super) struct Ray8 {
    pub(super) origin: [[f32; 8]; 3],
    pub(super) t_near: [f32; 8],
    pub(super) direction: [[f32; 8]; 3],
    pub(super) time: [f32; 8],
    pub(super) t_far: [f32; 8],
    pub(super) mask: [c_uint; 8],
    pub(super) id: [c_uint; 8],
    pub(super) flags: [c_uint; 8],
}

/// What eight rays hit.
#[repr(C, align(32))]
#[derive(Clone, Copy, Default)]
pub(super) struct Hit8 {
    pub(super) normal: [[f32; 8]; 3],
    pub(super) uv: [[f32; 8]; 2],
    pub(super) prim: [c_uint; 8],
    pub(super) geometry: [c_uint; 8],
    pub(super) instance: [c_uint; 8],
    pub(super) instance_prim: [c_uint; 8],
}

/// Eight rays and their hits.
#[repr(C, align(32))]
#[derive(Clone, Copy, Default)]
pub(super) struct RayHit8 {
    pub(super) ray: Ray8,
    pub(super) hit: Hit8,
}

/// Which of eight rays are asked: -1 yes, 0 no.
#[repr(C, align(32))]
#[derive(Clone, Copy)]
pub(super) struct Valid8(pub(super) [c_int; 8]);

/// What a query is told besides rays. The last word is there only in builds with minimal widths.
#[repr(C)]
pub(super) struct QueryArguments {
    pub(super) flags: c_int,
    pub(super) features: c_uint,
    pub(super) context: *mut c_void,
    pub(super) filter: *mut c_void,
    pub(super) callback: *mut c_void,
    pub(super) min_width: f32,
}

impl QueryArguments {
    /// With these flags, all features and no callbacks.
    pub(super) fn new(flags: c_int) -> Self {
        let none = std::ptr::null_mut();
        Self { flags, features: c_uint::MAX, context: none, filter: none, callback: none, min_width: 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::mem::offset_of;

    #[test]
    fn structures_are_laid_out_as_in_c() {
        assert_eq!((size_of::<Ray>(), offset_of!(RayHit, hit), size_of::<RayHit>()), (48, 48, 96));
        assert_eq!((offset_of!(Hit, prim), offset_of!(Hit, geometry)), (20, 24));
        assert_eq!((size_of::<Ray8>(), offset_of!(RayHit8, hit), align_of::<RayHit8>()), (384, 384, 32));
        assert_eq!((offset_of!(Ray8, t_far), offset_of!(Hit8, geometry)), (8 * 32, 6 * 32));
        assert_eq!((offset_of!(QueryArguments, context), offset_of!(QueryArguments, callback)), (8, 24));
    }
}
