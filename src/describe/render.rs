//! How the picture is computed: size, samples, filter, tone.

use super::exact;
use crate::film::Aov;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The settings of a render.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Render {
    /// Width and height in pixels. Default `[640, 480]`; at most 2^28 pixels in all.
    #[serde(deserialize_with = "exact::read")]
    pub size: [u32; 2],
    /// Samples a pixel, at least 1. Default 16.
    pub spp: u32,
    /// How many times a camera ray may be reflected, refracted or scattered. Default 6; 0 shows direct light only.
    pub max_depth: u32,
    /// Whether what stands before a light takes it away. Default true. Without, no shadow rays are traced: every surface that
    /// faces a light gets it, through walls too; quicker, for previews and flat lighting. Mirrors, glass and bounces stay.
    pub shadows: bool,
    /// Number that chooses the random sequences. Default 0.
    pub seed: u64,
    /// Precision: `fast`, `watertight` (default) or `exact`.
    pub tier: Tier,
    /// Work that goes into the tree that rays search: `fast`, `balanced` (default) or `high`. Changes times, not the picture
    /// (but in tier `fast`).
    pub build_quality: BuildQuality,
    /// How samples are spread: `random`, `stratified` or `sobol` (default).
    pub sampler: Sampler,
    /// The pixel filter.
    pub filter: Filter,
    /// Exposure in stops: the picture is multiplied by 2^exposure. Default 0.
    pub exposure: f64,
    /// Tone curve of pictures with 8 bits: `none` (default, clamps at 1), `reinhard` or `filmic`.
    pub tone: Tone,
    /// Paths whose weight falls below this in every channel end. Default 1/1024, a quarter of a step of 8 bits.
    pub min_throughput: f64,
    /// Values beside colour, for EXR pictures: `depth`, `position`, `geometric_normal`, `shading_normal`, `uv`, `object_id`,
    /// `primitive_id`, `material_id`, `albedo`, `hit`, `sample_count`. Default none.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub aovs: Vec<Aov>,
}

/// Which arithmetic decides a hit.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Tier {
    /// Quickest; may lose rays between triangles and may differ between builds.
    Fast,
    /// No ray is lost between triangles; the same picture everywhere.
    #[default]
    Watertight,
    /// Double precision.
    Exact,
}

/// How much work goes into building the tree: it pays back ray by ray.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum BuildQuality {
    /// Soonest built: for few rays.
    Fast,
    /// Good for most scenes.
    #[default]
    Balanced,
    /// Also cuts triangles where they overlap: for many rays in scenes of large or long triangles.
    High,
}

/// How the samples of a pixel are spread.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Sampler {
    /// Independent random numbers.
    Random,
    /// One random number in each cell of a grid.
    Stratified,
    /// Owen-scrambled Sobol points.
    #[default]
    Sobol,
}

/// The curve that turns linear light into a displayable range.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Tone {
    /// Clamps at 1.
    #[default]
    None,
    /// x / (1 + x).
    Reinhard,
    /// An S-curve like film.
    Filmic,
}

/// The pixel filter: how much a sample counts by its distance from the pixel's centre.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Filter {
    /// `box` (default), `tent`, `gaussian` or `mitchell`.
    pub kind: FilterKind,
    /// Half width in pixels. Default: box 0.5, tent 1, gaussian 1.5, mitchell 2.
    pub radius: Option<f64>,
    /// Gaussian: standard deviation in pixels. Default 0.5.
    pub sigma: f64,
    /// Mitchell: B. Default 1/3.
    pub b: f64,
    /// Mitchell: C. Default 1/3.
    pub c: f64,
}

/// The shape of the pixel filter.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum FilterKind {
    /// All samples within the radius count alike.
    #[default]
    Box,
    /// Falls off in a straight line.
    Tent,
    /// Falls off like a bell.
    Gaussian,
    /// Mitchell and Netravali's cubic, slightly negative outside.
    Mitchell,
}

impl Default for Render {
    fn default() -> Render {
        Render {
            size: [640, 480],
            spp: 16,
            max_depth: 6,
            shadows: true,
            seed: 0,
            tier: Tier::default(),
            build_quality: BuildQuality::default(),
            sampler: Sampler::default(),
            filter: Filter::default(),
            exposure: 0.0,
            tone: Tone::default(),
            min_throughput: 1.0 / 1024.0,
            aovs: Vec::new(),
        }
    }
}

impl Default for Filter {
    fn default() -> Filter {
        Filter { kind: FilterKind::Box, radius: None, sigma: 0.5, b: 1.0 / 3.0, c: 1.0 / 3.0 }
    }
}

impl Filter {
    /// Half width in pixels, with its default resolved.
    #[must_use]
    pub fn radius(&self) -> f64 {
        self.radius.unwrap_or(match self.kind {
            FilterKind::Box => 0.5,
            FilterKind::Tent => 1.0,
            FilterKind::Gaussian => 1.5,
            FilterKind::Mitchell => 2.0,
        })
    }
}
