//! The scene exactly as the user wrote it.
//!
//! A [`SceneDescription`] holds what a scene file says and nothing more: plain structs with the keys of the file as
//! field names, numbers as `f64`, and `None` where the user left a key out and the default depends on other keys
//! (the accessor methods resolve those). [`parse`] and [`read`] give only descriptions that passed [`SceneDescription::check`].
//!
//! ```
//! let scene = octray::describe::parse(
//!     r#"
//!     [camera]
//!     position = [0, 0, -5]
//!     look_at = [0, 0, 0]
//!     [[light.point]]
//!     position = [-4, 5, -3]
//!     intensity = 56
//!     [[sphere]]
//!     center = [0, 0, 0]
//!     radius = 1
//!     "#,
//!     "scene.toml",
//! )
//! .unwrap();
//! assert_eq!(scene.sphere.len(), 1);
//! ```
//!
//! **Units**: lengths in world units, angles in degrees, colours in linear sRGB, sizes in pixels.

mod amend;
mod background;
mod builtin;
mod camera;
mod check;
mod error;
pub(crate) mod exact;
mod framed;
mod light;
mod locate;
mod material;
mod mesh;
mod number;
mod overrides;
mod parse;
mod render;
mod scene;
mod shape;
mod transform;
pub(crate) mod words;
mod write;

pub use amend::Amendable;
pub use background::Background;
pub use builtin::{BuiltinScene, builtin, builtin_scenes};
pub(crate) use builtin::{is_file_name, unknown_builtin};
pub use camera::{Camera, CameraKind, Handedness};
pub use check::Fault;
pub use error::{DescribeError, Diagnostic, Origin};
pub use framed::framed_mesh;
pub use light::{DirectionalLight, Lights, PointLight, SpotLight};
pub use material::{Material, MaterialKind};
pub use mesh::{Instance, Mesh, MeshSource, Procedural, ProceduralKind};
pub use number::{Factors, Rgb};
pub use parse::{parse, parse_with, read, read_with};
pub use render::{BuildQuality, Filter, FilterKind, Render, Sampler, Tier, Tone};
pub use scene::{Group, Objects, SceneDescription, Target};
pub use shape::{Cylinder, Plane, Quad, Sphere, Triangle};
pub use transform::{Rotation, Step, Transform};
pub use write::schema;
