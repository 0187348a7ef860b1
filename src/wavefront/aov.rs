//! Values beside colour: the surface that the centre of each pixel sees.

use super::extend::{KINDS, extend};
use super::generate::generate_centres;
use super::queue::{list_lanes, set_bits};
use super::run::Arenas;
use super::surface::{HitLanes, SurfaceLanes, evaluate};
use super::surface_queue::{facing, gather_hits, materials_of, texture_color};
use super::wave::Worker;
use crate::film::{Aov, AovSample};
use crate::geometry::gather3;
use crate::intersect::{PrimKind, Tier};
use crate::math::{Lane, Real, Vec3, WIDTH};
use crate::scene::Scene;

/// Looks through the centres of the pixels of one tile: a sample for each, in the same order.
pub(super) fn look<T: Tier>(
    worker: &mut Worker<T>,
    pixels: &[[u32; 2]],
    arenas: &mut Arenas,
    seen: &mut Vec<AovSample>,
) {
    seen.clear();
    seen.resize(pixels.len(), AovSample::default());
    let [arena, below, ..] = arenas else { unreachable!("arenas for camera rays and for their hits") };
    let scene = worker.frame.scene;
    let paths = generate_centres::<T>(worker.frame, pixels, &arena.open());
    worker.rays.camera += paths.len as u64;
    let hits = extend(worker, &paths, (0, paths.len), worker.frame.apex, &below.open());
    for (kind, list) in KINDS.into_iter().zip(&hits.by_kind) {
        for at in (0..list.len()).step_by(WIDTH) {
            let (rows, lanes) = list_lanes(list, at);
            let hit = gather_hits::<T::Wide>(&paths, &rows, &hits, &rows);
            let surface = evaluate(&scene.geometry, kind, &hit);
            let looked = Looked::new(scene, kind, &hit, &surface);
            for i in set_bits(lanes) {
                let row = rows.number[i] as usize;
                seen[row] = looked.sample(scene, hits.prim[row], i);
            }
        }
    }
}

/// Eight surfaces with what is shown of them.
struct Looked<'a, L: Lane> {
    kind: PrimKind,
    hit: &'a HitLanes<L>,
    surface: &'a SurfaceLanes<L>,
    normals: [Vec3<L>; 2],
    materials: [u32; WIDTH],
    albedo: Vec3<L>,
}

impl<'a, L: Lane> Looked<'a, L> {
    fn new(scene: &Scene, kind: PrimKind, hit: &'a HitLanes<L>, surface: &'a SurfaceLanes<L>) -> Self {
        let materials = materials_of(scene, kind, hit);
        let albedo = match scene.settings.aovs.has(Aov::Albedo) {
            true => albedo(scene, &materials, surface.uv),
            false => Vec3::splat_f32([0.0; 3]),
        };
        Self { kind, hit, surface, normals: facing(hit, surface), materials, albedo }
    }

    fn sample(&self, scene: &Scene, primitive: u32, i: usize) -> AovSample {
        let [geometric_normal, shading_normal] = self.normals.map(|n| lane(n, i));
        let position = lane(self.surface.point, i);
        AovSample {
            depth: depth(scene, position),
            position,
            geometric_normal,
            shading_normal,
            uv: [self.surface.uv.0.get(i).to_f32(), self.surface.uv.1.get(i).to_f32()],
            albedo: lane(self.albedo, i),
            object: match self.hit.instance[i] {
                0 => scene.objects.object(self.kind, self.hit.row[i]),
                instance => scene.geometry.instances[instance as usize - 1].object,
            },
            primitive,
            material: scene.materials.id[self.materials[i] as usize],
            hit: true,
        }
    }
}

fn albedo<L: Lane>(scene: &Scene, materials: &[u32; WIDTH], uv: (L, L)) -> Vec3<L> {
    let plain = gather3::<L>(&scene.materials.diffuse, materials);
    if scene.requirements.textures { plain.scale(texture_color(scene, materials, uv)) } else { plain }
}

fn lane<L: Lane>(v: Vec3<L>, i: usize) -> [f32; 3] {
    [v.x, v.y, v.z].map(|x| x.get(i).to_f32())
}

/// Distance along the view axis.
fn depth(scene: &Scene, point: [f32; 3]) -> f32 {
    let camera = &scene.camera;
    let along = |k: usize| (f64::from(point[k]) - camera.position[k]) * camera.forward[k];
    (along(0) + along(1) + along(2)) as f32
}
