//! Which settings a scene can be rendered with: only what makes a difference for it.

use super::setting::Setting;
use crate::intersect::TierName;
use crate::sampling::SamplerKind;
use crate::scene::{Scatter, Scene};

const TIERS: [TierName; 3] = [TierName::Fast, TierName::Watertight, TierName::Exact];
const SAMPLERS: [SamplerKind; 3] = [SamplerKind::Random, SamplerKind::Stratified, SamplerKind::Sobol];
const SPP: [u32; 4] = [1, 4, 16, 64];
const CUTOFFS: [f64; 3] = [1.0 / 16.0, 1.0 / 256.0, 0.0];
const SHRINKS: [u32; 2] = [2, 4];

/// All tiers, and for the scene's own tier all other choices one at a time; each with all numbers of samples, fewest first.
pub(super) fn grid(scene: &Scene) -> Vec<Setting> {
    let base = Setting::of(scene);
    let tiers = TIERS.iter().map(|&tier| Setting { tier, ..base });
    let kinds: Vec<Setting> = tiers.chain(others(scene, &base)).collect();
    let with = |spp: u32| kinds.iter().map(move |kind| Setting { spp, ..*kind });
    let mut all: Vec<Setting> = SPP.into_iter().flat_map(with).collect();
    all.sort_by(|a, b| a.samples_a_pixel().total_cmp(&b.samples_a_pixel()));
    all
}

/// The scene's own way with one thing changed.
fn others(scene: &Scene, base: &Setting) -> Vec<Setting> {
    let samplers = SAMPLERS.iter().map(|&sampler| Setting { sampler, ..*base });
    let depths = depths(scene).into_iter().map(|max_depth| Setting { max_depth, ..*base });
    let cutoffs = cutoffs(scene).iter().map(|&min_throughput| Setting { min_throughput, ..*base });
    let shrinks = SHRINKS.iter().filter(|&&by| scene.settings.size.iter().all(|side| side % by == 0));
    let shrinks = shrinks.map(|&shrink| Setting { shrink, ..*base });
    let bounces = scene.requirements.scatters(Scatter::Diffuse).then_some(Setting { bounce: false, ..*base });
    let shadows = has_shadows(scene).then_some(Setting { shadows: false, ..*base });
    let all = samplers.chain(depths).chain(cutoffs).chain(shrinks).chain(shadows).chain(bounces);
    all.filter(|setting| setting != base).collect()
}

/// The bounces that are worth asking about: none, few, half of and twice what the scene allows.
fn depths(scene: &Scene) -> Vec<u32> {
    if scene.requirements.children() == 0 {
        return Vec::new();
    }
    let most = scene.settings.max_depth;
    let mut depths = vec![0, 1, 2, most / 2, most.saturating_mul(2)];
    depths.sort_unstable();
    depths.dedup();
    depths
}

fn has_shadows(scene: &Scene) -> bool {
    scene.requirements.lights && scene.settings.shadows
}

fn cutoffs(scene: &Scene) -> &'static [f64] {
    if scene.requirements.children() == 0 { &[] } else { &CUTOFFS }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::describe::builtin;

    fn grid_of(name: &str) -> Vec<Setting> {
        grid(&Scene::compile(&builtin(name).unwrap().unwrap()).unwrap())
    }

    fn values(grid: &[Setting], field: &str) -> Vec<String> {
        let value = |s: &Setting| s.fields().into_iter().find(|(name, _)| *name == field).unwrap().1;
        let mut values: Vec<String> = grid.iter().map(value).collect();
        values.sort();
        values.dedup();
        values
    }

    #[test]
    fn a_scene_is_asked_only_about_what_it_has() {
        let (terrain, glass) = (grid_of("terrain:200"), grid_of("glass"));
        assert_eq!(values(&terrain, "tier"), ["exact", "fast", "watertight"]);
        assert_eq!(values(&terrain, "depth").len(), 1, "nothing is mirrored there");
        assert_eq!(values(&terrain, "cutoff").len(), 1);
        assert!(values(&glass, "depth").len() > 3 && values(&glass, "cutoff").len() == 4);
        assert_eq!(values(&glass, "shadows"), ["no", "yes"]);
        let amended = |name: &str, set: &str| {
            let scene = builtin(name).unwrap().unwrap().amended(name, &[set.to_owned()]).unwrap();
            grid(&Scene::compile(&scene).unwrap())
        };
        assert_eq!(values(&amended("glass", "render.shadows=false"), "shadows"), ["no"], "it wants none");
        assert_eq!(values(&amended("glass", "light={}"), "shadows"), ["yes"], "nothing casts any");
        assert_eq!(values(&glass, "bounce"), ["yes"], "no surface of it scatters");
        assert_eq!(values(&amended("cornell", "material.0.bounce=true"), "bounce"), ["no", "yes"]);
    }

    #[test]
    fn no_setting_is_there_twice_and_few_samples_come_first() {
        for name in ["seed", "glass", "terrain:200"] {
            let grid = grid_of(name);
            for (i, a) in grid.iter().enumerate() {
                assert!(!grid[..i].contains(a), "{name}: {a} twice");
            }
            assert!(grid.is_sorted_by(|a, b| a.samples_a_pixel() <= b.samples_a_pixel()));
        }
    }
}
