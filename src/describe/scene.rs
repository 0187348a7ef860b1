//! The whole scene file.

use super::{
    Background, Camera, Cylinder, Instance, Lights, Material, Mesh, Plane, Quad, Render, Sphere, Transform,
    Triangle,
};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// A scene, as written. Field names are the keys of the file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SceneDescription {
    /// `[camera]`: where the picture is taken from.
    pub camera: Camera,
    /// `[render]`: how the picture is computed.
    #[serde(default)]
    pub render: Render,
    /// `[background]`: what rays see that hit nothing.
    #[serde(default)]
    pub background: Background,
    /// `[[material]]`.
    #[serde(default)]
    pub material: Vec<Material>,
    /// `[[light.point]]`, `[[light.directional]]`, `[[light.spot]]`.
    #[serde(default)]
    pub light: Lights,
    /// `[[sphere]]`.
    #[serde(default)]
    pub sphere: Vec<Sphere>,
    /// `[[cylinder]]`.
    #[serde(default)]
    pub cylinder: Vec<Cylinder>,
    /// `[[triangle]]`.
    #[serde(default)]
    pub triangle: Vec<Triangle>,
    /// `[[quad]]`.
    #[serde(default)]
    pub quad: Vec<Quad>,
    /// `[[plane]]`.
    #[serde(default)]
    pub plane: Vec<Plane>,
    /// `[[mesh]]`.
    #[serde(default)]
    pub mesh: Vec<Mesh>,
    /// `[[group]]`: things that are only seen where an instance puts them.
    #[serde(default)]
    pub group: Vec<Group>,
    /// `[[instance]]`.
    #[serde(default)]
    pub instance: Vec<Instance>,
    /// Folder of the scene file: relative paths start here. Not part of the file.
    #[serde(skip)]
    pub folder: PathBuf,
}

/// Things that belong together and are seen wherever an `[[instance]]` puts them, and nowhere else.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Group {
    /// Name for `[[instance]]`.
    pub name: String,
    /// `[[group.sphere]]`.
    #[serde(default)]
    pub sphere: Vec<Sphere>,
    /// `[[group.cylinder]]`.
    #[serde(default)]
    pub cylinder: Vec<Cylinder>,
    /// `[[group.triangle]]`.
    #[serde(default)]
    pub triangle: Vec<Triangle>,
    /// `[[group.quad]]`.
    #[serde(default)]
    pub quad: Vec<Quad>,
    /// `[[group.mesh]]`.
    #[serde(default)]
    pub mesh: Vec<Mesh>,
    /// `[[group.instance]]`: groups may hold instances of others, but no circle.
    #[serde(default)]
    pub instance: Vec<Instance>,
}

/// The things that a scene and a group both can hold, borrowed from either.
// serde's `flatten` would share these fields but loses error positions and unknown-key checks, hence a view.
#[derive(Debug, Clone, Copy)]
pub struct Objects<'a> {
    /// Spheres.
    pub spheres: &'a [Sphere],
    /// Cylinders.
    pub cylinders: &'a [Cylinder],
    /// Triangles.
    pub triangles: &'a [Triangle],
    /// Quads.
    pub quads: &'a [Quad],
    /// Meshes.
    pub meshes: &'a [Mesh],
    /// Instances.
    pub instances: &'a [Instance],
}

/// What an instance shows.
#[derive(Debug, Clone, Copy)]
pub enum Target<'a> {
    /// A group, with its place in `group`.
    Group(usize, &'a Group),
    /// A named mesh of the scene or of a group.
    Mesh(&'a Mesh),
}

impl SceneDescription {
    /// A scene without anything but its camera.
    #[must_use]
    pub fn new(camera: Camera) -> SceneDescription {
        SceneDescription {
            camera,
            render: Render::default(),
            background: Background::default(),
            material: Vec::new(),
            light: Lights::default(),
            sphere: Vec::new(),
            cylinder: Vec::new(),
            triangle: Vec::new(),
            quad: Vec::new(),
            plane: Vec::new(),
            mesh: Vec::new(),
            group: Vec::new(),
            instance: Vec::new(),
            folder: PathBuf::new(),
        }
    }

    /// Takes all transforms of objects away.
    pub(crate) fn forget_transforms(&mut self) {
        let lists =
            |s: &mut [Sphere], c: &mut [Cylinder], t: &mut [Triangle], q: &mut [Quad], m: &mut [Mesh]| {
                s.iter_mut().for_each(|sphere| sphere.transform = Transform::default());
                c.iter_mut().for_each(|cylinder| cylinder.transform = Transform::default());
                t.iter_mut().for_each(|triangle| triangle.transform = Transform::default());
                q.iter_mut().for_each(|quad| quad.transform = Transform::default());
                m.iter_mut().for_each(|mesh| mesh.transform = Transform::default());
            };
        lists(&mut self.sphere, &mut self.cylinder, &mut self.triangle, &mut self.quad, &mut self.mesh);
        self.instance.iter_mut().for_each(|instance| instance.transform = Transform::default());
        for g in &mut self.group {
            lists(&mut g.sphere, &mut g.cylinder, &mut g.triangle, &mut g.quad, &mut g.mesh);
            g.instance.iter_mut().for_each(|instance| instance.transform = Transform::default());
        }
    }

    /// The things outside groups, planes aside.
    #[must_use]
    pub fn objects(&self) -> Objects<'_> {
        Objects {
            spheres: &self.sphere,
            cylinders: &self.cylinder,
            triangles: &self.triangle,
            quads: &self.quad,
            meshes: &self.mesh,
            instances: &self.instance,
        }
    }

    /// The group or named mesh that an instance's `of` means.
    #[must_use]
    pub fn target(&self, name: &str) -> Option<Target<'_>> {
        let group = self.group.iter().enumerate().find(|(_, g)| g.name == name);
        let mesh = || self.all_meshes().find(|m| m.name.as_deref() == Some(name));
        group.map(|(i, g)| Target::Group(i, g)).or_else(|| mesh().map(Target::Mesh))
    }

    /// The material of a name.
    #[must_use]
    pub fn material_index(&self, name: &str) -> Option<usize> {
        self.material.iter().position(|m| m.name == name)
    }

    /// Meshes of the scene, then of its groups, in the order written.
    pub fn all_meshes(&self) -> impl Iterator<Item = &Mesh> {
        self.mesh.iter().chain(self.group.iter().flat_map(|g| &g.mesh))
    }

    /// A path of the scene file seen from the current folder.
    #[must_use]
    pub fn resolve(&self, path: &Path) -> PathBuf {
        self.folder.join(path)
    }
}

impl Group {
    /// The things in this group.
    #[must_use]
    pub fn objects(&self) -> Objects<'_> {
        Objects {
            spheres: &self.sphere,
            cylinders: &self.cylinder,
            triangles: &self.triangle,
            quads: &self.quad,
            meshes: &self.mesh,
            instances: &self.instance,
        }
    }
}
