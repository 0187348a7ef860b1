//! Camera, lights, background and settings.

use super::CompileError;
use crate::accel::Quality;
use crate::describe::{self, CameraKind, FilterKind, Handedness, SceneDescription};
use crate::film::{Tone, ToneCurve};
use crate::intersect::TierName;
use crate::math::Transform;
use crate::sampling::{PixelFilter, SamplerKind};
use crate::scene::{Background, Camera, Light, Projection, RenderSettings};
use crate::shading::{DirectionalLight, PointLight, SpotLight};
use glam::DVec3;

/// The camera's axes, moved by its transform and scaled to half the picture.
pub(super) fn camera(description: &SceneDescription) -> Result<Camera, CompileError> {
    let c = &description.camera;
    let transform = Transform::from_rows(c.transform.matrix())
        .map_err(|source| CompileError::Transform { what: "camera".into(), source })?;
    let place = |p| DVec3::from(transform.point(p));
    let position = place(c.position);
    let forward = (place(c.look_at) - position).normalize();
    let up = DVec3::from(transform.direction(c.up));
    let right = match c.handedness {
        Handedness::Right => forward.cross(up).normalize(),
        Handedness::Left => up.cross(forward).normalize(),
    };
    // A mirroring transform mirrors the picture, as it mirrors everything else.
    let right = if transform.determinant() < 0.0 { -right } else { right };
    let up = (up - forward * forward.dot(up)).normalize();
    let (half_height, projection) = projection(c);
    let [width, height] = description.render.size.map(f64::from);
    Ok(Camera {
        position: position.into(),
        forward: forward.into(),
        right: (right * half_height * (width / height)).into(),
        up: (up * half_height).into(),
        projection,
        near: c.near,
    })
}

fn projection(c: &describe::Camera) -> (f64, Projection) {
    match c.kind {
        CameraKind::Orthographic => (0.5 * c.height.unwrap_or(2.0), Projection::Orthographic),
        CameraKind::Perspective => {
            let half = libm::tan((0.5 * c.fov_deg).to_radians());
            let lens = Projection::ThinLens {
                aperture_radius: c.aperture_radius,
                focus_distance: c.focus_distance(),
            };
            (half, if c.aperture_radius > 0.0 { lens } else { Projection::Pinhole })
        }
    }
}

/// All lights that give light.
pub(super) fn lights(description: &SceneDescription) -> Vec<Light> {
    let l = &description.light;
    let point = l.point.iter().map(|p| Light::Point(point_light(p.position, p.color, p.intensity)));
    let directional = l.directional.iter().map(|d| {
        let direction = unit(DVec3::from(d.direction));
        Light::Directional(DirectionalLight { direction, irradiance: power(d.color, d.intensity) })
    });
    let spot = l.spot.iter().map(|s| {
        let axis = unit(DVec3::from(s.look_at) - DVec3::from(s.position));
        let point = point_light(s.position, s.color, s.intensity);
        Light::Spot(SpotLight::new(point, axis, s.cone_deg.to_radians(), s.penumbra_deg.to_radians()))
    });
    point.chain(directional).chain(spot).collect()
}

fn point_light(position: [f64; 3], color: describe::Rgb, intensity: f64) -> PointLight {
    PointLight { position: position.map(|x| x as f32), intensity: power(color, intensity) }
}

fn power(color: describe::Rgb, intensity: f64) -> [f32; 3] {
    color.0.map(|c| (c * intensity) as f32)
}

fn unit(v: DVec3) -> [f32; 3] {
    v.normalize().to_array().map(|x| x as f32)
}

impl Background {
    pub(super) fn of(description: &SceneDescription) -> Self {
        let [bottom, top] = description.background.bottom_and_top();
        Self { bottom, top, up: DVec3::from(description.camera.up).normalize().into() }
    }
}

impl RenderSettings {
    pub(super) fn of(description: &SceneDescription) -> Self {
        let r = &description.render;
        Self {
            size: r.size,
            spp: r.spp,
            max_depth: r.max_depth,
            shadows: r.shadows,
            seed: r.seed,
            tier: match r.tier {
                describe::Tier::Fast => TierName::Fast,
                describe::Tier::Watertight => TierName::Watertight,
                describe::Tier::Exact => TierName::Exact,
            },
            build_quality: match r.build_quality {
                describe::BuildQuality::Fast => Quality::Fast,
                describe::BuildQuality::Balanced => Quality::Balanced,
                describe::BuildQuality::High => Quality::High,
            },
            sampler: match r.sampler {
                describe::Sampler::Random => SamplerKind::Random,
                describe::Sampler::Stratified => SamplerKind::Stratified,
                describe::Sampler::Sobol => SamplerKind::Sobol,
            },
            filter: filter(&r.filter),
            min_throughput: r.min_throughput,
            aovs: r.aovs.iter().copied().collect(),
            tone: Tone {
                exposure_ev: r.exposure as f32,
                curve: match r.tone {
                    describe::Tone::None => ToneCurve::None,
                    describe::Tone::Reinhard => ToneCurve::Reinhard,
                    describe::Tone::Filmic => ToneCurve::Filmic,
                },
            },
        }
    }
}

fn filter(f: &describe::Filter) -> PixelFilter {
    let radius = f.radius() as f32;
    match f.kind {
        FilterKind::Box => PixelFilter::Box { radius },
        FilterKind::Tent => PixelFilter::Tent { radius },
        FilterKind::Gaussian => PixelFilter::Gaussian { radius, sigma: f.sigma as f32 },
        FilterKind::Mitchell => PixelFilter::Mitchell { radius, b: f.b as f32, c: f.c as f32 },
    }
}
