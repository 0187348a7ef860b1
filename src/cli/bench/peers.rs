//! Other ray tracers beside octray, in builds that have them.

#[cfg(feature = "peers")]
use std::path::PathBuf;

use super::BenchArgs;
#[cfg(feature = "peers")]
use super::PEERS;
use crate::cli::error::{CliError, Exit};
#[cfg(feature = "peers")]
use crate::cli::stdio::say;
use crate::intersect::TierName;
use crate::measure::bench::{PeerScene, Subject};

/// The other ray tracers, if any were asked for.
#[cfg(feature = "peers")]
pub(super) struct Peers(Option<crate::measure::peers::Peers>);

#[cfg(feature = "peers")]
impl Peers {
    pub(super) fn open(args: &BenchArgs) -> Result<Self, CliError> {
        if args.peers.is_empty() {
            return Ok(Self(None));
        }
        let path = args.embree.clone().or_else(|| std::env::var_os("OCTRAY_EMBREE").map(PathBuf::from));
        let is_wanted = args.peers.iter().any(|name| name == PEERS[0]);
        if is_wanted && path.is_none() {
            say(
                "without Embree: name its library or its folder by --embree or by the variable OCTRAY_EMBREE",
            );
        }
        let peers = crate::measure::peers::Peers::open(path.as_deref().filter(|_| is_wanted), &args.peers);
        peers.map(|peers| Self(Some(peers))).map_err(|error| CliError::of(Exit::Failed, error))
    }
    pub(super) fn scenes(&self, subject: &Subject, tier: TierName, threads: usize) -> Vec<PeerScene> {
        self.0.as_ref().map_or(Vec::new(), |peers| peers.scenes(subject, tier, threads, &say))
    }
}

/// No other ray tracers in this build.
#[cfg(not(feature = "peers"))]
pub(super) struct Peers;

#[cfg(not(feature = "peers"))]
impl Peers {
    pub(super) fn open(args: &BenchArgs) -> Result<Self, CliError> {
        let missing = "this octray was built without other ray tracers: build it with --features peers";
        if !args.peers.is_empty() { Err(CliError::new(Exit::Usage, missing)) } else { Ok(Self) }
    }
    pub(super) fn scenes(&self, _: &Subject, _: TierName, _: usize) -> Vec<PeerScene> {
        Vec::new()
    }
}
