//! Rays and hits as columns: what streams of rays are asked from and answered to.

use crate::accel::query::Closest;
use crate::accel::unchecked::Ahead;
use crate::intersect::RayLanes;
use crate::math::{BitLane, Lane, Mask, Real, Stored, Vec3, WIDTH};

/// A bound of `t` that is the same for all rays, or a column of its own.
#[derive(Clone, Copy, Debug)]
pub enum Bound<'a, R> {
    /// One for all.
    All(R),
    /// One a ray.
    Each(&'a [R]),
}

impl<R: Real> Bound<'_, R> {
    #[inline(always)]
    fn load<L: Lane>(&self, at: usize) -> L
    where
        R: Stored<L>,
    {
        match self {
            Self::All(t) => L::splat(t.lane()),
            Self::Each(column) => load(column, at),
        }
    }
}

/// Rays as columns, in the number type of a tier or in a narrower one.
///
/// **Shape:** columns hold at least `len` rows; what stands in the rows beyond is not asked. **Needs:** rays whose `t_max` is not minus infinity are finite and have a direction.
#[derive(Clone, Copy, Debug)]
pub struct RayColumns<'a, R> {
    /// How many rays.
    pub len: usize,
    /// Where they start.
    pub origin: [&'a [R]; 3],
    /// Where they go; any length but zero.
    pub direction: [&'a [R]; 3],
    /// Hits at or before it do not count.
    pub t_min: Bound<'a, R>,
    /// Hits at or beyond it do not count; a ray with minus infinity is not asked.
    pub t_max: Bound<'a, R>,
}

impl<R: Real> RayColumns<'_, R> {
    /// Eight rays from row `at` on; those beyond the end are turned off.
    #[inline(always)]
    pub(super) fn load<L: Lane>(&self, at: usize) -> RayLanes<L>
    where
        R: Stored<L>,
    {
        RayLanes {
            origin: load3(&self.origin, at),
            direction: load3(&self.direction, at),
            t_min: self.t_min.load(at),
            t_max: self.t_max_at(at),
        }
    }

    /// Rays of up to eight rows, counted from row `first` on; lanes beyond are turned off.
    #[inline(always)]
    pub(super) fn gather<L: Lane>(&self, first: usize, rows: &[u8]) -> RayLanes<L>
    where
        R: Stored<L>,
    {
        let last = rows.len() - 1;
        let at: [usize; WIDTH] = std::array::from_fn(|i| first + usize::from(rows[i.min(last)]));
        let lanes = |column: &[R]| L::from_fn(|i| column[at[i]].lane());
        let three = |[x, y, z]: &[&[R]; 3]| Vec3::new(lanes(x), lanes(y), lanes(z));
        let bound = |bound: &Bound<R>| match bound {
            Bound::All(t) => L::splat(t.lane()),
            Bound::Each(column) => lanes(column),
        };
        let there = L::Mask::from_bits((2 << last) - 1);
        RayLanes {
            origin: three(&self.origin),
            direction: three(&self.direction),
            t_min: bound(&self.t_min),
            t_max: L::select(there, bound(&self.t_max), L::constant(f64::NEG_INFINITY)),
        }
    }

    /// Where eight rays from row `at` on go.
    #[inline(always)]
    pub(super) fn directions<L: Lane>(&self, at: usize) -> Vec3<L>
    where
        R: Stored<L>,
    {
        load3(&self.direction, at)
    }

    /// Which of eight rays from row `at` on there are, as bits.
    #[inline(always)]
    pub(super) fn there(&self, at: usize) -> u32 {
        0xff >> WIDTH.saturating_sub(self.len - at)
    }

    /// Which of them are asked.
    #[inline(always)]
    pub(super) fn asked<L: Lane>(&self, at: usize) -> u32
    where
        R: Stored<L>,
    {
        self.t_max_at::<L>(at).gt(L::constant(f64::NEG_INFINITY)).bits()
    }

    #[inline(always)]
    fn t_max_at<L: Lane>(&self, at: usize) -> L
    where
        R: Stored<L>,
    {
        let t_max = self.t_max.load::<L>(at);
        match self.len - at {
            count if count < WIDTH => {
                L::select(L::Mask::from_bits((1 << count) - 1), t_max, L::constant(f64::NEG_INFINITY))
            }
            _ => t_max,
        }
    }

    /// True if the ray of a row does not go on without end.
    #[inline(always)]
    pub(super) fn ends(&self, row: usize) -> bool {
        let t_max = match self.t_max {
            Bound::All(t) => t,
            Bound::Each(column) => column[row],
        };
        t_max.to_f32() < f32::MAX
    }

    /// The memory of so many rays from row `at` on, which may be beyond the end.
    #[inline(always)]
    pub(super) fn ahead(&self, at: usize, rows: usize) -> Ahead {
        let mut ahead = Ahead::of_rows::<R>(rows);
        self.origin.iter().chain(&self.direction).for_each(|column| ahead.add(column, at));
        for bound in [&self.t_min, &self.t_max] {
            if let Bound::Each(column) = bound {
                ahead.add(column, at);
            }
        }
        ahead
    }

    /// Eight rays from row `at` on to where they are kept: built elsewhere and copied in wider pieces, they wait for the stores to be done.
    #[inline(always)]
    pub(super) fn load_to<L: Lane>(&self, at: usize, rays: &mut RayLanes<L>)
    where
        R: Stored<L>,
    {
        let (o, d, end) = (&mut rays.origin, &mut rays.direction, at + WIDTH);
        let is_short = |[x, y, z]: &[&[R]; 3]| x.len() < end || y.len() < end || z.len() < end;
        if is_short(&self.origin) || is_short(&self.direction) {
            *rays = self.load(at);
            return;
        }
        for (lane, column) in [&mut o.x, &mut o.y, &mut o.z].into_iter().zip(self.origin) {
            *lane = R::lanes(&column[at..end]);
        }
        for (lane, column) in [&mut d.x, &mut d.y, &mut d.z].into_iter().zip(self.direction) {
            *lane = R::lanes(&column[at..end]);
        }
        rays.t_min = self.t_min.load(at);
        rays.t_max = self.t_max_at(at);
    }
}

#[inline(always)]
fn load3<L: Lane, R: Stored<L>>(columns: &[&[R]; 3], at: usize) -> Vec3<L> {
    Vec3::new(load(columns[0], at), load(columns[1], at), load(columns[2], at))
}

/// Eight rows from `at` on; the last row stands in for those beyond the end.
#[inline(always)]
fn load<L: Lane, R: Stored<L>>(column: &[R], at: usize) -> L {
    if at + WIDTH <= column.len() {
        return R::lanes(&column[at..]);
    }
    load_last(column, at)
}

#[cold]
fn load_last<L: Lane, R: Stored<L>>(column: &[R], at: usize) -> L {
    L::from_fn(|i| column[(at + i).min(column.len() - 1)].lane())
}

/// Nearest hits as columns.
///
/// **Shape:** as [`RayColumns`]; `instance` may be empty where there are none. In a row whose `t` is still the ray's
/// `t_max` nothing was hit, and the other columns mean nothing.
#[derive(Debug)]
pub struct HitColumns<'a, R> {
    /// Distance in units of the direction's length.
    pub t: &'a mut [R],
    /// As in [`crate::intersect::Hit`].
    pub u: &'a mut [R],
    /// As in [`crate::intersect::Hit`].
    pub v: &'a mut [R],
    /// Which primitive.
    pub prim: &'a mut [u32],
    /// Through which instance; 0 is none.
    pub instance: &'a mut [u32],
}

impl<R: Real> HitColumns<'_, R> {
    /// Writes what eight rays from row `at` on found.
    #[inline(always)]
    pub(super) fn store<L: Lane<Scalar = R, Bits = wide::u32x8>>(&mut self, at: usize, found: &Closest<L>) {
        if at + WIDTH > self.t.len() {
            return self.store_last(at, found);
        }
        found.t.store(&mut self.t[at..]);
        found.u.store(&mut self.u[at..]);
        found.v.store(&mut self.v[at..]);
        self.prim[at..at + WIDTH].copy_from_slice(&found.prim.to_array());
        if let Some(instance) = self.instance.get_mut(at..at + WIDTH) {
            instance.copy_from_slice(&found.instance.to_array());
        }
    }

    /// The same at the end of columns without padding.
    #[cold]
    fn store_last<L: Lane<Scalar = R, Bits = wide::u32x8>>(&mut self, at: usize, found: &Closest<L>) {
        for (i, row) in (at..self.t.len()).enumerate() {
            (self.t[row], self.u[row], self.v[row]) = (found.t.get(i), found.u.get(i), found.v.get(i));
            self.prim[row] = BitLane::get(&found.prim, i);
            if let Some(instance) = self.instance.get_mut(row) {
                *instance = BitLane::get(&found.instance, i);
            }
        }
    }

    /// Writes what the ray of a row found.
    #[inline(always)]
    pub(super) fn store_one(&mut self, row: usize, found: &Closest<R>) {
        (self.t[row], self.u[row], self.v[row], self.prim[row]) = (found.t, found.u, found.v, found.prim);
        if let Some(instance) = self.instance.get_mut(row) {
            *instance = found.instance;
        }
    }
}
