//! octray: a data-oriented CPU ray tracer. Scenes become columns, a tree of eight children a node, packets of eight
//! rays and queues of path states; the picture depends on the scene alone, not on threads or packets.
//!
//! # Asking rays
//!
//! A [`RayScene`] answers "what does this ray hit" without any rendering, from plain arrays:
//!
//! ```
//! use octray::{Hint, Primitive, Ray, RaySceneBuilder, TierName};
//!
//! let scene = RaySceneBuilder::new()
//!     .mesh(&[[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [0.0, 1.0, 0.0]], &[[0, 1, 2]])?
//!     .sphere([0.0, 0.0, 5.0], 1.0)?
//!     .cylinder([3.0, 0.0, -1.0], [3.0, 0.0, 1.0], 0.5, true)?
//!     .build();
//!
//! let rays = [
//!     Ray::new([0.0, 0.0, -2.0], [0.0, 0.0, 1.0]),
//!     Ray { t_min: 2.5, ..Ray::new([0.0, 0.0, -2.0], [0.0, 0.0, 1.0]) },
//!     Ray { t_max: 4.0, ..Ray::new([3.0, 0.0, -9.0], [0.0, 0.0, 1.0]) },
//! ];
//! let mut hits = [None; 3];
//! scene.closest(&rays, &mut hits, TierName::Watertight, Hint::Coherent);
//!
//! let hit = hits[0].expect("the triangle is in the way");
//! assert_eq!(hit.t, 2.0);
//! assert_eq!(scene.primitive(hit.prim), Primitive::Triangle { mesh: 0, triangle: 0 });
//! assert_eq!(scene.primitive(hits[1].expect("behind it is the sphere").prim), Primitive::Sphere(0));
//! assert!(hits[2].is_none(), "the ray ends before the cylinder");
//!
//! let mut occluded = [false; 3];
//! scene.occluded(&rays, &mut occluded, TierName::Watertight, Hint::Auto);
//! assert_eq!(occluded, [true, true, false]);
//! # Ok::<(), octray::RaySceneError>(())
//! ```
//!
//! # Rendering
//!
//! A scene file (or [`describe::builtin`]) is parsed, compiled, rendered and written:
//!
//! ```
//! use octray::output::{Format, encode};
//! use octray::scene::Scene;
//! use octray::wavefront::{Progress, RenderOptions, render};
//!
//! let description = octray::describe::parse(
//!     r#"
//!     [camera]
//!     position = [0, 0, -5]
//!     look_at = [0, 0, 0]
//!     [render]
//!     size = [32, 24]
//!     spp = 4
//!     [[light.point]]
//!     position = [-4, 5, -3]
//!     intensity = 56
//!     [[sphere]]
//!     center = [0, 0, 0]
//!     radius = 1
//!     "#,
//!     "example.toml",
//! )?;
//! let scene = Scene::compile(&description)?;
//! let progress = |p: Progress| eprintln!("{} of {} pixels", p.pixels_done, p.pixels_total);
//! let (film, report) = render(&scene, &RenderOptions { progress: Some(&progress), ..Default::default() })?;
//! assert_eq!((film.width, film.height, report.samples), (32, 24, 32 * 24 * 4));
//! assert!(film.pixel(16, 12)[0] > film.pixel(0, 0)[0], "the sphere is brighter than the background");
//!
//! let mut png = Vec::new();
//! encode(&film, Format::Png, scene.settings.tone, &mut png)?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! [`output::write_file`] puts the bytes in a file in one step.
//!
//! # The way of a scene
//!
//! | module | turns |
//! |---|---|
//! | [`describe`] | scene files and built-in names into a [`describe::SceneDescription`], exactly as written |
//! | [`load`] | OBJ, PLY, STL and procedural meshes into a [`load::Mesh`] |
//! | [`geometry`] | primitives into columns, groups and instances |
//! | [`accel`] | columns into a tree, rays into hits |
//! | [`scene`] | descriptions and meshes into a scene, and into what it requires of the renderer |
//! | [`intersect`] | one ray or eight and a primitive into a hit: each test written once for all widths |
//! | [`shading`] | a hit's material and lights into radiance and further rays |
//! | [`wavefront`] | a scene into a film: generate, extend, shade, connect, scatter |
//! | [`sampling`] | (seed, pixel, sample, dimension) into numbers |
//! | [`film`] | samples into pixels, in an order that no thread can change |
//! | [`output`] | films into PNG, PPM, EXR, PFM |
//! | [`math`] | the lanes that all of it is written over |
//! | [`batch`] | job files into many pictures, resumable and in shards |
//! | [`measure`] | scenes into rays a second, hard rays into errors, pictures into differences, settings into costs |
//! | [`cli`] | arguments into all of the above |
//!
//! # Which tier
//!
//! A tier fixes number type, triangle test and how curved surfaces are decided ([`intersect::Tier`]).
//!
//! - [`TierName::Watertight`], the default: `f32` rays, closed meshes do not leak, distances decided in `f64`, the same
//!   bits for any number of threads, packet width, tree and machine.
//! - [`TierName::Fast`]: `f32` with fused operations, and `f64` for triangles that it cannot tell; a ray may slip through a shared
//!   edge, and the last bits may differ between builds. For previews.
//! - [`TierName::Exact`]: `f64` rays and tests on the same `f32` scene; what is met is decided without rounding.
//!   For references and for scenes whose parts differ in size by many orders of magnitude.
//!
//! [`measure::verify`] holds them to this, and other intersectors too. What was measured of each, within which scales that is
//! promised, and what happens beyond: [Which tier?](readme/index.html#which-tier).
//!
//! A [`Hint`] says how rays lie to each other. It changes time, never results.

#![deny(unsafe_code)]
#![warn(missing_docs)]

pub mod accel;
pub mod batch;
pub mod cli;
pub mod describe;
pub mod film;
pub mod geometry;
pub mod intersect;
pub mod load;
pub mod math;
pub mod measure;
pub mod output;
pub mod sampling;
pub mod scene;
pub mod shading;
pub mod wavefront;

pub use accel::{Hint, Primitive, RayScene, RaySceneBuilder, RaySceneError};
pub use intersect::{Hit, PrimId, Ray, TierName};

/// The README as a page of the documentation, where its example compiles and holds.
///
#[cfg(any(doc, doctest))]
#[doc = include_str!("../README.md")]
pub mod readme {}
