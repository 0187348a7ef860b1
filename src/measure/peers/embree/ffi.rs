//! Embree's C functions behind safe ones: the only file of this room with unsafe code.
//!
//! What the safe functions rely on: the library is Embree 4 (it says so before anything else is asked), a scene is committed
//! before it is asked and never changed after, and buffers are filled before their geometry is committed.

#![allow(unsafe_code)]

use std::ffi::{CString, c_char, c_int, c_uint, c_void};
use std::path::Path;
use std::sync::atomic::{AtomicIsize, Ordering};

use libloading::os::unix::{Library, RTLD_GLOBAL, RTLD_NOW};

use super::layout::{Handle, INSTANCE, QueryArguments, ROWS_3X4, Ray, Ray8, RayHit, RayHit8, Valid8};

/// Number of the device property that holds the major version.
const VERSION_MAJOR: c_int = 1;

/// Told of every allocation before, and of every release after: false would refuse it.
type MemoryMonitor = extern "C" fn(*mut c_void, isize, bool) -> bool;

/// Adds what Embree takes or gives back to the counter at `bytes`.
extern "C" fn count_bytes(bytes: *mut c_void, taken: isize, _: bool) -> bool {
    // SAFETY: the pointer is that of the counter that `Embree::device` made, which lives until the process ends.
    unsafe { &*bytes.cast::<AtomicIsize>() }.fetch_add(taken, Ordering::Relaxed);
    true
}

macro_rules! functions {
    ($($field:ident = $name:literal: fn($($argument:ty),*) $(-> $result:ty)?;)*) => {
        /// The functions that are used.
        struct Functions {
            $($field: unsafe extern "C" fn($($argument),*) $(-> $result)?,)*
        }
        impl Functions {
            fn of(embree: &'static Library) -> Result<Self, libloading::Error> {
                // SAFETY: the types are those of Embree 4's public headers.
                unsafe {
                    Ok(Self { $($field: *embree.get($name)?,)* })
                }
            }
        }
    };
}

functions! {
    new_device = b"rtcNewDevice\0": fn(*const c_char) -> Handle;
    release_device = b"rtcReleaseDevice\0": fn(Handle);
    device_property = b"rtcGetDeviceProperty\0": fn(Handle, c_int) -> isize;
    set_memory_monitor = b"rtcSetDeviceMemoryMonitorFunction\0": fn(Handle, MemoryMonitor, *mut c_void);
    device_error = b"rtcGetDeviceError\0": fn(Handle) -> c_int;
    new_scene = b"rtcNewScene\0": fn(Handle) -> Handle;
    set_scene_flags = b"rtcSetSceneFlags\0": fn(Handle, c_int);
    set_scene_quality = b"rtcSetSceneBuildQuality\0": fn(Handle, c_int);
    commit_scene = b"rtcCommitScene\0": fn(Handle);
    release_scene = b"rtcReleaseScene\0": fn(Handle);
    new_geometry = b"rtcNewGeometry\0": fn(Handle, c_int) -> Handle;
    set_geometry_quality = b"rtcSetGeometryBuildQuality\0": fn(Handle, c_int);
    new_buffer = b"rtcSetNewGeometryBuffer\0": fn(Handle, c_int, c_uint, c_int, usize, usize) -> *mut c_void;
    set_instanced_scene = b"rtcSetGeometryInstancedScene\0": fn(Handle, Handle);
    set_transform = b"rtcSetGeometryTransform\0": fn(Handle, c_uint, c_int, *const c_void);
    commit_geometry = b"rtcCommitGeometry\0": fn(Handle);
    attach_geometry = b"rtcAttachGeometry\0": fn(Handle, Handle) -> c_uint;
    release_geometry = b"rtcReleaseGeometry\0": fn(Handle);
    intersect1 = b"rtcIntersect1\0": fn(Handle, *mut RayHit, *mut QueryArguments);
    intersect8 = b"rtcIntersect8\0": fn(*const c_int, Handle, *mut RayHit8, *mut QueryArguments);
    occluded1 = b"rtcOccluded1\0": fn(Handle, *mut Ray, *mut QueryArguments);
    occluded8 = b"rtcOccluded8\0": fn(*const c_int, Handle, *mut Ray8, *mut QueryArguments);
}

/// A loaded Embree.
#[derive(Clone, Copy)]
pub(super) struct Embree(&'static Functions);

impl Embree {
    /// Loads libraries, each visible to the next; Embree comes last. **Errors:** in words.
    pub(super) fn load(libraries: &[&Path]) -> Result<Self, String> {
        let open = |path: &&Path| {
            // SAFETY: the initialisers of Embree and its TBB have no preconditions; the user chose these files.
            unsafe { Library::open(Some(*path), RTLD_NOW | RTLD_GLOBAL) }
                .map_err(|error| format!("{}: {error}", path.display()))
        };
        let loaded: Result<Vec<Library>, String> = libraries.iter().map(open).collect();
        // Never unloaded: threads of TBB may run its code until the process ends.
        let embree = loaded?.leak().last().ok_or("no library")?;
        let functions = Functions::of(embree).map_err(|error| format!("not Embree 4: {error}"))?;
        let embree = Self(Box::leak(Box::new(functions)));
        let device = embree.device(1)?;
        // SAFETY: the device is alive.
        match unsafe { (embree.0.device_property)(device.handle, VERSION_MAJOR) } {
            4 => Ok(embree),
            other => Err(format!("Embree {other} instead of 4")),
        }
    }

    /// A device that builds with so many threads.
    pub(super) fn device(&self, threads: usize) -> Result<Device, String> {
        let config = CString::new(format!("threads={threads}")).map_err(|error| error.to_string())?;
        // SAFETY: the text ends with a zero and outlives the call.
        let handle = unsafe { (self.0.new_device)(config.as_ptr()) };
        if handle.is_null() {
            return Err("Embree makes no device".into());
        }
        // Scenes outlive their device and release their memory last, so the counter must outlive all of them.
        let bytes: &'static AtomicIsize = Box::leak(Box::default());
        let counter = std::ptr::from_ref(bytes).cast_mut().cast();
        // SAFETY: the device is alive; the counter is shared and only ever changed atomically.
        unsafe { (self.0.set_memory_monitor)(handle, count_bytes, counter) };
        Ok(Device { embree: *self, handle, bytes })
    }
}

/// Where scenes live.
pub(super) struct Device {
    embree: Embree,
    handle: Handle,
    bytes: &'static AtomicIsize,
}

impl Drop for Device {
    fn drop(&mut self) {
        // SAFETY: made by `device` and released once; scenes hold references of their own.
        unsafe { (self.embree.0.release_device)(self.handle) }
    }
}

impl Device {
    /// An empty scene.
    pub(super) fn scene(&self, flags: c_int, quality: c_int) -> SceneBuilder<'_> {
        let f = self.embree.0;
        // SAFETY: the device is alive, flags and quality are numbers of the interface.
        let handle = unsafe {
            let handle = (f.new_scene)(self.handle);
            (f.set_scene_flags)(handle, flags);
            (f.set_scene_quality)(handle, quality);
            handle
        };
        SceneBuilder { device: self, quality, scene: Scene { embree: self.embree, handle } }
    }
}

/// A scene that is being filled.
pub(super) struct SceneBuilder<'a> {
    device: &'a Device,
    quality: c_int,
    scene: Scene,
}

/// A buffer of a geometry: rows of `N` numbers of four bytes.
pub(super) struct Buffer<'a, T, const N: usize> {
    /// Indices or vertices.
    pub(super) kind: c_int,
    /// Format of a row.
    pub(super) format: c_int,
    /// The rows.
    pub(super) rows: &'a [[T; N]],
}

/// A number that buffers hold.
pub(super) trait Word: Copy {}
impl Word for u32 {}
impl Word for f32 {}

impl SceneBuilder<'_> {
    /// Adds a geometry with vertices and, where it has any, indices. Geometries have numbers in the order of adding.
    pub(super) fn add<const V: usize, const I: usize>(
        &mut self,
        kind: c_int,
        vertices: &Buffer<'_, f32, V>,
        indices: Option<&Buffer<'_, u32, I>>,
    ) -> Result<(), String> {
        let geometry = self.geometry(kind)?;
        self.fill(geometry, vertices)?;
        indices.map_or(Ok(()), |indices| self.fill(geometry, indices))?;
        self.attach(geometry);
        Ok(())
    }

    /// Adds a committed scene of the same device, seen through the rows of an affine map.
    pub(super) fn add_instance(&mut self, of: &Scene, to_world: &[[f32; 4]; 3]) -> Result<(), String> {
        let geometry = self.geometry(INSTANCE)?;
        let f = self.scene.embree.0;
        // SAFETY: geometry and scene are alive, and the geometry keeps a reference to the scene; the twelve numbers are
        // read during the call.
        unsafe {
            (f.set_instanced_scene)(geometry, of.handle);
            (f.set_transform)(geometry, 0, ROWS_3X4, to_world.as_ptr().cast());
        }
        self.attach(geometry);
        Ok(())
    }

    fn geometry(&self, kind: c_int) -> Result<Handle, String> {
        // SAFETY: the device is alive.
        let geometry = unsafe { (self.scene.embree.0.new_geometry)(self.device.handle, kind) };
        if geometry.is_null() {
            Err(format!("this Embree has no geometry of kind {kind}"))
        } else {
            Ok(geometry)
        }
    }

    /// Hands a filled geometry over to the scene.
    fn attach(&mut self, geometry: Handle) {
        let f = self.scene.embree.0;
        // SAFETY: geometry and scene are alive; the scene keeps a reference to the geometry, ours ends here.
        unsafe {
            (f.set_geometry_quality)(geometry, self.quality);
            (f.commit_geometry)(geometry);
            (f.attach_geometry)(self.scene.handle, geometry);
            (f.release_geometry)(geometry);
        }
    }

    fn fill<T: Word, const N: usize>(
        &self,
        geometry: Handle,
        buffer: &Buffer<'_, T, N>,
    ) -> Result<(), String> {
        let (stride, count) = (size_of::<[T; N]>(), buffer.rows.len());
        // SAFETY: the geometry is alive; Embree allocates `stride * count` bytes, into which as many are copied.
        unsafe {
            let to = (self.scene.embree.0.new_buffer)(geometry, buffer.kind, 0, buffer.format, stride, count);
            if to.is_null() {
                return Err("Embree has no memory for a buffer".into());
            }
            std::ptr::copy_nonoverlapping(buffer.rows.as_ptr(), to.cast::<[T; N]>(), count);
        }
        Ok(())
    }

    /// Builds the tree; gives it with the bytes that it took.
    pub(super) fn commit(self) -> Result<(Scene, isize), String> {
        let before = self.device.bytes.load(Ordering::Relaxed);
        // SAFETY: scene and device are alive.
        let error = unsafe {
            (self.scene.embree.0.commit_scene)(self.scene.handle);
            (self.scene.embree.0.device_error)(self.device.handle)
        };
        let bytes = self.device.bytes.load(Ordering::Relaxed) - before;
        if error == 0 { Ok((self.scene, bytes)) } else { Err(format!("Embree's error {error}")) }
    }
}

/// A committed scene, to be asked from any thread.
pub(super) struct Scene {
    embree: Embree,
    handle: Handle,
}

// SAFETY: Embree's queries may run from several threads at once, and a committed scene is not changed any more.
unsafe impl Send for Scene {}
// SAFETY: as above.
unsafe impl Sync for Scene {}

impl Drop for Scene {
    fn drop(&mut self) {
        // SAFETY: made by `Device::scene` and released once.
        unsafe { (self.embree.0.release_scene)(self.handle) }
    }
}

impl Scene {
    /// Nearest hit of a ray.
    #[inline]
    pub(super) fn intersect1(&self, ray: &mut RayHit, arguments: &mut QueryArguments) {
        // SAFETY: the scene is committed; both structures are laid out and aligned as in C.
        unsafe { (self.embree.0.intersect1)(self.handle, ray, arguments) }
    }
    /// Nearest hits of eight rays.
    #[inline]
    pub(super) fn intersect8(&self, valid: &Valid8, rays: &mut RayHit8, arguments: &mut QueryArguments) {
        // SAFETY: as above.
        unsafe { (self.embree.0.intersect8)(valid.0.as_ptr(), self.handle, rays, arguments) }
    }
    /// Sets `t_far` to minus infinity if the ray hits anything.
    #[inline]
    pub(super) fn occluded1(&self, ray: &mut Ray, arguments: &mut QueryArguments) {
        // SAFETY: as above.
        unsafe { (self.embree.0.occluded1)(self.handle, ray, arguments) }
    }
    /// The same for eight rays.
    #[inline]
    pub(super) fn occluded8(&self, valid: &Valid8, rays: &mut Ray8, arguments: &mut QueryArguments) {
        // SAFETY: as above.
        unsafe { (self.embree.0.occluded8)(valid.0.as_ptr(), self.handle, rays, arguments) }
    }
}
