//! A description back to TOML text, and the JSON Schema of scene files.

use super::SceneDescription;
use toml::{Table, Value};

/// Keys in the order a person would write them; whatever is missing here follows by the alphabet.
const KEY_ORDER: &[&str] = &[
    "camera",
    "render",
    "background",
    "material",
    "light",
    "name",
    "of",
    "kind",
    "point",
    "directional",
    "spot",
    "position",
    "direction",
    "look_at",
    "up",
    "fov_deg",
    "cone_deg",
    "penumbra_deg",
    "height",
    "size",
    "spp",
    "max_depth",
    "shadows",
    "color",
    "bottom",
    "top",
    "ambient",
    "intensity",
    "ka",
    "kd",
    "ks",
    "tint",
    "shininess",
    "attenuation",
    "ior",
    "center",
    "from",
    "to",
    "half_height",
    "radius",
    "sigma",
    "origin",
    "edge_u",
    "edge_v",
    "vertices",
    "faces",
    "path",
    "procedural",
    "axis",
    "angle",
    "plane",
    "sphere",
    "cylinder",
    "triangle",
    "quad",
    "mesh",
    "material",
    "transform",
    "group",
    "instance",
];

impl SceneDescription {
    /// TOML text that [`parse`](super::parse) reads back to the same description.
    #[must_use]
    pub fn to_toml(&self) -> String {
        let table = Table::try_from(self).expect("a description has only strings as keys");
        let mut text = String::new();
        write_table(&mut text, "", &table);
        text
    }
}

/// The JSON Schema of scene files.
#[must_use]
pub fn schema() -> String {
    let schema = schemars::schema_for!(SceneDescription);
    serde_json::to_string_pretty(&schema).expect("a schema is plain JSON")
}

/// Writes plain keys first, then tables and arrays of tables under their headers.
fn write_table(text: &mut String, path: &str, table: &Table) {
    let mut entries: Vec<(&String, &Value)> = table.iter().collect();
    entries.sort_by_key(|(key, _)| KEY_ORDER.iter().position(|k| k == key).unwrap_or(KEY_ORDER.len()));
    let has_header =
        |key: &str, value: &Value| value.is_table() && key != "procedural" || is_tables(key, value);
    for (key, value) in entries.iter().filter(|(key, value)| !has_header(key, value)) {
        if !is_empty(value) {
            text.push_str(&format!("{key} = {value}\n"));
        }
    }
    for (key, value) in entries.iter().filter(|(key, value)| has_header(key, value)) {
        let path = if path.is_empty() { (*key).clone() } else { format!("{path}.{key}") };
        write_headed(text, &path, value);
    }
}

fn write_headed(text: &mut String, path: &str, value: &Value) {
    match value {
        Value::Table(table) => {
            // `[light]` alone would say nothing: its tables carry their own headers.
            if table.iter().any(|(key, value)| !is_tables(key, value) && !is_empty(value)) {
                header(text, &format!("[{path}]"));
            }
            write_table(text, path, table);
        }
        Value::Array(elements) => {
            for element in elements.iter().filter_map(Value::as_table) {
                header(text, &format!("[[{path}]]"));
                write_table(text, path, element);
            }
        }
        _ => unreachable!("only tables have headers"),
    }
}

fn header(text: &mut String, line: &str) {
    if !text.is_empty() {
        text.push('\n');
    }
    text.push_str(line);
    text.push('\n');
}

/// Arrays of tables, except the steps of a transform, which read better in one line.
fn is_tables(key: &str, value: &Value) -> bool {
    let tables = value.as_array().is_some_and(|array| array.first().is_some_and(Value::is_table));
    tables && key != "transform"
}

fn is_empty(value: &Value) -> bool {
    value.as_array().is_some_and(Vec::is_empty)
}

#[cfg(test)]
mod tests {
    use super::super::{builtin, builtin_scenes, parse, parse_with};
    use super::*;

    #[test]
    fn every_builtin_scene_reads_back_the_same() {
        for scene in builtin_scenes() {
            let written = builtin(scene.name).unwrap().unwrap();
            let text = written.to_toml();
            let read = parse(&text, scene.name).unwrap_or_else(|e| panic!("{}: {e}", scene.name));
            assert_eq!(read, written, "{}", scene.name);
            assert_eq!(parse_with(&text, scene.name, &["render.spp=3".into()]).unwrap().render.spp, 3);
        }
    }

    #[test]
    fn terrain_is_written_in_one_line() {
        let text = builtin("terrain:500").unwrap().unwrap().to_toml();
        assert!(text.contains("procedural = { kind = \"terrain\", seed = 0, triangles = 500 }"), "{text}");
    }

    #[test]
    fn groups_carry_their_tables() {
        let text = builtin("instances").unwrap().unwrap().to_toml();
        assert!(text.contains("\n[[group]]\nname = ") && text.contains("\n[[group.sphere]]\n"), "{text}");
        assert!(text.contains("transform = [{ "), "{text}");
    }

    #[test]
    fn schema_names_every_table_and_refuses_unknown_keys() {
        let schema: serde_json::Value = serde_json::from_str(&schema()).unwrap();
        let properties = schema["properties"].as_object().unwrap();
        for key in ["camera", "render", "material", "light", "sphere", "mesh", "instance"] {
            assert!(properties.contains_key(key), "{key}");
        }
        assert_eq!(schema["additionalProperties"], false);
        assert!(!properties.contains_key("folder"));
        let sphere = &schema["$defs"]["Sphere"];
        assert_eq!(sphere["additionalProperties"], false);
        assert_eq!(sphere["required"], serde_json::json!(["center", "radius"]));
    }
}
