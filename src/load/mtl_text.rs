//! The text of an MTL file to materials.
//!
//! | MTL | here |
//! |---|---|
//! | `Kd`, `Ka`, `Ks`, `Ke` | `kd`, `ka`, `ks`, `emission`; one number counts for all channels; without `Ka`, an eighth of `Kd` |
//! | `Ns` | `shininess`, at most 65536 |
//! | `Ni` | `ior` |
//! | `illum` 3, 5, 8 | `metal`, tinted with `Ks` when that is not black |
//! | `illum` 4, 6, 7, 9 | `dielectric`, tinted with `Tf` when given |
//! | `d` below 1, or `Tr` above 0 (and below 1) without `d`, with `Ni` above 1 | `dielectric` |
//! | anything else | `diffuse` |
//! | `map_Kd` | `texture`, relative to the MTL file, options skipped |
//!
//! `Tr 1` alone means opaque: so many programs write it that its meaning by the book, invisible, is never meant.
//! Keys that are missing take the defaults of [`Material`]. Other maps are not used.

use super::LoadError;
use crate::describe::{Material, MaterialKind, Rgb};
use std::path::{Path, PathBuf};

/// The materials of a text, which is that of the file `mtl`.
///
/// # Errors
/// The first line that makes no sense, or a texture that is not there.
pub(super) fn read(text: &str, mtl: &Path) -> Result<Vec<Material>, LoadError> {
    parse(&prepare(text, mtl)?, mtl)?.iter().map(|material| convert(material, mtl)).collect()
}

/// Names written on Windows.
pub(super) fn unified(name: &str) -> String {
    name.replace('\\', "/")
}

/// Parses line by line, so that an error has its line.
fn parse(text: &str, mtl: &Path) -> Result<Vec<tobj::Material>, LoadError> {
    match tobj::load_mtl_buf(&mut text.as_bytes()) {
        Ok((materials, _)) => Ok(materials),
        Err(error) => {
            let fails =
                |line: &&str| tobj::load_mtl_buf(&mut format!("newmtl x\n{line}\n").as_bytes()).is_err();
            let line = text.lines().position(|line| fails(&line)).map(|index| index + 1);
            Err(LoadError::malformed(mtl, line, error.to_string()))
        }
    }
}

/// Colours with three numbers each: the parser stops the program at fewer.
fn prepare(source: &str, mtl: &Path) -> Result<String, LoadError> {
    let mut text = String::with_capacity(source.len());
    for (index, line) in source.strip_prefix('\u{feff}').unwrap_or(source).lines().enumerate() {
        let words: Vec<&str> = line.split_whitespace().collect();
        match words[..] {
            [key @ ("Ka" | "Kd" | "Ks" | "Ke"), ref numbers @ ..] => match numbers[..] {
                [x] => text.push_str(&format!("{key} {x} {x} {x}")),
                [_, _, _, ..] => text.push_str(line),
                _ => {
                    return Err(LoadError::malformed(
                        mtl,
                        Some(index + 1),
                        format!("`{key}` needs 1 or 3 numbers"),
                    ));
                }
            },
            _ => text.push_str(line),
        }
        text.push('\n');
    }
    Ok(text)
}

/// The ambient coefficient over the diffuse one where the file has no `Ka`: that of a material without any key.
const AMBIENT_SHARE: f64 = 0.125;

fn convert(m: &tobj::Material, mtl: &Path) -> Result<Material, LoadError> {
    let kind = kind(m);
    let color = |written: Option<[f32; 3]>| written.map(|c| Rgb(c.map(|x| sound(x).max(0.0))));
    let ks = color(m.specular);
    Ok(Material {
        // A dark wall without `Ka` must not glow in the shade like a white one.
        ka: color(m.ambient).or_else(|| color(m.diffuse).map(|kd| Rgb(kd.0.map(|k| AMBIENT_SHARE * k)))),
        kd: color(m.diffuse),
        ks,
        tint: match kind {
            MaterialKind::Metal => ks.filter(|ks| *ks != Rgb::BLACK),
            MaterialKind::Dielectric => unknown(m, "Tf").map(Rgb),
            MaterialKind::Diffuse => None,
        },
        shininess: m.shininess.map_or(100.0, |ns| sound(ns).clamp(0.0, 65536.0)),
        ior: m.optical_density.map(sound).filter(|ni| *ni > 0.0).unwrap_or(1.5),
        emission: color(m.emissive).filter(|ke| *ke != Rgb::BLACK),
        texture: m.diffuse_texture.as_deref().map(|name| texture(name, m, mtl)).transpose()?,
        ..Material::new(m.name.clone(), kind)
    })
}

fn kind(m: &tobj::Material) -> MaterialKind {
    match m.illumination_model {
        Some(3 | 5 | 8) => return MaterialKind::Metal,
        Some(4 | 6 | 7 | 9) => return MaterialKind::Dielectric,
        _ => {}
    }
    let transparency = || unknown(m, "Tr").map_or(0.0, |[tr, ..]| tr);
    let opacity = m.dissolve.map_or_else(|| 1.0 - transparency(), f64::from);
    let by_tr_alone = m.dissolve.is_none() && opacity <= 0.0;
    let refracts = m.optical_density.is_some_and(|ni| ni > 1.0);
    if opacity < 1.0 && refracts && !by_tr_alone { MaterialKind::Dielectric } else { MaterialKind::Diffuse }
}

/// The numbers of a key that the parser does not know; one number counts for all three.
fn unknown(m: &tobj::Material, key: &str) -> Option<[f64; 3]> {
    let words = m.unknown_param.get(key)?.split_whitespace();
    let numbers: Vec<f64> = words.map_while(|word| word.parse().ok()).filter(|x: &f64| *x >= 0.0).collect();
    match numbers[..] {
        [x] => Some([x; 3]),
        [x, y, z, ..] => Some([x, y, z]),
        _ => None,
    }
}

/// Numbers that are none become 0, infinite ones the largest a material may have.
fn sound(x: f32) -> f64 {
    if x.is_nan() { 0.0 } else { f64::from(x).clamp(-1e18, 1e18) }
}

fn texture(name: &str, m: &tobj::Material, mtl: &Path) -> Result<PathBuf, LoadError> {
    let folder = mtl.parent().unwrap_or(Path::new(""));
    let texture = folder.join(unified(skip_options(name)));
    if texture.is_file() {
        return Ok(texture);
    }
    Err(LoadError::MissingTexture { mtl: mtl.to_owned(), material: m.name.clone(), texture })
}

/// The file name behind options like `-s 1 1 1` or `-clamp on`.
fn skip_options(mut name: &str) -> &str {
    while let Some(option) = name.strip_prefix('-') {
        let (key, mut rest) = option.split_once(char::is_whitespace).unwrap_or((option, ""));
        let most = match key {
            "o" | "s" | "t" => 3,
            "mm" => 2,
            _ => 1,
        };
        for taken in 0..most {
            let (word, behind) = rest.trim_start().split_once(char::is_whitespace).unwrap_or((rest, ""));
            // Offsets and scales may have fewer than three numbers.
            if taken > 0 && word.parse::<f64>().is_err() {
                break;
            }
            rest = behind;
        }
        name = rest.trim_start();
    }
    name
}

#[cfg(test)]
mod tests {
    use super::*;

    fn materials(text: &str) -> Vec<Material> {
        let mtl = Path::new("test.mtl");
        let parsed = parse(&prepare(text, mtl).unwrap(), mtl).unwrap();
        parsed.iter().map(|m| convert(m, mtl).unwrap()).collect()
    }

    fn kind_of(keys: &str) -> MaterialKind {
        materials(&format!("newmtl x\n{keys}\n"))[0].kind
    }

    #[test]
    fn kinds_follow_illum_and_opacity() {
        use MaterialKind::{Dielectric, Diffuse, Metal};
        for (keys, kind) in [
            ("Kd 1 1 1", Diffuse),
            ("illum 2\nd 1\nNi 1.45", Diffuse),
            ("illum 3", Metal),
            ("illum 5", Metal),
            ("illum 4", Dielectric),
            ("illum 7", Dielectric),
            ("illum 2\nd 0.1\nNi 1.5", Dielectric),
            ("d 0.1", Diffuse),
            ("Tr 0.9\nNi 1.5", Dielectric),
            ("Tr 1.0\nNi 1.5", Diffuse),
            ("d 1\nTr 1\nNi 1.5", Diffuse),
        ] {
            assert_eq!(kind_of(keys), kind, "{keys}");
        }
    }

    #[test]
    fn numbers_are_taken_over() {
        let text = "newmtl a b\nKd 0.25\nKs 0 0.5 1\nNs 1e9\nNi 1.25\nKe 2 2 2\nTf 0.5 1 1\nillum 4\n";
        let material = &materials(text)[0];
        assert_eq!((material.name.as_str(), material.kd()), ("a b", [0.25; 3]));
        assert_eq!((material.shininess, material.ior), (65536.0, 1.25));
        assert_eq!((material.emission(), material.tint()), ([2.0; 3], [0.5, 1.0, 1.0]));
    }

    #[test]
    fn broken_lines_are_errors_with_their_number() {
        let message = |text: &str| {
            let prepared = prepare(text, Path::new("a.mtl"));
            prepared.and_then(|p| parse(&p, Path::new("a.mtl"))).unwrap_err().to_string()
        };
        assert!(message("newmtl x\nKd 1 2\n").starts_with("a.mtl:2: "));
        assert!(message("newmtl x\nKd\n").starts_with("a.mtl:2: "));
        assert!(message("newmtl x\nd 1\nNs many\n").starts_with("a.mtl:3: "));
        assert!(message("newmtl x\nKd spectral a.rfl\n").starts_with("a.mtl:2: "));
    }

    #[test]
    fn options_before_a_texture_are_skipped() {
        assert_eq!(skip_options("-s 1 1 1 -bm 0.5 wood floor.jpg"), "wood floor.jpg");
        assert_eq!(skip_options("-clamp on -o 0.5 a.png"), "a.png");
        assert_eq!(skip_options("a-b.png"), "a-b.png");
        assert_eq!(skip_options("-s"), "");
    }
}
