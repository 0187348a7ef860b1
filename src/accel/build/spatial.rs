//! The binary tree with spatial splits: in long ranges, where boxes overlap, triangles are cut; below, [`super::binary`].
//!
//! **Source:** Stich, Friedrich and Dietrich, "Spatial Splits in Bounding Volume Hierarchies", 2009. Changed: a budget
//! bounds the references that cuts may add; the halves of a range share what is left by their lengths.

use rayon::prelude::*;
use wide::f64x4;

use super::binary::{self, BinaryNode};
use super::bins::best_cut_and_overlap;
use super::box8::Box8;
use super::cut::Cuttable;
use super::item::{Extent, Item, Parted};
use super::slab::{Parts, best_slab};
use super::split::{halvings, part_by};
use super::{MAX_DEPTH, Quality};

/// Cutting is tried where the halves of the best split without it overlap by more than this share of the whole tree. With 1e-4
/// trees take up to 40% longer to build and rays visit no less of them.
const LEAST_OVERLAP: f64 = 1e-3;
/// And in ranges of at least so many items.
const LEAST_ITEMS: usize = 32;
/// A split must cost so many times the plane that cuts. Where planes that gain less cut as well, camera rays are up to 7%
/// fewer a second through halls and 8% around statues.
const WORTH: f64 = 1.1;

/// For [`Quality::Balanced`] only the whole is parted by a plane that cuts, and only where an item is so large a share of it,
/// as walls and floors are: camera and shadow rays through a living room are 1.13 and 1.19 times as many a second for it;
/// looking at halves and quarters too brings no more. Items of statues, hair and terrain are at most 0.0013.
const LARGE: f64 = 0.01;

/// Ranges from this length on are shared by two tasks.
const GRAIN: usize = 1 << 12;

/// Nodes and items of a subtree, depth-first.
#[derive(Default)]
struct Grown {
    nodes: Vec<BinaryNode>,
    items: Vec<Item>,
}

/// True if an item is large for the whole.
fn has_large(items: &[Item], extent: &Extent) -> bool {
    let large = LARGE * extent.bounds.half_area();
    let four = |items: &[Item]| Box8::half_areas([0, 1, 2, 3].map(|i| items[i.min(items.len() - 1)].bounds));
    items
        .par_chunks(GRAIN)
        .any(|items| items.chunks(4).any(|items| four(items).simd_gt(f64x4::splat(large)).any()))
}

/// The nodes over all items, of which there are some, and the items in the order of the leaves: the whole may be parted by a
/// plane that cuts, to which `budget` references may be added.
pub(super) fn grow_balanced(
    mut items: Vec<Item>,
    budget: usize,
    triangles: &impl Cuttable,
) -> (Vec<BinaryNode>, Vec<Item>) {
    let (quality, extent) = (Quality::Balanced, Extent::of(&items));
    if items.len() < LEAST_ITEMS || !has_large(&items, &extent) {
        let nodes = binary::grow(&mut items, &extent, quality);
        return (nodes, items);
    }
    let parted = match Grower::new(&extent, quality, triangles).part(&mut items, &extent, budget) {
        Sides::InPlace(parted) => parted,
        Sides::Apart([low, mut high]) => {
            let middle = low.len();
            items = low;
            items.append(&mut high);
            Parted::at(&items, middle)
        }
    };
    let nodes = binary::grow_parted(&mut items, &extent, parted, quality);
    (nodes, items)
}

/// The nodes over all items, of which there are some, and the items in the order of the leaves; `budget` references may be
/// added.
pub(super) fn grow(
    items: Vec<Item>,
    budget: usize,
    triangles: &impl Cuttable,
) -> (Vec<BinaryNode>, Vec<Item>) {
    let grower = Grower::new(&Extent::of(&items), Quality::High, triangles);
    let mut grown = grower.grow(items, budget, 0);
    binary::number(&mut grown.nodes);
    (grown.nodes, grown.items)
}

struct Grower<'a, C> {
    triangles: &'a C,
    quality: Quality,
    least_overlap: f64,
}

/// A range that was parted: as it stood, or in two.
enum Sides {
    InPlace(Parted),
    Apart([Vec<Item>; 2]),
}

impl<'a, C> Grower<'a, C> {
    fn new(whole: &Extent, quality: Quality, triangles: &'a C) -> Self {
        Self { triangles, quality, least_overlap: LEAST_OVERLAP * whole.bounds.half_area() }
    }
}

impl<C: Cuttable> Grower<'_, C> {
    fn grow(&self, items: Vec<Item>, budget: usize, depth: u32) -> Grown {
        let mut grown = Grown::default();
        self.grow_onto(&mut grown, items, budget, depth);
        grown
    }

    fn grow_onto(&self, grown: &mut Grown, mut items: Vec<Item>, budget: usize, depth: u32) {
        // Enough levels must remain for halving, also of what is added.
        let deep = depth + halvings(items.len() + budget) + 1 >= MAX_DEPTH;
        if items.len() < LEAST_ITEMS || budget == 0 || deep {
            binary::grow_onto(&mut grown.nodes, &mut items, depth, self.quality);
            grown.items.append(&mut items);
            return;
        }
        let extent = Extent::of(&items);
        let at = grown.nodes.len();
        grown.nodes.push(BinaryNode::leaf(&extent, 0, items.len()));
        let [low, high] = match self.part(&mut items, &extent, budget) {
            Sides::Apart(sides) => sides,
            Sides::InPlace(Parted { middle, .. }) => {
                let high = items.split_off(middle);
                [items, high]
            }
        };
        let len = low.len() + high.len();
        let left = budget.saturating_sub(len - grown.nodes[at].len as usize);
        let share = (left as u128 * low.len() as u128 / len as u128) as usize;
        let shares = [share, left - share];
        if len > GRAIN {
            let (low, high) = rayon::join(
                || self.grow(low, shares[0], depth + 1),
                || self.grow(high, shares[1], depth + 1),
            );
            grown.append(low);
            grown.nodes[at].right = (grown.nodes.len() - at) as u32;
            grown.append(high);
        } else {
            self.grow_onto(grown, low, shares[0], depth + 1);
            grown.nodes[at].right = (grown.nodes.len() - at) as u32;
            self.grow_onto(grown, high, shares[1], depth + 1);
        }
    }

    /// The two sides of a range: by a plane that cuts if that is cheaper and within the budget.
    fn part(&self, items: &mut [Item], extent: &Extent, budget: usize) -> Sides {
        let (cut, overlap) = best_cut_and_overlap(items, extent);
        let worth = cut.filter(|_| overlap > self.least_overlap);
        match worth.and_then(|cut| self.part_space(items, extent, budget, cut.cost)) {
            Some(sides) => Sides::Apart(sides),
            None => Sides::InPlace(part_by(items, extent, cut)),
        }
    }

    /// The two sides of a plane that cuts what crosses it, for less than `beaten` and within the budget.
    fn part_space(
        &self,
        items: &[Item],
        extent: &Extent,
        budget: usize,
        beaten: f64,
    ) -> Option<[Vec<Item>; 2]> {
        let parts = if self.quality == Quality::High { Parts::Triangles } else { Parts::Boxes };
        let slab = best_slab(items, extent, parts, self.triangles)?;
        if WORTH * slab.cost >= beaten || slab.extra(items.len()) > budget {
            return None;
        }
        let sides = slab.part(items, self.triangles);
        let len = sides[0].len() + sides[1].len();
        let sound = sides.iter().all(|side| !side.is_empty()) && len <= items.len() + budget;
        sound.then_some(sides)
    }
}

impl Grown {
    fn append(&mut self, mut o: Self) {
        self.nodes.append(&mut o.nodes);
        self.items.append(&mut o.items);
    }
}
