//! The verification of octray, run on an intersector behind a C ABI: a shared library that exports
//! `int octray_nearest(const float (*corner)[3], size_t triangles, const float ray[8], float *t)`.
//!
//! ```sh
//! cargo run --release --example verify_c                # examples/verify_c/nearest.c, by the C compiler that is there
//! cargo run --release --example verify_c -- libmine.so  # your own
//! ```

// The C ABI cannot be called otherwise. Each block says what it rests on.
#![allow(unsafe_code)]

use std::error::Error;
use std::path::{Path, PathBuf};
use std::process::Command;

use libloading::Library;
use octray::Ray;
use octray::measure::verify::{Bounds, Effort, Family, Intersector, Shape, verify_intersector};

/// Three corners a triangle; origin, direction, `t_min` and `t_max` of a ray; where `t` goes. Not 0 if there is a hit.
type Nearest = unsafe extern "C" fn(*const [f32; 3], usize, *const [f32; 8], *mut f32) -> i32;

/// A function of a library, which stays loaded as long as it is called.
struct Foreign {
    nearest: Nearest,
    _library: Library,
}

impl Foreign {
    fn load(path: &Path) -> Result<Self, libloading::Error> {
        // SAFETY: loading runs what the library does when it is loaded, and the symbol is taken for a function of the type
        // above: both are what whoever names the library promises.
        unsafe {
            let library = Library::new(path)?;
            let nearest = *library.get::<Nearest>(b"octray_nearest\0")?;
            Ok(Self { nearest, _library: library })
        }
    }
}

impl Intersector for Foreign {
    type Scene = Vec<[f32; 3]>;

    fn build(&self, shapes: &[Shape]) -> Option<Self::Scene> {
        let corners = |shape: &Shape| match shape {
            Shape::Triangle(corners) => Some(*corners),
            _ => None,
        };
        let triangles: Option<Vec<[[f32; 3]; 3]>> = shapes.iter().map(corners).collect();
        Some(triangles?.concat())
    }

    fn nearest(&self, corners: &Self::Scene, ray: &Ray) -> Option<f32> {
        let ([ox, oy, oz], [dx, dy, dz]) = (ray.origin, ray.direction);
        let (row, mut t) = ([ox, oy, oz, dx, dy, dz, ray.t_min, ray.t_max], 0.0);
        // SAFETY: the pointers are those of as many corners, of a ray and of a number, which all outlive the call, and the
        // library is loaded. That it reads and writes no more, from any thread, is its promise.
        let found = unsafe { (self.nearest)(corners.as_ptr(), corners.len() / 3, &row, &mut t) };
        (found != 0).then_some(t)
    }
}

/// The library of the C file beside this one; nothing without a C compiler.
fn compiled(folder: &Path) -> Result<Option<PathBuf>, Box<dyn Error>> {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/verify_c/nearest.c");
    let library = folder.join("libnearest.so");
    let compiler = std::env::var_os("CC").unwrap_or("cc".into());
    match Command::new(compiler).args(["-O2", "-shared", "-fPIC", "-o"]).arg(&library).arg(source).status() {
        Ok(status) if status.success() => Ok(Some(library)),
        Ok(status) => Err(format!("the C compiler failed: {status}").into()),
        Err(_) => Ok(None),
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let folder = tempfile::tempdir()?;
    let Some(path) =
        std::env::args_os().nth(1).map_or_else(|| compiled(folder.path()), |path| Ok(Some(path.into())))?
    else {
        println!("no C compiler here: name a shared library");
        return Ok(());
    };
    let foreign = Foreign::load(&path)?;
    for name in ["triangles", "triangle-edges", "closed-inside"] {
        let family = Family::named(name).ok_or("no such family")?;
        let effort = Effort { rays: 20_000, seed: 1 };
        let report = verify_intersector("C", &foreign, family, &Bounds::default(), effort);
        let report = report.ok_or_else(|| format!("no shapes in {name} that are known"))?;
        let found = report.rates.iter().filter(|rate| rate.count > 0);
        let found: Vec<String> = found.map(|rate| format!("{} {:.0}", rate.what, rate.per_million)).collect();
        let ulps = report.t_ulps.map_or(String::new(), |t| format!("; t p99 {:.3} ulp", t.p99));
        println!("{name}, of a million rays: {}{ulps}", found.join(", "));
    }
    Ok(())
}
