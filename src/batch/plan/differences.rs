//! In what two plans differ, in words.

use super::Plan;
use crate::batch::faults::{MOST_NAMED, first_lines};
use crate::batch::picture::Picture;

impl Plan {
    /// In what this plan differs from one that was begun, in words.
    pub fn differences(&self, begun: &Self) -> Vec<String> {
        let mut found = Vec::new();
        let mut note = |what: &str, was: String, is: String| {
            if was != is {
                found.push(format!("{what} was {was} and is {is}"));
            }
        };
        note("octray", begun.octray.clone(), self.octray.clone());
        note("the scene", begun.scene.clone(), self.scene.clone());
        note("the split", format!("{:?}", begun.split), format!("{:?}", self.split));
        note("the number of shards", begun.shards.to_string(), self.shards.to_string());
        note("the number of pictures", begun.pictures.len().to_string(), self.pictures.len().to_string());
        note("the settings", begun.sets.join(" "), self.sets.join(" "));
        if self.scene == begun.scene && self.scene_blake3 != begun.scene_blake3 {
            found.push(format!("the scene {} has changed", self.scene));
        }
        let changed = self.assets.iter().filter(|asset| !begun.assets.contains(asset));
        let changed = changed.map(|asset| format!("{} has changed", asset.path.display()));
        found.extend(first_lines(MOST_NAMED, changed));
        let pair = self.pictures.iter().zip(&begun.pictures).find(|(is, was)| is != was);
        if let Some((is, was)) = pair.filter(|_| found.is_empty()) {
            found.push(picture_difference(is, was));
        }
        found
    }
}

fn picture_difference(is: &Picture, was: &Picture) -> String {
    let paths = |p: &Picture| p.outputs.iter().map(|o| o.path.clone()).collect::<Vec<_>>().join(" ");
    let of = |p: &Picture| format!("{} ({}) in {}", p.name, p.sets.join(" "), paths(p));
    format!("{} was {}", of(is), of(was))
}
