//! Rays of a window that go nearly the same way: each flat mirror throws back a beam, wherever in the window its rays stand.
//!
//! Plainly: a ray belongs to the beam whose last ray goes as it does, up to a small angle, or begins one.

use wide::f32x8;

use super::super::BUNDLE;
use super::super::columns::RayColumns;
use super::super::frustum::narrow;
use crate::intersect::Tier;
use crate::math::{Lane, Mask, Real, Stored, Vec3, WIDTH};

/// Beams that are told apart in a window.
const MOST: usize = 8;
/// Rays from which a beam is one.
const LEAST: usize = 3 * WIDTH;
/// Squared cosine of the angle between one ray and the next within which they belong to one beam: two and a half degrees.
const ALIKE: f32 = 0.9981;
/// Rows of a window, each of which fits into a byte.
const ROWS: usize = BUNDLE * WIDTH;

/// The rays of a window by beam.
pub(super) struct Beams {
    /// Rows, counted from the first of the window on, beam by beam.
    rows: [u8; ROWS],
    /// How many rows there are up to the end of each beam.
    ends: [usize; MOST],
    count: usize,
    /// Lanes of each packet whose rays belong to none, as bits, those that are not asked among them.
    pub(super) loose: [u8; BUNDLE],
}

impl Beams {
    /// The beams among so many packets from row `first` on; `None` if there are none.
    #[inline(never)]
    pub(super) fn of<T: Tier, S: Stored<T::Wide>>(
        rays: &RayColumns<S>,
        first: usize,
        packets: usize,
    ) -> Option<Self> {
        let (mut forming, mut count, mut loose) = ([Forming::NONE; MOST], 0, [0; BUNDLE]);
        for (j, loose) in loose[..packets].iter_mut().enumerate() {
            let at = first + j * WIDTH;
            let (there, asked) = (rays.there(at), rays.asked::<T::Wide>(at));
            let (d, mut left) = (narrow::<T>(rays.directions(at)), asked);
            for beam in &mut forming[..count] {
                left = beam.take(j, left, d);
            }
            while left != 0 && count < MOST {
                forming[count].lead_by(left.trailing_zeros() as usize % WIDTH, d);
                let rest = forming[count].take(j, left, d);
                if rest == left {
                    // Not even alike itself: its squares overflow or underflow.
                    break;
                }
                (left, count) = (rest, count + 1);
            }
            *loose = (left | there & !asked) as u8;
        }
        Self::sorted(&forming[..count], loose)
    }

    /// The rows of the beams, but of those that are too small.
    fn sorted(forming: &[Forming], loose: [u8; BUNDLE]) -> Option<Self> {
        let mut beams = Self { rows: [0; ROWS], ends: [0; MOST], count: 0, loose };
        let mut end = 0;
        for beam in forming {
            if beam.rays < LEAST {
                beams.loose.iter_mut().zip(beam.lanes).for_each(|(loose, lanes)| *loose |= lanes);
                continue;
            }
            for (j, mut lanes) in beam.lanes.into_iter().enumerate() {
                while lanes != 0 {
                    beams.rows[end % ROWS] = (j * WIDTH) as u8 | lanes.trailing_zeros() as u8;
                    (lanes, end) = (lanes & (lanes - 1), end + 1);
                }
            }
            beams.ends[beams.count] = end;
            beams.count += 1;
        }
        (beams.count > 0).then_some(beams)
    }

    /// The rows of each beam, and how many come before.
    pub(super) fn each(&self) -> impl Iterator<Item = (usize, &[u8])> {
        let starts = std::iter::once(0).chain(self.ends);
        starts.zip(&self.ends[..self.count]).map(|(start, &end)| (start, &self.rows[start..end]))
    }
}

/// A beam as far as its rays have been seen.
#[derive(Clone, Copy)]
struct Forming {
    /// The direction of its last ray in all lanes, and its squared length.
    lead: Vec3<f32x8>,
    length2: f32x8,
    rays: usize,
    /// Its lanes of each packet, as bits.
    lanes: [u8; BUNDLE],
}

impl Forming {
    const NONE: Self = {
        let zero = f32x8::ZERO;
        Self { lead: Vec3 { x: zero, y: zero, z: zero }, length2: zero, rays: 0, lanes: [0; BUNDLE] }
    };

    /// Takes those of some lanes of packet `j` that go its way; gives the others.
    #[inline(always)]
    fn take(&mut self, j: usize, among: u32, d: Vec3<f32x8>) -> u32 {
        let along = d.dot(self.lead);
        let within = (along * along).gt(d.length_squared() * self.length2 * f32x8::splat(ALIKE));
        let lanes = (along.gt(f32x8::ZERO) & within).bits() & among;
        if lanes != 0 {
            self.lanes[j] = lanes as u8;
            self.rays += lanes.count_ones() as usize;
            self.lead_by(lanes.ilog2() as usize % WIDTH, d);
        }
        among & !lanes
    }

    #[inline(always)]
    fn lead_by(&mut self, lane: usize, d: Vec3<f32x8>) {
        self.lead = Vec3::splat(d.get(lane));
        self.length2 = self.lead.length_squared();
    }
}

/// True if all rays of so many packets from row `first` on seem to belong to one beam, as far as a look at a few tells.
#[inline(always)]
pub(super) fn are_one<R: Real>(rays: &RayColumns<R>, first: usize, packets: usize) -> bool {
    let heading = |row: usize| rays.direction.map(|column| column[row].to_f32());
    let dot = |a: [f32; 3], b: [f32; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let (lead, last) = (heading(first), (packets * WIDTH).min(rays.len - first) - 1);
    let least = ALIKE * dot(lead, lead);
    (1..WIDTH).map(|k| last * k / (WIDTH - 1)).all(|at| {
        let other = heading(first + at);
        let along = dot(lead, other);
        along > 0.0 && along * along > least * dot(other, other)
    })
}

#[cfg(test)]
pub(super) mod tests {
    use super::super::super::columns::Bound;
    use super::*;
    use crate::intersect::testing::dice::Dice;
    use crate::intersect::{Exact, Watertight};

    /// Rays that two flat mirrors throw back in turns of no order, and every tenth anywhere: columns of origins, directions
    /// and `t_max`, and which mirror it was.
    pub(in super::super) fn of_two_mirrors(count: usize, dice: &mut Dice) -> ([Vec<f32>; 7], Vec<usize>) {
        let (mut columns, mut mirrors) = (std::array::from_fn(|_| Vec::new()), Vec::new());
        for row in 0..count {
            let mirror = if row % 10 == 9 { 2 } else { dice.below(2) };
            let [x, y] = std::array::from_fn(|_| dice.between(-0.02, 0.02) as f32);
            let (from, d) = match mirror {
                0 => ([x, y, -2.0], [x, y, 1.0]),
                1 => ([2.0, x, y], [-3.0, 3.0 * x, 3.0 * y]),
                _ => ([0.0; 3], dice.heading().map(|x| x as f32)),
            };
            let t_max = if row % 16 == 5 { f32::NEG_INFINITY } else { f32::INFINITY };
            mirrors.push(mirror);
            columns.iter_mut().zip(from.into_iter().chain(d).chain([t_max])).for_each(|(c, x)| c.push(x));
        }
        (columns, mirrors)
    }

    pub(in super::super) fn rays(columns: &[Vec<f32>; 7], len: usize) -> RayColumns<'_, f32> {
        let [ox, oy, oz, dx, dy, dz, t_max] = columns.each_ref().map(|column| &column[..]);
        let (t_min, t_max) = (Bound::All(0.0), Bound::Each(t_max));
        RayColumns { len, origin: [ox, oy, oz], direction: [dx, dy, dz], t_min, t_max }
    }

    fn sorts<T: Tier>(dice: &mut Dice)
    where
        f32: Stored<T::Wide>,
    {
        let (columns, mirrors) = of_two_mirrors(ROWS + 40, dice);
        let (len, first) = (ROWS + 21, 32);
        let rays = rays(&columns, len);
        let beams = Beams::of::<T, f32>(&rays, first, (len - first).div_ceil(WIDTH)).expect("two");
        let mut met = vec![0; len];
        for (_, rows) in beams.each() {
            let each: Vec<usize> = rows.iter().map(|row| first + usize::from(*row)).collect();
            assert!(each.iter().filter(|row| mirrors[**row] == mirrors[each[0]]).count() + 2 >= each.len());
            each.iter().for_each(|row| met[*row] += 1);
        }
        let beamed = met.iter().sum::<usize>();
        assert!((0..len).all(|row| met[row] == 0 || columns[6][row] > 0.0));
        for (j, lanes) in beams.loose.into_iter().enumerate() {
            (0..WIDTH).filter(|i| lanes >> i & 1 != 0).for_each(|i| met[first + j * WIDTH + i] += 1);
        }
        assert!(met[first..].iter().all(|&times| times == 1), "each row once: {met:?}");
        let loose = met.iter().sum::<usize>() - beamed;
        assert!(beamed > (len - first) * 3 / 4 && loose > 5, "{beamed} in beams, {loose} loose");
    }

    #[test]
    fn mirrors_make_beams_whatever_the_order_of_their_rays() {
        let dice = &mut Dice(31);
        for _ in 0..20 {
            sorts::<Watertight>(dice);
            sorts::<Exact>(dice);
        }
    }

    #[test]
    fn rays_that_go_anywhere_are_no_beams_and_one_mirror_is_one() {
        let dice = &mut Dice(32);
        let (mut columns, _) = of_two_mirrors(ROWS, dice);
        let headings: Vec<_> = (0..ROWS).map(|_| dice.heading().map(|x| x as f32)).collect();
        (0..3).for_each(|k| columns[3 + k] = headings.iter().map(|d| d[k]).collect());
        assert!(Beams::of::<Watertight, f32>(&rays(&columns, ROWS), 0, BUNDLE).is_none());
        assert!(!are_one(&rays(&columns, ROWS), 0, BUNDLE));
        (0..3).for_each(|k| columns[3 + k].fill(0.5));
        assert!(are_one(&rays(&columns, ROWS - 5), 0, BUNDLE));
    }

    #[test]
    fn directions_whose_squares_are_no_numbers_belong_to_none() {
        let (mut columns, _) = of_two_mirrors(ROWS, &mut Dice(33));
        for (column, size) in columns[3..6].iter_mut().zip([1e-30, 1e30, f32::NAN]) {
            column.fill(size);
        }
        assert!(Beams::of::<Watertight, f32>(&rays(&columns, ROWS), 0, BUNDLE).is_none());
        assert!(!are_one(&rays(&columns, ROWS), 0, BUNDLE));
    }
}
