//! Columns of path states in a worker's arena.
//!
//! A queue has a fixed capacity, padded to the packet width, and lives until its arena is opened for the next wave.

use super::arena::Room;
use super::medium::Media;
use crate::math::{Lane, Real, Vec3, WIDTH, eight, three};

/// Three columns: a point, a direction or a colour a row.
pub(super) struct Column3<'a, R>([&'a mut [R]; 3]);

impl<'a, R: Real> Column3<'a, R> {
    pub(super) fn new(room: &Room<'a>, n: usize) -> Self {
        Self(three(|_| room.column(n)))
    }
    /// The columns from row `at` on.
    pub(super) fn rows_from(&self, at: usize) -> [&[R]; 3] {
        self.0.each_ref().map(|column| &column[at..])
    }
    /// Eight rows from `at` on.
    #[inline(always)]
    pub(super) fn load<L: Lane<Scalar = R>>(&self, at: usize) -> Vec3<L> {
        let [x, y, z] = &self.0;
        Vec3::new(L::load(&x[at..]), L::load(&y[at..]), L::load(&z[at..]))
    }
    /// The rows named by `rows`.
    #[inline(always)]
    pub(super) fn gather<L: Lane<Scalar = R>>(&self, rows: &Rows) -> Vec3<L> {
        if rows.is_run { self.load(rows.number[0] as usize) } else { self.gather_each(rows) }
    }
    /// Out of line: merged with the load, it would take that apart into single lanes, too.
    #[inline(never)]
    fn gather_each<L: Lane<Scalar = R>>(&self, rows: &Rows) -> Vec3<L> {
        let [x, y, z] = self.0.each_ref().map(|column| L::from_fn(|i| column[rows.number[i] as usize]));
        Vec3 { x, y, z }
    }
    /// Overwrites eight rows from `at` on.
    #[inline(always)]
    pub(super) fn store<L: Lane<Scalar = R>>(&mut self, at: usize, v: Vec3<L>) {
        let [x, y, z] = &mut self.0;
        v.x.store(&mut x[at..]);
        v.y.store(&mut y[at..]);
        v.z.store(&mut z[at..]);
    }
    /// Writes the chosen lanes to consecutive rows from `at` on; anything to the rows of that eight that are left.
    #[inline(always)]
    pub(super) fn compress<L: Lane<Scalar = R>>(&mut self, at: usize, v: Vec3<L>, lanes: u32) {
        if are_first(lanes) { self.store(at, v) } else { self.store_some(at, v, lanes) }
    }
    #[inline(never)]
    fn store_some<L: Lane<Scalar = R>>(&mut self, at: usize, v: Vec3<L>, lanes: u32) {
        let [x, y, z] = &mut self.0;
        for (k, i) in set_bits(lanes).enumerate() {
            (x[at + k], y[at + k], z[at + k]) = (v.x.get(i), v.y.get(i), v.z.get(i));
        }
    }
}

/// True if the chosen lanes are the first, as all are, and those of the last packet of a list: they lie as they will.
#[inline(always)]
fn are_first(lanes: u32) -> bool {
    lanes & (lanes + 1) == 0
}

/// Writes the chosen of eight entries to consecutive rows from `at` on; anything to the rows of that eight that are left.
#[inline(always)]
pub(super) fn compress_eight<T: Copy>(column: &mut [T], at: usize, entries: &[T; WIDTH], lanes: u32) {
    if are_first(lanes) { store_eight(column, at, entries) } else { store_some(column, at, entries, lanes) }
}

#[inline(never)]
fn store_some<T: Copy>(column: &mut [T], at: usize, entries: &[T; WIDTH], lanes: u32) {
    for (k, i) in set_bits(lanes).enumerate() {
        column[at + k] = entries[i];
    }
}

/// Overwrites eight rows from `at` on.
#[inline(always)]
pub(super) fn store_eight<T: Copy>(column: &mut [T], at: usize, entries: &[T; WIDTH]) {
    column[at..at + WIDTH].copy_from_slice(entries);
}

/// The numbers of the bits that are set, lowest first.
#[inline(always)]
pub(super) fn set_bits(bits: u32) -> impl Iterator<Item = usize> {
    let mut rest = bits;
    std::iter::from_fn(move || {
        let i = rest.trailing_zeros() as usize;
        rest &= rest.wrapping_sub(1);
        (i < 32).then_some(i)
    })
}

/// Eight rows of columns.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rows {
    pub(super) number: [u32; WIDTH],
    /// They follow each other, as they do where neighbours hit the same: then they load as they lie.
    is_run: bool,
}

impl Rows {
    #[inline(always)]
    pub(super) fn new(number: [u32; WIDTH]) -> Self {
        let is_run = number == eight(|i| number[0].wrapping_add(i as u32));
        Self { number, is_run }
    }
    /// The rows that lie `by` further on.
    #[inline(always)]
    pub(super) fn offset(self, by: usize) -> Self {
        Self { number: eight(|i| self.number[i] + by as u32), ..self }
    }
    /// Entries of a column.
    #[inline(always)]
    pub(super) fn of<T: Copy>(&self, column: &[T]) -> [T; WIDTH] {
        match column[self.number[0] as usize..].first_chunk() {
            Some(run) if self.is_run => *run,
            _ => self.each_of(column),
        }
    }
    #[inline(never)]
    fn each_of<T: Copy>(&self, column: &[T]) -> [T; WIDTH] {
        self.map(|row| column[row])
    }
    /// The numbers.
    #[inline(always)]
    pub(super) fn map<T>(&self, mut f: impl FnMut(usize) -> T) -> [T; WIDTH] {
        eight(|i| f(self.number[i] as usize))
    }
}

/// The rows of a column.
#[inline(always)]
pub(super) fn gather<L: Lane>(column: &[L::Scalar], rows: &Rows) -> L {
    if rows.is_run { L::load(&column[rows.number[0] as usize..]) } else { gather_each(column, rows) }
}

#[inline(never)]
fn gather_each<L: Lane>(column: &[L::Scalar], rows: &Rows) -> L {
    L::from_fn(|i| column[rows.number[i] as usize])
}

/// Words of eight rows from `at` on.
#[inline(always)]
pub(super) fn words(column: &[u32], at: usize) -> &[u32; WIDTH] {
    column[at..at + WIDTH].try_into().expect("columns are padded to the packet width")
}

/// Eight entries of a list from `at` on; the last entry stands in for those beyond the end. Also the lanes that count.
#[inline(always)]
pub(super) fn list_lanes(list: &[u32], at: usize) -> (Rows, u32) {
    let rest = &list[at..];
    if let Some(full) = rest.first_chunk::<WIDTH>() {
        return (Rows::new(*full), 0xff);
    }
    let last = rest.len() - 1;
    (Rows::new(eight(|i| rest[i.min(last)])), (1 << rest.len()) - 1)
}

/// Paths of one depth.
///
/// **Shape:** each column holds `len` rows, then padding; `t_min`, `medium` and `branch` are empty where paths need none.
pub(super) struct PathQueue<'a, R> {
    pub(super) len: usize,
    pub(super) origin: Column3<'a, R>,
    pub(super) direction: Column3<'a, R>,
    /// Hits at or before it do not count.
    pub(super) t_min: &'a mut [R],
    /// What part of the radiance along the ray reaches the pixel.
    pub(super) throughput: Column3<'a, R>,
    /// Which sample of the wave the path belongs to.
    pub(super) slot: &'a mut [u32],
    /// Dielectrics that the ray is inside of, see [`super::medium`].
    pub(super) medium: &'a mut [Media],
    /// Which split led here, for the dimensions of random numbers.
    pub(super) branch: &'a mut [u32],
}

/// Which columns beside the plain ones paths need.
#[derive(Clone, Copy, Debug)]
pub(super) struct PathNeeds {
    pub(super) medium: bool,
    pub(super) branch: bool,
    /// They are camera rays with a near plane.
    pub(super) t_min: bool,
}

impl<'a, R: Real> PathQueue<'a, R> {
    pub(super) fn new(room: &Room<'a>, capacity: usize, needs: PathNeeds) -> Self {
        let wanted = |yes: bool| if yes { capacity } else { 0 };
        Self {
            len: 0,
            origin: Column3::new(room, capacity),
            direction: Column3::new(room, capacity),
            t_min: room.column(wanted(needs.t_min)),
            throughput: Column3::new(room, capacity),
            slot: room.column(capacity),
            medium: room.column(wanted(needs.medium)),
            branch: room.column(wanted(needs.branch)),
        }
    }

    /// Appends the paths of a queue with the same needs.
    pub(super) fn append(&mut self, more: &PathQueue<R>) {
        fn copy<T: Copy>(to: &mut [T], at: usize, from: &[T], n: usize) {
            if !to.is_empty() {
                to[at..at + n].copy_from_slice(&from[..n]);
            }
        }
        let (at, n) = (self.len, more.len);
        let columns = [(&mut self.origin, &more.origin), (&mut self.direction, &more.direction)];
        for (to, from) in columns.into_iter().chain([(&mut self.throughput, &more.throughput)]) {
            to.0.iter_mut().zip(&from.0).for_each(|(to, from)| copy(to, at, from, n));
        }
        copy(self.slot, at, more.slot, n);
        copy(self.medium, at, more.medium, n);
        copy(self.branch, at, more.branch, n);
        self.len += n;
    }

    /// Appends the chosen lanes.
    #[inline(always)]
    pub(super) fn push<L: Lane<Scalar = R>>(&mut self, paths: &PathLanes<L>, lanes: u32) {
        let at = self.len;
        self.origin.compress(at, paths.origin, lanes);
        self.direction.compress(at, paths.direction, lanes);
        self.throughput.compress(at, paths.throughput, lanes);
        compress_eight(self.slot, at, &paths.slot, lanes);
        if !self.medium.is_empty() {
            compress_eight(self.medium, at, &paths.medium, lanes);
        }
        if !self.branch.is_empty() {
            compress_eight(self.branch, at, &paths.branch, lanes);
        }
        self.len += lanes.count_ones() as usize;
    }
}

/// Paths as lanes, on their way into a queue.
pub(super) struct PathLanes<L> {
    pub(super) origin: Vec3<L>,
    pub(super) direction: Vec3<L>,
    pub(super) throughput: Vec3<L>,
    pub(super) slot: [u32; WIDTH],
    pub(super) medium: [Media; WIDTH],
    pub(super) branch: [u32; WIDTH],
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::wavefront::arena::Arena;

    #[test]
    fn compress_keeps_the_order_of_lanes() {
        let mut arena = Arena::default();
        let mut columns = Column3::new(&arena.open(), 16);
        let v = wide::f32x8::new([0., 1., 2., 3., 4., 5., 6., 7.]);
        columns.compress(3, Vec3 { x: v, y: -v, z: v }, 0b1010_0110);
        let [x, y, _] = columns.rows_from(3);
        assert_eq!((&x[..4], y[3], x[4]), (&[1.0, 2.0, 5.0, 7.0][..], -7.0, 0.0));
        let mut words = [0; 16];
        compress_eight(&mut words, 3, &eight(|i| i as u32), 0b1010_0110);
        assert_eq!(words[3..8], [1, 2, 5, 7, 0]);
    }

    #[test]
    fn the_last_entry_stands_in_beyond_a_list() {
        let eight = |list: &[u32]| {
            let (rows, lanes) = list_lanes(list, 0);
            (rows.number, rows.is_run, lanes)
        };
        assert_eq!(eight(&[4, 9, 2]), ([4, 9, 2, 2, 2, 2, 2, 2], false, 0b111));
        assert_eq!(eight(&[2, 3, 4, 5, 6, 7, 8, 9, 1]), ([2, 3, 4, 5, 6, 7, 8, 9], true, 0xff));
    }
}
