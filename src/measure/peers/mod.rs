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
}

impl Peers {
    /// Loads Embree from its library, or from a folder that holds it; without a path there is no Embree.
    ///
    /// **Errors:** a path that leads to no Embree 4.
    #[cfg(unix)]
    pub fn open(embree: Option<&Path>) -> Result<Self, PeerError> {
        Ok(Self { embree: embree.map(embree::Embree::load).transpose().map_err(PeerError)? })
    }

    /// The crates alone: nothing is loaded at run time on this system.
    #[cfg(not(unix))]
    pub fn open(embree: Option<&Path>) -> Result<Self, PeerError> {
        match embree {
            None => Ok(Self {}),
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
        let crates =
            [("obvhs", crate_scene::<obvhs::Obvhs>(subject)), ("bvh", crate_scene::<bvh::BvhCrate>(subject))];
        for (name, built) in crates {
            match built {
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
