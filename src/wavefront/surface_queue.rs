//! Surfaces that paths met, evaluated: what lights and secondary rays are computed from.

use wide::f32x8;

use super::arena::{List, Room, padded};
use super::contact::Met;
use super::extend::{Hits, KINDS};
use super::queue::{Column3, PathQueue, Rows, gather, list_lanes, store_eight, words};
use super::surface::{HitLanes, SurfaceLanes};
use crate::geometry::{NO_MATERIAL, entries, gather3};
use crate::intersect::{PrimId, PrimKind};
use crate::math::{Lane, Mask, Real, Vec3, WIDTH, eight, three};
use crate::scene::{NO_TEXTURE, Requirements, Scatter, Scene, sample_eight, sample_texture};

/// One row for each path that hit something, in the order of primitive kinds.
///
/// **Shape:** padded columns; in the padding stands anything, but for rows of other columns, which are there.
pub(super) struct SurfaceQueue<'a, R> {
    pub(super) len: usize,
    pub(super) point: Column3<'a, R>,
    pub(super) error: &'a mut [R],
    /// Both normals on the side that the path came from; the second is none where the scene has no normals of its own.
    pub(super) geometric_normal: Column3<'a, R>,
    shading_normal: Option<Column3<'a, R>>,
    pub(super) direction: Column3<'a, R>,
    pub(super) throughput: Column3<'a, R>,
    /// Diffuse coefficient after textures; empty where the scene has none, and the material's counts.
    diffuse: Option<Column3<'a, R>>,
    pub(super) slot: &'a mut [u32],
    pub(super) material: &'a mut [u32],
    /// Rows of the path queue.
    pub(super) path: &'a mut [u32],
    /// 1 where the path came from inside, against the outward normal.
    pub(super) from_inside: &'a mut [u32],
    /// What the surface bounds, see [`super::medium`]; empty where the scene has no dielectrics.
    pub(super) body: &'a mut [u32],
    /// Rows by what becomes of rays there; empty where nothing does, whatever the materials are.
    pub(super) by_scatter: [List<'a>; 4],
    is_sorted: bool,
}

impl<'a, R: Real> SurfaceQueue<'a, R> {
    fn new(room: &Room<'a>, capacity: usize, needs: &Requirements) -> Self {
        // Each kind of primitive may end in a packet that is not full.
        let n = capacity + WIDTH;
        let is_sorted = needs.children() > 0;
        let listed = if is_sorted { capacity } else { 0 };
        let list = || room.list(listed);
        Self {
            len: 0,
            point: Column3::new(room, n),
            error: room.column(n),
            geometric_normal: Column3::new(room, n),
            shading_normal: needs.shading_normals.then(|| Column3::new(room, n)),
            direction: Column3::new(room, n),
            throughput: Column3::new(room, n),
            diffuse: needs.textures.then(|| Column3::new(room, n)),
            slot: room.column(n),
            material: room.column(n),
            path: room.column(n),
            from_inside: room.column(n),
            body: room.column(if needs.scatters(Scatter::Dielectric) { n } else { 0 }),
            by_scatter: [list(), list(), list(), list()],
            is_sorted,
        }
    }

    /// Evaluates all hits of a chunk of paths.
    pub(super) fn evaluate<L: Lane<Scalar = R>>(
        scene: &Scene,
        queue: &PathQueue<R>,
        first: usize,
        hits: &Hits<R>,
        room: &Room<'a>,
    ) -> Self {
        let capacity = hits.by_kind.iter().map(|list| list.len()).sum();
        let mut surfaces = Self::new(room, capacity, &scene.requirements);
        for (kind, list) in KINDS.into_iter().zip(&hits.by_kind) {
            for at in (0..list.len()).step_by(WIDTH) {
                let (rows, lanes) = list_lanes(list, at);
                let paths = rows.offset(first);
                let hit = gather_hits::<L>(queue, &paths, hits, &rows);
                let met = Met::new(scene, kind, &hit, queue.medium, &paths);
                surfaces.push(scene, queue, hit.direction, &met, &paths);
                surfaces.sort_by_scatter(&met.scatter, lanes.count_ones() as usize);
            }
        }
        let padding = surfaces.len..padded(surfaces.len);
        surfaces.material[padding.clone()].fill(0);
        surfaces.slot[padding].fill(0);
        surfaces
    }

    /// Writes eight rows; how many of them count is up to the caller.
    #[inline(always)]
    fn push<L: Lane<Scalar = R>>(
        &mut self,
        scene: &Scene,
        queue: &PathQueue<R>,
        direction: Vec3<L>,
        met: &Met<L>,
        paths: &Rows,
    ) {
        let at = self.len;
        let Met { surface, materials, inside, bodies, .. } = met;
        let facing = |n: Vec3<L>| Vec3::select(*inside, -n, n);
        let geometric_normal = facing(surface.geometric_normal);
        self.point.store(at, surface.point);
        surface.error.store(&mut self.error[at..]);
        self.geometric_normal.store(at, geometric_normal);
        if let Some(normal) = &mut self.shading_normal {
            normal.store(at, towards(facing(surface.shading_normal), geometric_normal, direction));
        }
        self.direction.store(at, direction);
        self.throughput.store(at, queue.throughput.gather::<L>(paths));
        if let Some(diffuse) = &mut self.diffuse {
            let plain = gather3::<L>(&scene.materials.diffuse, materials);
            diffuse.store(at, plain.scale(texture_color(scene, materials, surface.uv)));
        }
        store_eight(self.slot, at, &paths.of(queue.slot));
        store_eight(self.material, at, materials);
        store_eight(self.path, at, &paths.number);
        let inside = inside.bits();
        store_eight(self.from_inside, at, &eight(|i| inside >> i & 1));
        if !self.body.is_empty() {
            store_eight(self.body, at, bodies);
        }
    }

    /// Keeps so many of the rows just written, and notes those whose material sends rays on.
    #[inline(always)]
    fn sort_by_scatter(&mut self, scatter: &[Scatter; WIDTH], count: usize) {
        let len = self.len as u32;
        self.len += count;
        if !self.is_sorted {
            return;
        }
        if *scatter == [scatter[0]; WIDTH] {
            if scatter[0] != Scatter::Absorb {
                self.by_scatter[scatter[0] as usize].extend(&eight(|k| len + k as u32), count);
            }
            return;
        }
        for (row, &scatter) in (len..).zip(scatter.iter().take(count)) {
            if scatter != Scatter::Absorb {
                self.by_scatter[scatter as usize].push(row);
            }
        }
    }

    /// The lanes from `at` on that hold rows.
    pub(super) fn lanes(&self, at: usize) -> u32 {
        let count = (self.len - at).min(WIDTH);
        ((1u64 << count) - 1) as u32
    }
    /// Slots of eight rows.
    pub(super) fn slots(&self, at: usize) -> &[u32; WIDTH] {
        words(self.slot, at)
    }
    /// Material rows of eight rows.
    pub(super) fn materials(&self, at: usize) -> &[u32; WIDTH] {
        words(self.material, at)
    }
    /// Slot of a row.
    pub(super) fn slot(&self, row: usize) -> u32 {
        self.slot[row]
    }
    /// Shading normals, by row.
    pub(super) fn shading_normal(&self) -> &Column3<'a, R> {
        self.shading_normal.as_ref().unwrap_or(&self.geometric_normal)
    }
    /// Diffuse coefficients of eight rows.
    #[inline(always)]
    pub(super) fn diffuse<L: Lane<Scalar = R>>(&self, scene: &Scene, at: usize) -> Vec3<L> {
        match &self.diffuse {
            Some(diffuse) => diffuse.load(at),
            None => gather3(&scene.materials.diffuse, self.materials(at)),
        }
    }
}

/// The lanes whose rays come from inside, against the outward normal.
#[inline(always)]
pub(super) fn from_inside<L: Lane>(direction: Vec3<L>, surface: &SurfaceLanes<L>) -> L::Mask {
    direction.dot(surface.geometric_normal).gt(L::zero())
}

/// Geometric and shading normal on the side that rays come from.
#[inline(always)]
pub(super) fn facing<L: Lane>(hit: &HitLanes<L>, surface: &SurfaceLanes<L>) -> [Vec3<L>; 2] {
    let inside = from_inside(hit.direction, surface);
    let [geometric, shading] =
        [surface.geometric_normal, surface.shading_normal].map(|n| Vec3::select(inside, -n, n));
    [geometric, towards(shading, geometric, hit.direction)]
}

#[inline(always)]
pub(super) fn gather_hits<L: Lane>(
    queue: &PathQueue<L::Scalar>,
    paths: &Rows,
    hits: &Hits<L::Scalar>,
    rows: &Rows,
) -> HitLanes<L> {
    HitLanes {
        origin: queue.origin.gather(paths),
        direction: queue.direction.gather(paths),
        t: gather(hits.t, rows),
        u: gather(hits.u, rows),
        v: gather(hits.v, rows),
        row: {
            let prims = rows.of(hits.prim);
            eight(|i| PrimId(prims[i]).row() as u32)
        },
        instance: if hits.instance.is_empty() { [0; WIDTH] } else { rows.of(hits.instance) },
    }
}

/// Material rows of hits.
#[inline(always)]
pub(super) fn materials_of<L: Lane>(scene: &Scene, kind: PrimKind, hit: &HitLanes<L>) -> [u32; WIDTH] {
    let g = &scene.geometry;
    let own = entries(g.materials(kind), &hit.row);
    if hit.instance == [0; WIDTH] {
        return own;
    }
    let given =
        hit.instance.map(|n| n.checked_sub(1).map_or(NO_MATERIAL, |n| g.instances[n as usize].material));
    eight(|i| if given[i] == NO_MATERIAL { own[i] } else { given[i] })
}

/// The shading normal where the path can see its front, the geometric one elsewhere: at grazing angles an interpolated
/// normal may face away.
#[inline(always)]
fn towards<L: Lane>(shading: Vec3<L>, geometric: Vec3<L>, direction: Vec3<L>) -> Vec3<L> {
    Vec3::select(shading.dot(direction).lt(L::zero()), shading, geometric)
}

/// Texture colours; white where a material has no texture.
pub(super) fn texture_color<L: Lane>(scene: &Scene, materials: &[u32; WIDTH], (u, v): (L, L)) -> Vec3<L> {
    let rows = entries(&scene.materials.texture, materials);
    let place = |x: L| f32x8::new(eight(|i| x.get(i).to_f32()));
    let uv @ (u, v) = (place(u), place(v));
    if rows == [NO_TEXTURE; WIDTH] {
        return Vec3::splat_f32([1.0; 3]);
    }
    let color: Vec3<f32x8> = match rows == [rows[0]; WIDTH] {
        true => sample_eight(&scene.textures[rows[0] as usize], uv),
        false => {
            let each = eight(|i| match rows[i] {
                NO_TEXTURE => [1.0; 3],
                row => sample_texture(&scene.textures[row as usize], [u.get(i), v.get(i)]),
            });
            let [x, y, z] = three(|c| f32x8::new(eight(|i| each[i][c])));
            Vec3 { x, y, z }
        }
    };
    let [x, y, z] = [color.x, color.y, color.z].map(|channel| L::load_f32(&channel.to_array()));
    Vec3 { x, y, z }
}
