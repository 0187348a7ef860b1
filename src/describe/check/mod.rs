//! Whether a description makes sense: every rule beyond the types, each fault with the path of its key.

mod faults;
mod names;
mod objects;
mod settings;

pub use faults::Fault;
pub(super) use faults::{PathPart, nearest};

use super::SceneDescription;
use faults::Faults;
use names::Names;

impl SceneDescription {
    /// Checks every value and every name.
    ///
    /// [`parse`](super::parse) has done this already; call it after changing a description by code.
    ///
    /// # Errors
    /// All faults found, in the order of the file's sections, each with the path of its key; at most 50.
    pub fn check(&self) -> Result<(), Vec<Fault>> {
        let mut faults = Faults::default();
        let names = Names::collect(&mut faults, self);
        settings::check(&mut faults, self);
        objects::check(&mut faults, self, &names);
        names::check_circles(&mut faults, self);
        faults.into_result()
    }
}

#[cfg(test)]
mod tests;
