//! `octray inspect`: what a scene holds, and what of the renderer it needs.

use std::fmt::Write;

use super::args::InspectArgs;
use super::error::CliError;
use super::{human, pipeline, stdio};
use crate::intersect::PrimKind;
use crate::scene::{Scatter, Scene};

/// Prints what the scene holds.
pub fn run(args: &InspectArgs) -> Result<(), CliError> {
    let opened = pipeline::open(&args.scene.scene, &args.assignments(), 0)?;
    stdio::print(report(&opened.name, &opened.scene).as_bytes())
}

fn report(name: &str, scene: &Scene) -> String {
    let mut text = format!("{name}\n");
    section(&mut text, "holds", &holds(scene));
    section(&mut text, "memory by column", &memory(scene));
    let (runs, rests): (Vec<_>, Vec<_>) = stages(scene).into_iter().partition(|s| s.1);
    let names =
        |stages: Vec<(String, bool)>| stages.into_iter().map(|s| (s.0, String::new())).collect::<Vec<_>>();
    section(&mut text, "runs", &names(runs));
    section(&mut text, "needs not, so neither allocated nor visited nor run", &names(rests));
    text
}

fn section(text: &mut String, title: &str, rows: &[(String, String)]) {
    let width = rows.iter().map(|row| row.0.len()).max().unwrap_or(0);
    let _ = writeln!(text, "\n{title}");
    for (name, value) in rows {
        let _ = writeln!(text, "{}", format!("  {name:width$}  {value}").trim_end());
    }
}

fn holds(scene: &Scene) -> Vec<(String, String)> {
    let (g, s) = (&scene.geometry, &scene.settings);
    let mut rows: Vec<(String, String)> =
        PrimKind::ALL.iter().map(|&kind| (format!("{}s", kind.name()), g.count(kind).to_string())).collect();
    let mut row = |name: &str, value: String| rows.push((name.to_owned(), value));
    if scene.skipped_triangles > 0 {
        row("skipped", format!("{} triangles without area", scene.skipped_triangles));
    }
    row("instances", format!("{} of {} groups", g.instances.len(), g.groups.len().saturating_sub(1)));
    row("materials", scene.materials.len().to_string());
    row("textures", scene.textures.len().to_string());
    let lights: Vec<&str> = scene.lights.iter().map(|l| l.name()).collect();
    row("lights", if lights.is_empty() { "none".into() } else { lights.join(", ") });
    let b = scene.accel.bounds();
    row("bounds", if b.is_empty() { "empty".into() } else { format!("{:?} to {:?}", b.min, b.max) });
    row("tree", tree(scene));
    row("picture", format!("{}x{}, {} samples a pixel, {:?}", s.size[0], s.size[1], s.spp, s.sampler));
    row("filter", format!("{:?}", s.filter));
    row("tier", s.tier.name().into());
    row("bounces", format!("at most {}", s.max_depth));
    rows
}

/// What the tree is made of, and what that is for each primitive; one that was cut counts once.
fn tree(scene: &Scene) -> String {
    let (g, accel) = (&scene.geometry, &scene.accel);
    let text = format!(
        "{} nodes, {} leaves, {} quality",
        accel.node_count(),
        accel.leaf_count(),
        scene.settings.build_quality.name()
    );
    let held = g.triangles.len() + g.spheres.len() + g.cylinders.len() + g.instances.len();
    if held == 0 {
        return text;
    }
    let bytes: u64 = accel.memory().iter().map(|(_, bytes)| bytes).sum();
    let each = |total: f64, of: usize| total / of as f64;
    format!(
        "{text}, {:.1} bytes a primitive, {:.1} primitives a leaf",
        each(bytes as f64, held),
        each(accel.reference_count() as f64, accel.leaf_count())
    )
}

fn memory(scene: &Scene) -> Vec<(String, String)> {
    let columns: Vec<(String, u64)> = scene
        .geometry
        .memory()
        .into_iter()
        .chain(scene.accel.memory())
        .chain(scene.surface_memory())
        .collect();
    let total = columns.iter().map(|c| c.1).sum();
    let used = columns.into_iter().filter(|c| c.1 > 0).chain([("in all".to_owned(), total)]);
    used.map(|(name, bytes)| (name, human::bytes(bytes))).collect()
}

/// Every stage and kernel, and whether the scene needs it.
fn stages(scene: &Scene) -> Vec<(String, bool)> {
    let r = &scene.requirements;
    let mut stages = vec![("generate: camera rays".to_owned(), true)];
    let mut stage = |name: &str, needed: bool| stages.push((name.to_owned(), needed));
    stage("generate: points on the lens", r.lens);
    stage("generate: sample weights", r.sample_weights);
    for kind in PrimKind::ALL {
        stage(&format!("extend: {} kernel", kind.name()), r.has(kind));
    }
    stage("extend: instances", r.instances);
    stage("shade: interpolated normals", r.shading_normals);
    stage("shade: textures", r.textures);
    stage("shade: ambient light and emission", r.glow);
    stage("connect: shadow rays", r.lights && scene.settings.shadows);
    stage("connect: highlights", r.highlights);
    stage("connect: fractional shininess", r.fractional_shininess);
    for kind in [Scatter::Diffuse, Scatter::Metal, Scatter::Dielectric] {
        stage(&format!("scatter: {}", kind.name()), r.scatters(kind));
    }
    stages
}
