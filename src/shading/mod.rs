//! Pure functions of light and surface, over lanes.
//!
//! `wo` and `wi` are of length one and leave the surface; a `direction` is the way a ray travels. All results are made of
//! `+ - * /`, square roots, comparisons and selects, so each lane has the bits of the scalar.

mod blinn_phong;
mod fresnel;
mod light;
mod power;
mod scatter;

pub use blinn_phong::{Lobes, blinn_phong};
pub use fresnel::fresnel_dielectric;
pub use light::{DirectionalLight, Illumination, PointLight, SpotLight};
pub use power::{Shininess, pow_clamped};
pub use scatter::{reflect, refract};
