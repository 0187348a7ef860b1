//! Putting the pyramid around rays: their slopes, and by how much they may be off.

use wide::f32x8;

use super::edges::Eight;
use super::slopes::{Slopes, filled, greatest, least, range, slopes};
use super::view::View;
use super::{Apex, Frustum, asked, narrow};
use crate::accel::instance::TreeRoot;
use crate::intersect::{RayLanes, Tier};
use crate::math::{Lane, Mask, Real, Vec3, WIDTH, eight};

/// Roundoffs of the largest coordinate by which rays may pass by their apex.
const APEX_ROUNDOFFS: f64 = 8.0;

/// Roundoffs of the largest coordinate by which the sides are moved outwards: the 36 by which boxes of a tree are padded,
/// 8 for an apex that rays pass by, 8 for the roundings of slopes and planes, on both axes of a slope up to 2; and a
/// quarter more.
const SIDE_ROUNDOFFS: f64 = 192.0;

/// The same for edge functions, of the product of the largest coordinate, seen from the apex or from where a ray starts, and
/// the distance at which rays pass the corners.
///
/// The triangle test is off by 32 ([`crate::intersect::triangle`]), and sure beyond as much again. Here a coordinate across is
/// off by 7 where slopes are up to 1, by 5 more for rays that do not start at the apex; an edge function is the sum of two
/// products of two such, 48, and 10 for their roundings. The rest is slack.
const EDGE_ROUNDOFFS: f64 = 144.0;
/// Where slopes are up to 2, the triangle test may look along another axis, where edge functions are half as large and
/// distances up to twice as far; coordinates are off by 17.
const STEEP_EDGE_ROUNDOFFS: f64 = 352.0;
/// For parallel rays, of the coordinates of the tree.
const PARALLEL_EDGE_ROUNDOFFS: f64 = 128.0;
/// What distances across that round to nothing count as, in roundoffs of the distance along.
const LEAST_ACROSS: f64 = 64.0;

/// What rays pass by an apex behind them counts so many times in edge functions: four for those, and for six times the volume
/// between apex and triangle, which it changes by its product with the triangle's area vector, sixteen; and a quarter more.
/// Roundings on the way from where rays start back to the apex are within the slack above.
const EDGE_STRAYS: f32 = 20.0;

/// Coordinates up to which no volume overflows: six times one is at most 1,300 times the cube of the largest.
const LARGEST: f32 = 1e11;

/// How far rays may pass by an apex behind them, as a part of how wide they are where they start: more would be no beam.
const STRAY: f32 = 0.03;

/// Pads that the edge functions of large triangles add up to, so that most rays are clearly beside the edges.
const LARGE: f32 = 32.0;
/// The same where planes tell what is met: for fewer rays they are not worth it.
const LARGE_FOR_PLANES: f32 = 1024.0;

impl Frustum {
    /// Puts the pyramid around packets; `None`, and of no use, where they have no axis in common, go too far apart, are not
    /// as the apex says, or lie so far out that a bound overflows. In place, as it is large.
    ///
    /// **Needs:** at least one packet, and no more than a bundle holds.
    pub(in super::super) fn surround<T: Tier>(
        &mut self,
        packets: &[RayLanes<T::Wide>],
        apex: Apex,
        tree: TreeRoot,
    ) -> Option<()> {
        let leader = packets.iter().find(|rays| asked::<T>(rays) != 0)?;
        let lead = asked::<T>(leader).trailing_zeros() as usize;
        let heading = apex.towards::<T>(leader).get(lead);
        self.apex = apex;
        self.view = match apex.point() {
            Some(point) => View::along(heading, point),
            None => View::along_all(heading, narrow::<T>(leader.origin).get(lead)),
        };
        let (astray, size) = self.survey::<T>(packets, tree)?;
        let roundoffs = (APEX_ROUNDOFFS * f32::ROUNDOFF) as f32;
        let (allowed, counted) = match apex {
            Apex::Behind(_) => (STRAY * self.all.widest() * self.first.get(0), astray),
            Apex::Origin(_) | Apex::Target(_) => (size * roundoffs, 0.0),
            // Over twice the size, as far as anything is from where a ray starts.
            Apex::Parallel => (0.5 * roundoffs, 0.0),
        };
        let close = astray <= allowed;
        if !close {
            return None;
        }
        self.set_pads::<T>(2.0 * size, counted, if apex == Apex::Parallel { 0.0 } else { astray })
    }

    /// Takes note of where rays start and how they go; gives how far any passes by the apex, and the largest coordinate.
    #[inline(always)]
    fn survey<T: Tier>(&mut self, packets: &[RayLanes<T::Wide>], tree: TreeRoot) -> Option<(f32, f32)> {
        let (mut astray, mut far) = (f32x8::ZERO, Vec3::zero());
        let mut first = f32x8::splat(f32::INFINITY);
        for (j, rays) in packets.iter().enumerate() {
            let asked = asked::<T>(rays);
            if asked & !rays.t_min.ge(T::Wide::zero()).bits() != 0 {
                return None;
            }
            let (mut a, mut b, along, per_z) =
                slopes(self.view.direction(self.apex.towards::<T>(rays)), asked)?;
            let from = self.view.direction(narrow::<T>(rays.origin) - Vec3::splat(self.view.eye));
            let (start, by) = self.apex.start::<T>(rays, &self.view, (from, [a, b]));
            if let Some(across) = self.view.across(from) {
                [a, b] = across.map(|at| filled(at, asked));
            }
            let asked = Mask::from_bits(asked);
            (self.rays[j], self.along[j]) = (Eight { slopes: [a, b], per_z }, along);
            self.start[j] = Lane::select(asked, start, f32x8::ZERO);
            first = Lane::select(asked, Lane::min(first, start), first);
            astray = Lane::select(asked, Lane::max(astray, by), astray);
            far = Vec3::select(asked, far.max(narrow::<T>(rays.origin).abs()), far);
        }
        let scale = greatest(tree.scale_for(far).max(far.max_component()));
        let size = self.view.eye.iter().fold(scale, |size, x| size.max(x.abs()));
        self.first = f32x8::splat(least(first));
        self.set_slopes(packets.len());
        Some((greatest(astray), size))
    }

    /// Takes the slopes of so many packets, from them the order of visits, and turns them into those about the middle.
    #[inline(always)]
    fn set_slopes(&mut self, packets: usize) {
        self.count = packets.div_ceil(WIDTH);
        for j in packets..self.count * WIDTH {
            self.rays[j] = self.rays[0];
        }
        let groups = &mut self.groups[..self.count];
        for (group, rays) in groups.iter_mut().zip(self.rays.as_chunks::<WIDTH>().0) {
            let [a, b] = [0, 1].map(|axis: usize| range(eight(|j| rays[j].slopes[axis])));
            group.slopes = Slopes { a, b };
            group.all = group.slopes.whole();
            group.reach = [f32::NEG_INFINITY; WIDTH];
        }
        let (mut all, mut packet_spread) = (groups[0].all, groups[0].slopes.width());
        for group in &groups[1..] {
            all = all.union(&group.all);
            packet_spread = Lane::max(packet_spread, group.slopes.width());
        }
        let half = f32x8::splat(0.5);
        let middle @ [x, y] = [(all.a[0] + all.a[1]) * half, (all.b[0] + all.b[1]) * half];
        for rays in &mut self.rays[..packets] {
            let [a, b] = rays.slopes;
            rays.slopes = [a - x, b - y];
        }
        (self.all, self.middle.slopes) = (all, middle);
        self.about_middle = all.about(middle);
        self.middle.spread = self.about_middle.greatest();
        self.middle.packet_spread = f32x8::splat(greatest(packet_spread));
        let [x, y, z] = self.view.axes;
        let slopes = self.view.lean.unwrap_or(middle.map(|slope| slope.get(0)));
        let [against_x, against_y] = slopes.map(|slope| usize::from(slope < 0.0));
        self.octant = against_x << x | against_y << y | usize::from(self.view.backward) << z;
    }

    /// Takes the size of coordinates, by how much more than roundoffs rays pass by the apex, and by how much in all; `None`
    /// where volumes might overflow.
    #[inline(always)]
    fn set_pads<T: Tier>(&mut self, size: f32, astray: f32, measured: f32) -> Option<()> {
        let pad =
            |roundoffs: f64, size: f32| f32x8::splat((f64::from(size) * roundoffs * f32::ROUNDOFF) as f32);
        self.side_pad = pad(SIDE_ROUNDOFFS, size) + f32x8::splat(astray);
        self.tells_meetings = matches!(self.apex, Apex::Origin(_));
        // Twice, as how far is found with an error, too.
        self.middle.start_off = f32x8::splat(2.0 * measured);
        let steepest = self.all.greatest().get(0).max(1.0);
        let roundoffs = match self.view.lean {
            None if steepest > 1.0 => STEEP_EDGE_ROUNDOFFS,
            None => EDGE_ROUNDOFFS,
            Some(_) => PARALLEL_EDGE_ROUNDOFFS,
        };
        let strays = f32x8::splat(EDGE_STRAYS * measured);
        // Rays of more digits were rounded.
        self.middle.edge_pad = if self.tells_meetings && T::Real::ROUNDOFF >= f32::ROUNDOFF {
            [pad(roundoffs, 1.0), pad(roundoffs, steepest), pad(roundoffs, measured) + strays]
        } else {
            [f32x8::ZERO, f32x8::ZERO, pad(roundoffs, size) + strays]
        };
        self.middle.packet_spread += pad(LEAST_ACROSS, 1.0);
        self.middle.spread += pad(LEAST_ACROSS, 1.0);
        self.middle.stray =
            if self.view.lean.is_some() { f32x8::splat(f32::INFINITY) } else { self.side_pad };
        self.middle.large = f32x8::splat(if self.tells_meetings { LARGE } else { LARGE_FOR_PLANES });
        (size <= LARGEST).then_some(())
    }
}
