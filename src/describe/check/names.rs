//! Names: each given once, each use known, no group inside itself.

use super::super::{Objects, SceneDescription, Target};
use super::faults::{Faults, nearest};
use std::collections::HashSet;

/// All names that objects may use.
pub(super) struct Names<'a> {
    materials: HashSet<&'a str>,
    targets: HashSet<&'a str>,
}

impl<'a> Names<'a> {
    /// All names, after complaining about those given twice.
    pub(super) fn collect(f: &mut Faults, scene: &'a SceneDescription) -> Names<'a> {
        let mut names = Names { materials: HashSet::new(), targets: HashSet::new() };
        let materials = &mut names.materials;
        for (i, material) in scene.material.iter().enumerate() {
            f.nth("material", i, |f| once(f, materials, &material.name, "material"));
        }
        names.collect_targets(f, scene);
        names
    }

    fn collect_targets(&mut self, f: &mut Faults, scene: &'a SceneDescription) {
        let targets = &mut self.targets;
        for (i, group) in scene.group.iter().enumerate() {
            f.nth("group", i, |f| {
                once(f, targets, &group.name, "group or mesh");
                once_each_mesh(f, targets, &group.objects());
            });
        }
        once_each_mesh(f, targets, &scene.objects());
    }

    /// Checks the `material` key of an object.
    pub(super) fn check_material(&self, f: &mut Faults, name: Option<&String>) {
        if let Some(name) = name {
            known(f, &self.materials, "material", name, "material");
        }
    }

    /// Checks the `of` key of an instance.
    pub(super) fn check_target(&self, f: &mut Faults, name: &str) {
        known(f, &self.targets, "of", name, "group or named mesh");
    }
}

fn once<'a>(f: &mut Faults, seen: &mut HashSet<&'a str>, name: &'a str, what: &str) {
    if name.is_empty() {
        f.at("name", |f| f.add(format!("the name of a {what} must not be empty")));
    } else if !seen.insert(name) {
        f.at("name", |f| f.add(format!("there is another {what} named `{name}`")));
    }
}

fn once_each_mesh<'a>(f: &mut Faults, seen: &mut HashSet<&'a str>, objects: &Objects<'a>) {
    for (i, mesh) in objects.meshes.iter().enumerate() {
        if let Some(name) = &mesh.name {
            f.nth("mesh", i, |f| once(f, seen, name, "group or mesh"));
        }
    }
}

fn known(f: &mut Faults, names: &HashSet<&str>, key: &'static str, name: &str, what: &str) {
    if names.contains(name) {
        return;
    }
    // Sorted, so that of two names equally near always the same one is offered.
    let mut sorted: Vec<&str> = names.iter().copied().collect();
    sorted.sort_unstable();
    let help = match nearest(name, sorted.iter().copied()) {
        Some(near) => format!("did you mean `{near}`?"),
        None if sorted.is_empty() => format!("the scene has no {what}"),
        None => format!("known: {}", sorted.join(", ")),
    };
    f.at(key, |f| f.add_with_help(format!("there is no {what} named `{name}`"), Some(help)));
}

/// Groups within each other up to which a thread's stack suffices when they are compiled.
const MOST_LEVELS: u32 = 256;

/// Complains about groups that contain themselves through their instances, or others too deep.
pub(super) fn check_circles(f: &mut Faults, scene: &SceneDescription) {
    let mut found = vec![Found::Nothing; scene.group.len()];
    for start in 0..scene.group.len() {
        visit(f, scene, &mut found, start);
    }
}

/// What is known of a group.
#[derive(Clone, Copy, PartialEq)]
enum Found {
    Nothing,
    /// It is on the way down from some group.
    OnTheWay,
    /// It is free of circles, and holds groups so deep, itself counted.
    Levels(u32),
}

/// Walks down depth first with its own stack, so that a long chain of groups cannot overflow ours.
fn visit(f: &mut Faults, scene: &SceneDescription, found: &mut [Found], start: usize) {
    let mut stack = vec![(start, 0)];
    while let Some((group, next)) = stack.pop() {
        if next == 0 && matches!(found[group], Found::Levels(_)) {
            continue;
        }
        found[group] = Found::OnTheWay;
        let Some(instance) = scene.group[group].instance.get(next) else {
            found[group] = Found::Levels(levels(f, scene, found, group));
            continue;
        };
        stack.push((group, next + 1));
        if let Some(Target::Group(inner, _)) = scene.target(&instance.of) {
            match found[inner] {
                Found::Nothing => stack.push((inner, 0)),
                Found::OnTheWay => circle(f, group, next, &instance.of),
                Found::Levels(_) => {}
            }
        }
    }
}

/// How deep a group holds groups, itself counted; complains of the first that is too deep on its way up.
fn levels(f: &mut Faults, scene: &SceneDescription, found: &[Found], group: usize) -> u32 {
    let inner = scene.group[group].instance.iter().map(|instance| match scene.target(&instance.of) {
        Some(Target::Group(inner, _)) => match found[inner] {
            Found::Levels(levels) => levels,
            Found::Nothing | Found::OnTheWay => 0,
        },
        _ => 0,
    });
    let levels = 1 + inner.max().unwrap_or(0);
    if levels == MOST_LEVELS + 1 {
        let message = format!("groups are nested more than {MOST_LEVELS} deep");
        f.nth("group", group, |f| f.at("name", |f| f.add(message)));
    }
    levels
}

fn circle(f: &mut Faults, group: usize, instance: usize, of: &str) {
    let message = format!("group `{of}` would contain itself");
    f.nth("group", group, |f| f.nth("instance", instance, |f| f.at("of", |f| f.add(message))));
}
