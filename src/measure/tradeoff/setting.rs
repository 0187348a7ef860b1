//! One way to render a scene.

use std::sync::Arc;

use std::fmt;

use serde::Serialize;

use crate::intersect::TierName;
use crate::sampling::SamplerKind;
use crate::scene::{Requirements, Scatter, Scene};

/// One way to render a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Setting {
    /// Precision.
    pub tier: TierName,
    /// Samples a pixel.
    pub spp: u32,
    /// How samples are placed.
    pub sampler: SamplerKind,
    /// Most bounces of a path.
    pub max_depth: u32,
    /// Paths that would bring less than this share of their radiance end.
    pub min_throughput: f64,
    /// The picture is smaller by this factor along both sides, and enlarged again to be compared.
    pub shrink: u32,
    /// Whether what stands before a light takes it away.
    pub shadows: bool,
    /// Whether diffuse surfaces send rays on where the scene wants it.
    pub bounce: bool,
}

impl Setting {
    /// The way that the scene itself asks for.
    pub fn of(scene: &Scene) -> Self {
        let s = &scene.settings;
        Self {
            tier: s.tier,
            spp: s.spp,
            sampler: s.sampler,
            max_depth: s.max_depth,
            min_throughput: s.min_throughput,
            shrink: 1,
            shadows: s.shadows,
            bounce: true,
        }
    }

    /// Work in comparison with others of the same scene that differ in samples and size alone.
    pub(super) fn samples_a_pixel(&self) -> f64 {
        f64::from(self.spp) / f64::from(self.shrink * self.shrink)
    }

    /// The names of what may change, and the values here.
    pub fn fields(&self) -> [(&'static str, String); 8] {
        let yes_no = |yes: bool| if yes { "yes".into() } else { "no".into() };
        let cutoff = match self.min_throughput {
            0.0 => "0".into(),
            least => format!("1/{:.0}", 1.0 / least),
        };
        [
            ("tier", self.tier.name().into()),
            ("spp", self.spp.to_string()),
            ("sampler", sampler_name(self.sampler).into()),
            ("depth", self.max_depth.to_string()),
            ("cutoff", cutoff),
            ("size", if self.shrink == 1 { "full".into() } else { format!("1/{}", self.shrink) }),
            ("shadows", yes_no(self.shadows)),
            ("bounce", yes_no(self.bounce)),
        ]
    }

    /// What is unlike `base` beside tier and samples, and its value.
    pub(super) fn change_from(&self, base: &Self) -> Option<(&'static str, String)> {
        self.fields()
            .into_iter()
            .zip(base.fields())
            .skip(2)
            .find(|(own, other)| own != other)
            .map(|(own, _)| own)
    }

    /// Tier, samples and what is unlike `base`.
    pub(super) fn name_beside(&self, base: &Self) -> String {
        let change =
            self.change_from(base).map_or(String::new(), |(name, value)| format!(", {name} {value}"));
        format!("{} {} spp{change}", self.tier.name(), self.spp)
    }
}

impl fmt::Display for Setting {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let fields = self.fields();
        write!(f, "{} {} spp", fields[0].1, self.spp)?;
        fields[2..].iter().try_for_each(|(name, value)| write!(f, ", {name} {value}"))
    }
}

impl Serialize for Setting {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        use serde::ser::SerializeStruct;
        let mut fields = serializer.serialize_struct("Setting", 8)?;
        fields.serialize_field("tier", self.tier.name())?;
        fields.serialize_field("spp", &self.spp)?;
        fields.serialize_field("sampler", sampler_name(self.sampler))?;
        fields.serialize_field("max_depth", &self.max_depth)?;
        fields.serialize_field("min_throughput", &self.min_throughput)?;
        fields.serialize_field("shrink", &self.shrink)?;
        fields.serialize_field("shadows", &self.shadows)?;
        fields.serialize_field("bounce", &self.bounce)?;
        fields.end()
    }
}

fn sampler_name(sampler: SamplerKind) -> &'static str {
    match sampler {
        SamplerKind::Random => "random",
        SamplerKind::Stratified => "stratified",
        SamplerKind::Sobol => "sobol",
    }
}

/// A scene whose settings can be changed without compiling it again.
pub(super) struct Stage {
    scene: Scene,
    size: [u32; 2],
    scatter: Vec<Scatter>,
}

impl Stage {
    pub(super) fn new(scene: Scene) -> Self {
        Self { size: scene.settings.size, scatter: scene.materials.scatter.clone(), scene }
    }

    /// The scene in some way. **Needs:** sides that `shrink` divides, so that pixels keep their shape.
    pub(super) fn set(&mut self, setting: &Setting) -> &Scene {
        let scene = &mut self.scene;
        let s = &mut scene.settings;
        (s.tier, s.spp, s.sampler) = (setting.tier, setting.spp, setting.sampler);
        (s.max_depth, s.min_throughput) = (setting.max_depth, setting.min_throughput);
        s.shadows = setting.shadows;
        s.size = self.size.map(|side| side / setting.shrink);
        let materials = Arc::make_mut(&mut scene.materials);
        materials.scatter.clone_from(&self.scatter);
        if !setting.bounce {
            let diffuse = |scatter: &&mut Scatter| **scatter == Scatter::Diffuse;
            materials.scatter.iter_mut().filter(diffuse).for_each(|scatter| *scatter = Scatter::Absorb);
        }
        scene.requirements = Requirements::of(
            &scene.geometry,
            &scene.materials,
            &scene.lights,
            &scene.camera,
            setting.max_depth,
            scene.requirements.sample_weights,
        );
        scene
    }

    /// The same with another seed: random numbers that have nothing in common.
    pub(super) fn set_with_seed(&mut self, setting: &Setting, seed: u64) -> &Scene {
        self.scene.settings.seed = seed;
        self.set(setting)
    }

    pub(super) fn scene(&self) -> &Scene {
        &self.scene
    }

    pub(super) fn size(&self) -> [u32; 2] {
        self.size
    }
}
