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

/// Complains about groups that contain themselves through their instances.
pub(super) fn check_circles(f: &mut Faults, scene: &SceneDescription) {
    // 0: not yet visited, 1: on the way down from some group, 2: known to be free of circles.
    let mut state = vec![0u8; scene.group.len()];
    for start in 0..scene.group.len() {
        visit(f, scene, &mut state, start);
    }
}

/// Walks down depth first with its own stack, so that a long chain of groups cannot overflow ours.
fn visit(f: &mut Faults, scene: &SceneDescription, state: &mut [u8], start: usize) {
    let mut stack = vec![(start, 0)];
    while let Some((group, next)) = stack.pop() {
        if next == 0 && state[group] == 2 {
            continue;
        }
        state[group] = 1;
        let Some(instance) = scene.group[group].instance.get(next) else {
            state[group] = 2;
            continue;
        };
        stack.push((group, next + 1));
        if let Some(Target::Group(inner, _)) = scene.target(&instance.of) {
            match state[inner] {
                0 => stack.push((inner, 0)),
                1 => circle(f, group, next, &instance.of),
                _ => {}
            }
        }
    }
}

fn circle(f: &mut Faults, group: usize, instance: usize, of: &str) {
    let message = format!("group `{of}` would contain itself");
    f.nth("group", group, |f| f.nth("instance", instance, |f| f.at("of", |f| f.add(message))));
}
