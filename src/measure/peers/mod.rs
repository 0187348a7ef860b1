//! Other ray tracers as engines of the bench: Embree 4 through its C interface, and crates in Rust.

mod bvh;
#[cfg(unix)]
mod embree;
mod faces;
mod obvhs;

use std::path::Path;

use super::bench::{PeerScene, Subject};
use crate::intersect::TierName;

/// Why other ray tracers cannot be measured.
#[derive(Debug, thiserror::Error)]
#[error("Embree cannot be loaded: {0}")]
pub struct PeerError(String);

/// The ray tracers that can be measured here.
pub struct Peers {
    #[cfg(unix)]
    embree: Option<embree::Embree>,
    names: Vec<String>,
}

impl Peers {
    /// Those among `names`. Embree is loaded from its library, or from a folder that holds it; without a path there is none.
    ///
    /// **Errors:** a path that leads to no Embree 4.
    #[cfg(unix)]
    pub fn open(embree: Option<&Path>, names: &[String]) -> Result<Self, PeerError> {
        let embree = embree.map(embree::Embree::load).transpose().map_err(PeerError)?;
        Ok(Self { embree, names: names.to_vec() })
    }

    /// The crates alone: nothing is loaded at run time on this system.
    #[cfg(not(unix))]
    pub fn open(embree: Option<&Path>, names: &[String]) -> Result<Self, PeerError> {
        match embree {
            None => Ok(Self { names: names.to_vec() }),
            Some(_) => Err(PeerError("only on Unix".into())),
        }
    }

    /// The scene in each of them. Those that cannot hold it are left out, and `say` is told.
    pub fn scenes(
        &self,
        subject: &Subject,
        tier: TierName,
        threads: usize,
        say: &dyn Fn(&str),
    ) -> Vec<PeerScene> {
        let mut scenes = Vec::new();
        #[cfg(unix)]
        if let Some(embree) = &self.embree {
            match embree.scenes(subject, tier, threads) {
                Ok(built) => scenes.extend(built),
                Err(reason) => say(&format!("{subject}: without Embree: {reason}")),
            }
        }
        type Crate = fn(&Subject) -> Result<PeerScene, String>;
        let crates: [(&str, Crate); 2] =
            [("obvhs", crate_scene::<obvhs::Obvhs>), ("bvh", crate_scene::<bvh::BvhCrate>)];
        for (name, build) in crates.into_iter().filter(|(name, _)| self.names.iter().any(|n| n == name)) {
            match build(subject) {
                Ok(scene) => scenes.push(scene),
                Err(reason) => say(&format!("{subject}: without {name}: {reason}")),
            }
        }
        scenes
    }
}

fn crate_scene<F: faces::Faces + 'static>(subject: &Subject) -> Result<PeerScene, String> {
    let (engine, build) = faces::FacesEngine::<F>::build(subject)?;
    Ok(PeerScene { build, engines: vec![Box::new(engine)] })
}
