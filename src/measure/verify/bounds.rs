//! What each tier promises, family by family: the documented bounds that `octray verify` measures against.

use super::tally::Fault;
use crate::intersect::TierName;

/// What a family may hold a tier to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Promise {
    /// Closed meshes.
    Closed,
    /// Closed meshes, of which nothing is asked but whether rays get out.
    Leaks,
    /// Triangles within the domain.
    Triangles,
    /// Triangles from points on them, where `t` is what rounding makes of zero.
    Starting,
    /// Triangles seen edge-on, where `f32` edges leave `t` anywhere between the corners.
    EdgeOn,
    /// Spheres within the domain.
    Spheres,
    /// Those of radius 1e-6 to 1e6, within which `fast` promises something of curved surfaces.
    ModerateSpheres,
    /// Spheres of such radii of which `f32` tells little: huge, or touching each other.
    Ground,
    /// Cylinders of such radii.
    Cylinders,
    /// Triangles, spheres and cylinders of such radii beside each other.
    Mixed,
    /// Curved surfaces of such radii where they are grazed, and cylinders of extreme shape: what `f32` says of `t` means little.
    Grazing,
    /// Directions as short and as long as the domain allows.
    Lengths,
    /// Shapes and distances of very different magnitude.
    Magnitudes,
    /// Boxes.
    Boxes,
    /// Rays that leave surfaces.
    Leaving,
    /// Paths through glass.
    Glass,
    /// Beyond the domain: measured, not promised.
    None,
}

/// The most that is allowed; `None` where nothing is promised.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Bounds {
    /// False misses and false hits a million rays.
    pub wrong: Option<f64>,
    /// False misses alone.
    pub missed: Option<f64>,
    /// Those that no change of the input by 16 roundoffs excuses.
    pub gross: Option<f64>,
    /// Rays through closed surfaces.
    pub leaks: Option<f64>,
    /// Rays that hit the surface that they leave, or stray from their path.
    pub self_hits: Option<f64>,
    /// Answers that depend on how rays are asked.
    pub differing: Option<f64>,
    /// 99th percentile of the error of `t` in ulps of `f32`.
    pub t_p99: Option<f64>,
}

const NOTHING: Bounds = Bounds {
    wrong: None,
    missed: None,
    gross: None,
    leaks: None,
    self_hits: None,
    differing: None,
    t_p99: None,
};

/// Rays a million at vertices, edges and faces of closed meshes: fewer than the 28,490 that Embree loses in its default mode.
const FAST_LEAKS: f64 = 28_000.0;

/// The same where a single mesh may be all that is asked: some lose more than others.
const FAST_LEAKS_OF_ONE: f64 = 40_000.0;

impl Promise {
    /// The bounds of a tier.
    pub fn bounds(self, tier: TierName) -> Bounds {
        let zero = Some(0.0);
        let differing = if tier == TierName::Fast { None } else { zero };
        match (self, tier) {
            (Self::Boxes, _) => Bounds { missed: zero, differing, ..NOTHING },
            (_, TierName::Fast) => self.fast(),
            (Self::None, _) => Bounds { differing, ..NOTHING },
            (Self::Leaks, _) => Bounds { leaks: zero, ..NOTHING },
            (Self::Leaving | Self::Glass, _) => Bounds { self_hits: zero, ..NOTHING },
            (_, TierName::Watertight) => self.watertight(),
            (_, TierName::Exact) => self.exact(),
        }
    }

    /// Triangles of any size within the domain; curved surfaces of radius 1e-6 to 1e6, directions of such lengths.
    fn fast(self) -> Bounds {
        let gross = Some(0.0);
        match self {
            Self::Closed => Bounds { gross, leaks: Some(FAST_LEAKS), ..NOTHING },
            Self::Leaks => Bounds { leaks: Some(FAST_LEAKS_OF_ONE), ..NOTHING },
            Self::ModerateSpheres => Bounds { gross, t_p99: Some(4.0), ..NOTHING },
            Self::Triangles => Bounds { gross, t_p99: Some(4.0), ..NOTHING },
            Self::Cylinders => Bounds { gross, t_p99: Some(4.5), ..NOTHING },
            Self::Mixed => Bounds { gross, t_p99: Some(12.0), ..NOTHING },
            Self::Magnitudes => Bounds { gross, t_p99: Some(5.0), ..NOTHING },
            Self::EdgeOn | Self::Starting | Self::Ground | Self::Grazing => Bounds { gross, ..NOTHING },
            Self::Leaving => Bounds { self_hits: Some(50_000.0), ..NOTHING },
            Self::Glass => Bounds { self_hits: Some(0.0), ..NOTHING },
            Self::Spheres | Self::Lengths | Self::Boxes | Self::None => NOTHING,
        }
    }

    fn watertight(self) -> Bounds {
        let zero = Some(0.0);
        let t_p99 = match self {
            Self::EdgeOn => None,
            Self::Cylinders | Self::Mixed | Self::Grazing | Self::Lengths => Some(12.0),
            _ => Some(5.0),
        };
        let leaks = if self == Self::Closed { zero } else { None };
        Bounds { gross: zero, differing: zero, leaks, t_p99, ..NOTHING }
    }

    fn exact(self) -> Bounds {
        let t_p99 = Some(if self == Self::Magnitudes { 1.0 } else { 0.5 });
        Bounds { wrong: Some(0.0), t_p99, ..self.watertight() }
    }
}

impl Bounds {
    /// The most of a kind of error a million rays.
    pub(super) fn of(&self, fault: Fault) -> Option<f64> {
        match fault {
            Fault::FalseMiss => self.wrong.or(self.missed),
            Fault::FalseHit => self.wrong,
            Fault::GrossMiss | Fault::GrossHit => self.gross,
            Fault::Leak => self.leaks,
            Fault::SelfHit => self.self_hits,
            Fault::Differing => self.differing,
        }
    }
}
