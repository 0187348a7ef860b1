//! Bounds hold, and those who break them are found.

use super::*;
use crate::intersect::{Ray, TierName};

const TIERS: [TierName; 3] = [TierName::Fast, TierName::Watertight, TierName::Exact];

fn reports(family: &Family, rays: usize) -> Vec<FamilyReport> {
    verify_family(family, &TIERS, Effort { rays, seed: 3 })
}

/// The bounds of all tiers over all families; one test a group, so that the name tells what broke.
fn hold(names: &[&str]) {
    for name in names {
        let family = Family::named(name).unwrap_or_else(|| panic!("no family {name}"));
        for report in reports(family, 6_000) {
            assert!(report.breaches().is_empty(), "{:#?}", report.breaches());
            assert!(report.rays > 3_000, "{name}: {} rays", report.rays);
        }
    }
}

#[test]
fn closed_meshes_do_not_leak() {
    hold(&["closed-inside", "closed-outside", "along-edges", "leaks"]);
}

#[test]
fn triangles_keep_their_bounds() {
    hold(&["triangles", "triangle-edges", "slivers", "any-magnitude", "on-faces", "coplanar"]);
}

#[test]
fn spheres_keep_their_bounds() {
    hold(&["spheres", "moderate-spheres", "tangent", "ground", "touching"]);
}

#[test]
fn cylinders_keep_their_bounds() {
    hold(&["cylinders", "rims", "rims-inside", "wires", "coins", "along-axes"]);
}

#[test]
fn rays_that_start_on_curved_surfaces_keep_their_bounds() {
    hold(&["on-curved"]);
}

#[test]
fn boxes_cull_no_hit() {
    hold(&["boxes", "box-planes"]);
}

#[test]
fn mixed_scenes_keep_their_bounds() {
    hold(&["far", "axis-parallel", "lengths", "moderate-lengths", "odd-lengths", "t-max", "mixed"]);
}

#[test]
fn rays_that_leave_surfaces_do_not_hit_them() {
    hold(&["leaving", "thin-shells"]);
}

#[test]
fn paths_through_spheres_of_glass_do_not_stray() {
    hold(&["glass-chain", "glass-touching", "glass-far", "glass-shells", "critical-angle"]);
}

#[test]
fn paths_through_solids_of_glass_do_not_stray() {
    hold(&["glass-solids"]);
}

#[test]
fn rays_that_leave_instances_do_not_hit_them() {
    hold(&["leaving-instances"]);
}

/// A family that no test names would not be held to its bounds.
#[test]
fn every_family_is_held_to_its_bounds() {
    let source = include_str!("tests.rs");
    for family in Family::all() {
        assert!(source.contains(&format!("\"{}\"", family.name)), "{}", family.name);
    }
}

#[test]
fn the_faults_of_the_fast_tier_are_found() {
    let fast = |name: &str| reports(Family::named(name).unwrap(), 3_000).remove(0);
    for (family, fault) in [
        ("closed-inside", "leak"),
        ("closed-outside", "leak"),
        ("triangle-edges", "false miss"),
        ("spheres", "gross miss"),
        ("lengths", "gross miss"),
        ("t-max", "false hit"),
        ("leaving", "self-hit"),
    ] {
        let report = if family == "leaving" {
            verify_family(Family::named(family).unwrap(), &TIERS[..1], Effort { rays: 60_000, seed: 3 })
                .remove(0)
        } else {
            fast(family)
        };
        assert!(report.rate(fault).unwrap().count > 0, "{family}: no {fault}");
    }
}

#[test]
fn a_seed_gives_the_same_numbers_with_any_threads() {
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| reports(Family::named("slivers").unwrap(), 1_000))
    };
    assert_eq!(run(1), run(3));
    let other = verify_family(Family::named("slivers").unwrap(), &TIERS, Effort { rays: 1_000, seed: 4 });
    assert_ne!(run(1), other);
}

#[test]
fn families_have_a_name_each_and_hit_and_miss() {
    let mut names: Vec<&str> = Family::all().map(|family| family.name).collect();
    names.sort_unstable();
    assert!(names.windows(2).all(|pair| pair[0] != pair[1]));
    for family in Family::all().filter(|family| family.trial(1, 0).is_some()) {
        let exact = verify_family(family, &[TierName::Exact], Effort { rays: 2_000, seed: 1 }).remove(0);
        assert!(exact.hits * 20 > exact.rays, "{}: {} of {}", family.name, exact.hits, exact.rays);
    }
}

/// Answers everything as octray's exact tier does, but for one kind of fault.
struct Liar(fn(Option<f64>, &Ray) -> Option<f64>);

impl Intersector for Liar {
    type Scene = Vec<crate::intersect::oracle::Shape>;

    fn build(&self, shapes: &[Shape]) -> Option<Self::Scene> {
        Some(shapes.iter().map(Shape::exact).collect())
    }

    fn nearest(&self, scene: &Self::Scene, ray: &Ray) -> Option<f32> {
        use crate::intersect::oracle::{Line, nearest};
        let counts = |t: f64| t as f32 > ray.t_min && (t as f32) < ray.t_max;
        self.0(nearest(&Line::of(ray), scene, counts).map(|hit| hit.1), ray).map(|t| t as f32)
    }
}

fn verify_liar(lie: fn(Option<f64>, &Ray) -> Option<f64>, family: &str) -> FamilyReport {
    let bounds = Promise::Closed.bounds(TierName::Exact);
    let effort = Effort { rays: 500, seed: 1 };
    verify_intersector("liar", &Liar(lie), Family::named(family).unwrap(), &bounds, effort).unwrap()
}

#[test]
fn each_kind_of_fault_is_told() {
    let honest = verify_liar(|t, _| t, "closed-inside");
    assert!(honest.holds && honest.breaches().is_empty(), "{honest:?}");
    let told = |lie, family, what: &str| {
        let report = verify_liar(lie, family);
        assert!(!report.holds && report.breaches().iter().any(|b| b.contains(what)), "{what}: {report:?}");
    };
    told(|_, _| None, "closed-inside", "leak");
    told(|_, _| None, "closed-outside", "leak");
    told(|_, _| None, "closed-inside", "gross miss");
    told(|_, _| None, "triangles", "false miss");
    told(|t, _| t.or(Some(1.0)), "triangles", "gross hit");
    told(|t, _| t.map(|t| 1.001 * t), "triangles", "gross hit");
    told(|t, _| t.map(|t| t * (1.0 + 1e-7)), "triangles", "t is off");
}

/// Families ask any intersector; a shape it does not know is left out.
#[test]
fn unknown_shapes_are_left_out() {
    struct Blind;
    impl Intersector for Blind {
        type Scene = ();
        fn build(&self, _: &[Shape]) -> Option<()> {
            None
        }
        fn nearest(&self, (): &(), _: &Ray) -> Option<f32> {
            None
        }
    }
    let (bounds, effort) = (Bounds::default(), Effort { rays: 50, seed: 1 });
    assert!(
        Family::all().all(|family| verify_intersector("blind", &Blind, family, &bounds, effort).is_none())
    );
}

mod strategies {
    use proptest::prelude::*;

    use super::super::strategies::trials;
    use super::*;

    proptest! {
        #[test]
        fn trials_have_shapes_and_usable_rays(trial in trials(Family::named("mixed").unwrap())) {
            prop_assert_eq!(trial.shapes.len(), 12);
            prop_assert!(trial.rays.iter().all(|ray| ray.direction != [0.0; 3]));
        }
    }
}
