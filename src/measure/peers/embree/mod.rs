//! Embree 4, loaded at run time: two build qualities, three ways to ask.
//!
//! The tiers meet their like: `fast` its default scenes, `watertight` and `exact` those with the robust flag.

mod ffi;
mod layout;
mod scene;

use std::path::{Path, PathBuf};
use std::sync::Arc;

use ffi::Scene;
use layout::{COHERENT, NO_GEOMETRY, QueryArguments, Ray, Ray8, RayHit, RayHit8, Valid8};
use scene::Numbers;

use crate::intersect::TierName;
use crate::math::WIDTH;
use crate::measure::bench::{Engine, HitColumns, PeerScene, RayColumns, Subject};

pub(super) const NAME: &str = "embree";

/// A loaded Embree.
pub(super) struct Embree(ffi::Embree);

impl Embree {
    /// Loads the library at a path, or in a folder, together with the TBB beside it. **Errors:** in words.
    pub(super) fn load(path: &Path) -> Result<Self, String> {
        let library = if path.is_dir() { find(path, "libembree4")? } else { path.to_owned() };
        let tbb = library.parent().and_then(|folder| find(folder, "libtbb").ok());
        let libraries: Vec<&Path> = tbb.iter().chain([&library]).map(PathBuf::as_path).collect();
        ffi::Embree::load(&libraries).map(Self)
    }

    /// A scene in both build qualities, each with all ways to ask it. **Errors:** in words.
    pub(super) fn scenes(
        &self,
        subject: &Subject,
        tier: TierName,
        threads: usize,
    ) -> Result<Vec<PeerScene>, String> {
        let flags = if tier == TierName::Fast { 0 } else { layout::ROBUST };
        [("medium", 1), ("high", 2)]
            .into_iter()
            .map(|(name, quality)| {
                let quality = scene::Quality { name, quality, flags };
                let (scene, numbers, build) = scene::build(&self.0, subject, &quality, threads)?;
                let scene = Arc::new(scene);
                let engine = |way| {
                    Box::new(EmbreeEngine {
                        scene: scene.clone(),
                        quality: name,
                        way,
                        numbers: numbers.clone(),
                    }) as Box<dyn Engine>
                };
                Ok(PeerScene { build, engines: Way::ALL.map(engine).into() })
            })
            .collect()
    }
}

/// The first file in a folder, or in `embree*.libs` below it, whose name starts so.
fn find(folder: &Path, start: &str) -> Result<PathBuf, String> {
    let list = |folder: &Path| -> Vec<PathBuf> {
        let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
        let mut paths: Vec<PathBuf> = entries.map(|entry| entry.path()).collect();
        paths.sort();
        paths
    };
    let starts = |path: &&PathBuf, start: &str| {
        path.file_name().is_some_and(|name| name.to_string_lossy().starts_with(start))
    };
    let here = list(folder);
    let below =
        here.iter().filter(|path| path.extension().is_some_and(|e| e == "libs")).flat_map(|p| list(p));
    let all: Vec<PathBuf> = here.iter().cloned().chain(below).collect();
    let found = all.iter().find(|path| starts(path, start) && path.to_string_lossy().contains(".so"));
    found.cloned().ok_or_else(|| format!("{}: holds no {start}*.so*", folder.display()))
}

/// How rays are handed over.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Way {
    One,
    Eight,
    EightCoherent,
}

impl Way {
    const ALL: [Self; 3] = [Self::One, Self::Eight, Self::EightCoherent];

    fn name(self) -> &'static str {
        ["1", "8", "8 coherent"][self as usize]
    }
    fn arguments(self) -> QueryArguments {
        QueryArguments::new(if self == Self::EightCoherent { COHERENT } else { 0 })
    }
}

struct EmbreeEngine {
    scene: Arc<Scene>,
    quality: &'static str,
    way: Way,
    numbers: Numbers,
}

impl Engine for EmbreeEngine {
    fn name(&self) -> &'static str {
        NAME
    }
    fn mode(&self) -> String {
        format!("{}, {}", self.quality, self.way.name())
    }
    fn closest(&self, rays: RayColumns<'_>, hits: HitColumns<'_>) {
        match self.way {
            Way::One => self.closest_one(rays, hits),
            _ => self.closest_eight(rays, hits),
        }
    }
    fn any(&self, rays: RayColumns<'_>, occluded: &mut [bool]) {
        match self.way {
            Way::One => self.any_one(rays, occluded),
            _ => self.any_eight(rays, occluded),
        }
    }
}

impl EmbreeEngine {
    fn closest_one(&self, rays: RayColumns<'_>, hits: HitColumns<'_>) {
        let mut arguments = self.way.arguments();
        let mut asked = RayHit::default();
        for i in 0..rays.len() {
            asked.ray = one(&rays, i);
            asked.hit.geometry = NO_GEOMETRY;
            asked.hit.instance = NO_GEOMETRY;
            self.scene.intersect1(&mut asked, &mut arguments);
            hits.t[i] = asked.ray.t_far;
            hits.prim[i] = self.numbers.id(asked.hit.instance, asked.hit.geometry, asked.hit.prim);
        }
    }

    fn closest_eight(&self, rays: RayColumns<'_>, mut hits: HitColumns<'_>) {
        let mut arguments = self.way.arguments();
        let mut asked = RayHit8::default();
        for first in (0..rays.len()).step_by(WIDTH) {
            asked.ray = eight(&rays, first);
            asked.hit.geometry = [NO_GEOMETRY; WIDTH];
            asked.hit.instance = [NO_GEOMETRY; WIDTH];
            self.scene.intersect8(&valid(rays.len() - first), &mut asked, &mut arguments);
            let hit = &asked.hit;
            let ids = std::array::from_fn(|i| self.numbers.id(hit.instance[i], hit.geometry[i], hit.prim[i]));
            hits.put_eight(first, asked.ray.t_far, ids);
        }
    }

    fn any_one(&self, rays: RayColumns<'_>, occluded: &mut [bool]) {
        let mut arguments = self.way.arguments();
        for (i, occluded) in occluded.iter_mut().enumerate() {
            let mut ray = one(&rays, i);
            self.scene.occluded1(&mut ray, &mut arguments);
            *occluded = ray.t_far < 0.0;
        }
    }

    fn any_eight(&self, rays: RayColumns<'_>, occluded: &mut [bool]) {
        let mut arguments = self.way.arguments();
        for (packet, occluded) in occluded.chunks_mut(WIDTH).enumerate() {
            let mut asked = eight(&rays, packet * WIDTH);
            self.scene.occluded8(&valid(occluded.len()), &mut asked, &mut arguments);
            for (occluded, t_far) in occluded.iter_mut().zip(asked.t_far) {
                *occluded = t_far < 0.0;
            }
        }
    }
}

#[inline(always)]
fn one(rays: &RayColumns<'_>, i: usize) -> Ray {
    let [origin, direction] = rays.ray(i);
    let (t_near, t_far) = (rays.t_min[i], rays.t_max[i]);
    Ray { origin, direction, t_near, t_far, mask: u32::MAX, ..Ray::default() }
}

#[inline(always)]
fn eight(rays: &RayColumns<'_>, first: usize) -> Ray8 {
    let column = |column: &[f32]| RayColumns::eight(column, first);
    Ray8 {
        origin: rays.origin.map(column),
        direction: rays.direction.map(column),
        t_near: column(rays.t_min),
        t_far: column(rays.t_max),
        mask: [u32::MAX; WIDTH],
        ..Ray8::default()
    }
}

#[inline(always)]
fn valid(left: usize) -> Valid8 {
    if left >= WIDTH { Valid8([-1; WIDTH]) } else { Valid8(std::array::from_fn(|i| -i32::from(i < left))) }
}
