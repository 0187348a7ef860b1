//! Nested instances to two levels.

use super::CompileError;
use super::world::Part;
use crate::geometry::{Instance, NO_MATERIAL};

/// Most instances of a scene: about a gigabyte of transforms.
const MAX_INSTANCES: usize = 1 << 22;

/// Every instance, however deep, as one of the world, which is part 0: its transforms composed.
///
/// **Errors:** more than a scene may have.
pub(super) fn flattened(parts: &[Part]) -> Result<Vec<Instance>, CompileError> {
    let counts = shown(parts);
    if counts[0] > MAX_INSTANCES as u64 {
        return Err(CompileError::TooMany { what: "instances", limit: MAX_INSTANCES });
    }
    let mut instances = Vec::new();
    let mut waiting: Vec<Instance> = parts[0].shows.iter().rev().cloned().collect();
    while let Some(instance) = waiting.pop() {
        let part = &parts[instance.group];
        if counts[instance.group] > 0 {
            waiting.extend(part.shows.iter().rev().map(|inner| seen_through(&instance, inner)));
        }
        if !part.is_empty() {
            instances.push(instance);
        }
    }
    Ok(instances)
}

/// How many instances that are not empty each part shows, through others too: groups of groups multiply, ten levels of ten
/// are 10^10. Parts show earlier ones alone, but for the world, the first.
fn shown(parts: &[Part]) -> Vec<u64> {
    let mut counts = vec![0u64; parts.len()];
    for part in (1..parts.len()).chain([0]) {
        let through =
            |shown: &Instance| counts[shown.group].saturating_add(u64::from(!parts[shown.group].is_empty()));
        counts[part] = parts[part].shows.iter().map(through).fold(0, u64::saturating_add);
    }
    counts
}

/// An instance in a group as an instance of the world, through an instance of that group; the outer material wins, and
/// what is seen is the outer object.
fn seen_through(outer: &Instance, inner: &Instance) -> Instance {
    let material = if outer.material == NO_MATERIAL { inner.material } else { outer.material };
    Instance {
        group: inner.group,
        to_world: inner.to_world.then(&outer.to_world),
        material,
        object: outer.object,
    }
}
