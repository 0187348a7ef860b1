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
    /// Spheres, and lengths of directions, within the domain.
    Curved,
    /// Those of radius 1e-6 to 1e6, and shapes of size 1 met by directions of length 1e-6 to 1e6: within that `fast` promises
    /// something of curved surfaces.
    Ordinary,
    /// Spheres of such radii of which `f32` tells little: huge, or touching each other.
    Ground,
    /// Cylinders of such radii from inside, at their rims: closed surfaces.
    Rims,
    /// Triangles, spheres and cylinders of such radii through each other, from points anywhere in and around them.
    Mixed,
    /// Curved surfaces of such radii where they are grazed, and cylinders of extreme shape: what `f32` says of `t` means little.
    Grazing,
    /// Curved surfaces of such radii from points on or just beside them, where `t` of `f32` input is what rounding leaves
    /// of nearly nothing in all tiers but `exact`.
    Nearby,
    /// Shapes and distances of very different magnitude.
    Magnitudes,
    /// Boxes.
    Boxes,
    /// Rays that leave surfaces.
    Leaving,
    /// Paths through glass.
    Glass,
    /// Beyond the domain of `f32`.
    Beyond,
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

const ZERO: Option<f64> = Some(0.0);

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

impl Promise {
    /// The bounds of a tier.
    pub fn bounds(self, tier: TierName) -> Bounds {
        match (self, tier) {
            (Self::Boxes, _) => Bounds { missed: ZERO, differing: ZERO, ..NOTHING },
            (_, TierName::Fast) => self.fast(),
            (Self::Leaks, _) => Bounds { leaks: ZERO, ..NOTHING },
            (Self::Leaving | Self::Glass, _) => Bounds { self_hits: ZERO, ..NOTHING },
            (_, TierName::Watertight) => self.watertight(),
            (_, TierName::Exact) => self.exact(),
        }
    }

    /// Triangles of any size within the domain; curved surfaces of radius 1e-6 to 1e6, directions of such lengths.
    fn fast(self) -> Bounds {
        let right = Bounds { gross: ZERO, differing: ZERO, ..NOTHING };
        match self {
            Self::Closed => Bounds { leaks: Some(FAST_LEAKS), ..right },
            Self::Rims => Bounds { leaks: ZERO, ..right },
            Self::Triangles | Self::Ordinary | Self::Magnitudes => Bounds { t_p99: Some(4.0), ..right },
            Self::Mixed => Bounds { t_p99: Some(10.0), ..right },
            Self::EdgeOn | Self::Starting | Self::Ground | Self::Grazing | Self::Nearby => right,
            Self::Leaks => Bounds { leaks: Some(FAST_LEAKS), ..NOTHING },
            Self::Leaving => Bounds { self_hits: Some(50_000.0), ..NOTHING },
            Self::Glass => Bounds { self_hits: ZERO, ..NOTHING },
            Self::Curved | Self::Boxes | Self::Beyond => NOTHING,
        }
    }

    fn watertight(self) -> Bounds {
        let t_p99 = match self {
            Self::EdgeOn | Self::Nearby | Self::Beyond => None,
            Self::Closed => Some(2.0),
            Self::Starting => Some(1.0),
            _ => Some(0.5),
        };
        let gross = if self == Self::Beyond { None } else { ZERO };
        Bounds { gross, differing: ZERO, leaks: self.leaks(), t_p99, ..NOTHING }
    }

    fn exact(self) -> Bounds {
        Bounds { wrong: ZERO, gross: ZERO, differing: ZERO, leaks: self.leaks(), t_p99: Some(0.5), ..NOTHING }
    }

    /// Of the tiers whose surfaces are closed.
    fn leaks(self) -> Option<f64> {
        if matches!(self, Self::Closed | Self::Rims) { ZERO } else { None }
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
