//! No two outputs of a job are one file, nor one the folder of another, whatever the file system makes of their letters.

use std::collections::HashMap;

use super::picture::Picture;

/// An output and its picture.
#[derive(Clone, Copy)]
struct Owner<'p> {
    path: &'p str,
    picture: &'p Picture,
}

/// Outputs by their paths in small letters, as file systems compare them that do not tell capitals from small ones.
type Owners<'p> = HashMap<String, Owner<'p>>;

/// Fails if two outputs are the same file, or one is the folder of another.
pub(super) fn check(pictures: &[Picture]) -> Result<(), String> {
    let mut owners = Owners::new();
    for new in pictures.iter().flat_map(outputs) {
        if let Some(old) = owners.insert(new.path.to_lowercase(), new) {
            return Err(twice(old, new));
        }
    }
    for output in pictures.iter().flat_map(outputs) {
        if let Some(above) = file_above(output.path, &owners) {
            return Err(format!("output `{above}` would be a file, and the folder of `{}`", output.path));
        }
    }
    cameras(pictures)
}

/// Fails if two pictures have one file for their cameras, as those have that differ in nothing but their endings.
fn cameras(pictures: &[Picture]) -> Result<(), String> {
    let mut owners: HashMap<String, &Picture> = HashMap::new();
    for picture in pictures {
        for path in picture.outputs.iter().filter_map(|file| file.camera_path()) {
            let other = owners.insert(path.to_lowercase(), picture);
            if let Some(other) = other.filter(|other| !std::ptr::eq(*other, picture)) {
                let [first, second] = [&other.name, &picture.name];
                return Err(format!("`{path}` would hold the cameras of both {first} and {second}"));
            }
        }
    }
    Ok(())
}

fn outputs(picture: &Picture) -> impl Iterator<Item = Owner<'_>> {
    picture.outputs.iter().map(|file| Owner { path: &file.path, picture })
}

/// What is wrong with two outputs at one place.
fn twice(old: Owner, new: Owner) -> String {
    let ([other, path], [first, second]) = ([old.path, new.path], [&old.picture.name, &new.picture.name]);
    if path != other {
        return format!(
            "outputs `{other}` of {first} and `{path}` of {second} differ in nothing but capital letters: file systems that do \
             not tell them apart have one file for both"
        );
    }
    if std::ptr::eq(old.picture, new.picture) {
        return format!("two [[output]] of the job are the same file `{path}`");
    }
    format!(
        "output `{path}` would hold both {first} and {second}: name what differs in it, such as {{camera}}, {{sweep}} or {{key}}"
    )
}

/// The output that a path has as a folder.
fn file_above<'p>(path: &str, owners: &Owners<'p>) -> Option<&'p str> {
    let path = path.to_lowercase();
    let above = path.match_indices('/').find_map(|(at, _)| owners.get(&path[..at]));
    above.map(|owner| owner.path)
}
