use super::super::{CameraKind, Rgb, Tier};
use super::*;

const CAMERA: &str = "[camera]\nposition = [0, 0, -5]\nlook_at = [0, 0, 0]\n";

fn message(rest: &str) -> String {
    parse(&format!("{CAMERA}{rest}"), "s.toml").unwrap_err().to_string()
}

fn with_sets(rest: &str, sets: &[&str]) -> Result<SceneDescription, String> {
    let sets: Vec<String> = sets.iter().map(|s| (*s).to_owned()).collect();
    parse_with(&format!("{CAMERA}{rest}"), "s.toml", &sets).map_err(|e| e.to_string())
}

#[test]
fn unknown_keys_show_line_and_nearest_name() {
    let text = message("[[sphere]]\ncenter = [0, 0, 0]\nradus = 1.0\n");
    let expected = "s.toml:6:1: unknown key `radus`\n6 | radus = 1.0\n  | ^\n  help: did you mean `radius`?";
    assert!(text.starts_with(expected), "{text}");
    assert!(message("[[spher]]\nradius = 1\n").starts_with("s.toml:4:3: unknown key `spher`"));
    assert!(message("[[light.area]]\n").contains("s.toml:4:9: unknown key `area`"));
    assert!(message("[[group]]\nname = \"g\"\n[[group.plane]]\n").contains("unknown key `plane`"));
    let step = message("[[sphere]]\ncenter = [0,0,0]\nradius = 1\ntransform = [{ scal = 2 }]\n");
    assert!(step.contains("s.toml:7:16: unknown value `scal`") && step.contains("`scale`"), "{step}");
}

#[test]
fn wrong_types_and_missing_keys_show_their_line() {
    assert!(message("fov_deg = \"wide\"\n").starts_with("s.toml:4:11: invalid type: string"));
    assert!(message("[render]\ntier = \"exakt\"\n").starts_with("s.toml:5:8: unknown value `exakt`"));
    assert!(
        message("[[sphere]]\ncenter = [0, 0]\nradius = 1\n").starts_with("s.toml:5:10: invalid length 2")
    );
    assert!(message("[render]\nspp = -3\n").starts_with("s.toml:5:7: "));
    assert!(message("[[sphere]]\nradius = 1\n").starts_with("s.toml:4:1: missing key `center`"));
    assert!(message("[[material]]\nname = \"a\"\nkd = [1, 2]\n").starts_with("s.toml:6:6: invalid length 2"));
    assert!(message("[[material]]\nname = \"a\"\nkd = \"red\"\n").contains("a number or an array of three"));
}

#[test]
fn arrays_with_too_many_elements_show_their_line() {
    let text =
        parse("[camera]\nposition = [0, 0, -5, 7]\nlook_at = [0, 0, 0]\n", "s.toml").unwrap_err().to_string();
    assert!(text.starts_with("s.toml:2:12: invalid length 4, expected an array of length 3"), "{text}");
    assert!(message("[render]\nsize = [4, 3, 2, 1]\n").starts_with("s.toml:5:8: invalid length 4, expected"));
    let text = with_sets("", &["render.size=[4, 3, 2]"]).unwrap_err();
    assert!(
        text.starts_with("--set render.size=[4, 3, 2]: invalid length 3, expected an array of length 2"),
        "{text}"
    );
    let four = message("[[triangle]]\nvertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]\n");
    assert!(four.starts_with("s.toml:5:12: invalid length 4, expected an array of length 3"), "{four}");
}

/// A scene with every key that takes an array of a fixed length.
const ARRAYS: &str = "[camera]\nposition = [0, 0, -5]\nlook_at = [0, 0, 0]\nup = [0, 1, 0]
    transform = [{ translate = [0, 0, 1] }, { matrix = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]] }]
    [render]\nsize = [4, 3]\n[background]\ncolor = [0, 0, 1]
    [[material]]\nname = 'a'\nkd = [1, 1, 1]\nks = [0, 0, 0]\nka = [0, 0, 0]\nemission = [1, 1, 2]
    [[light.point]]\nposition = [0, 5, 0]\ncolor = [1, 1, 2]\nintensity = 1
    [[light.directional]]\ndirection = [0, -1, 0]\nintensity = 1
    [[light.spot]]\nposition = [0, 5, 0]\nlook_at = [0, 0, 0]\ncone_deg = 30\nintensity = 1
    [[sphere]]\ncenter = [0, 0, 0]\nradius = 1\ntransform = [{ scale = [1, 2, 3] }]
    [[cylinder]]\nfrom = [0, 0, 0]\nto = [0, 1, 0]\nradius = 1
    [[cylinder]]\ncenter = [0, 0, 0]\nhalf_height = 1\nradius = 1
    [[triangle]]\nvertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]
    transform = [{ rotate_deg = { axis = [0, 1, 0], angle = 9 } }]
    [[quad]]\norigin = [0, 0, 0]\nedge_u = [1, 0, 0]\nedge_v = [0, 1, 0]
    [[plane]]\npoint = [0, 0, 0]\nnormal = [0, 1, 0]
    [[mesh]]\nvertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]\nfaces = [[0, 1, 2]]\n";

/// Lengthens the `n`-th array of numbers by one; false if there are fewer.
fn lengthen(value: &mut toml::Value, n: &mut usize) -> bool {
    match value {
        toml::Value::Table(table) => {
            table.iter_mut().filter(|(key, _)| *key != "faces").any(|(_, value)| lengthen(value, n))
        }
        toml::Value::Array(array) if array.iter().all(|v| v.is_integer() || v.is_float()) => {
            array.push(toml::Value::Integer(0));
            let is_it = *n == 0;
            if !is_it {
                array.pop();
                *n -= 1;
            }
            is_it
        }
        toml::Value::Array(array) => array.iter_mut().any(|value| lengthen(value, n)),
        _ => false,
    }
}

#[test]
fn no_array_drops_what_is_too_much() {
    parse(ARRAYS, "s.toml").unwrap();
    let longer = |n: usize| {
        let mut scene = toml::Value::Table(ARRAYS.parse().unwrap());
        lengthen(&mut scene, &mut n.clone()).then(|| toml::to_string(&scene).unwrap())
    };
    let scenes: Vec<String> = (0..).map_while(longer).collect();
    assert_eq!(scenes.len(), 35);
    for scene in scenes {
        let text = parse(&scene, "s.toml").unwrap_err().to_string();
        assert!(text.contains("invalid length"), "{text} in {scene}");
    }
}

/// Puts `wrong` in the place of the `n`-th value, tables and arrays counted; false if there are fewer.
fn spoil(value: &mut toml::Value, n: &mut usize, wrong: &toml::Value) -> bool {
    if *n == 0 {
        *value = wrong.clone();
        return true;
    }
    *n -= 1;
    match value {
        toml::Value::Table(table) => table.iter_mut().any(|(_, value)| spoil(value, n, wrong)),
        toml::Value::Array(array) => array.iter_mut().any(|value| spoil(value, n, wrong)),
        _ => false,
    }
}

#[test]
fn wrong_types_are_told_in_the_words_of_toml() {
    let wrong: toml::Table = "all = [true, 3, -3, 1.5, 'x', [], [3], {}, { x = 3 }]".parse().unwrap();
    let mut told = 0;
    for wrong in wrong["all"].as_array().unwrap() {
        let spoilt = |n: usize| {
            let mut scene = toml::Value::Table(ARRAYS.parse().unwrap());
            spoil(&mut scene, &mut n.clone(), wrong).then(|| toml::to_string(&scene).unwrap())
        };
        // From 1: what is in place of the whole file would be no file.
        for scene in (1..).map_while(spoilt) {
            let Err(DescribeError::Invalid(faults)) = parse(&scene, "s.toml") else { continue };
            for message in faults.iter().map(|fault| &fault.message) {
                let foreign =
                    ["struct", "enum", "variant", "f64", "u32", "u64", "sequence", "map", "wanted", "field"];
                assert!(!foreign.iter().any(|word| message.contains(word)), "{message} in {scene}");
            }
            told += 1;
        }
    }
    assert!(told > 1000, "{told}");
    assert!(parse("camera = 3", "s.toml").unwrap_err().to_string().contains("integer `3`, expected a table"));
    let array = parse("camera = []", "s.toml").unwrap_err().to_string();
    assert!(array.contains("invalid type: array, expected a table"), "{array}");
    let tricky = message("fov_deg = 'a, expected struct Camera'\n");
    assert!(tricky.contains("string \"a, expected struct Camera\", expected a number"), "{tricky}");
}

#[test]
fn empty_and_cut_off_files() {
    assert!(parse("", "s.toml").unwrap_err().to_string().starts_with("s.toml:1:1: missing key `camera`"));
    assert!(message("[[sphere]]\ncenter = [0, 0").starts_with("s.toml:5:"));
    assert!(message("[[sphe").starts_with("s.toml:4:"));
}

#[test]
fn the_scene_of_the_readme() {
    let rest = "[background]\ncolor = [0.24, 0.34, 0.50]\n[[material]]\nname = \"gold\"\nkind = \"metal\"\nkd = 0.5\n\
        [[cylinder]]\nfrom = [0.75, -1.5, 0.5]\nto = [0.75, -0.8, 0.5]\nradius = 0.35\nmaterial = \"gold\"\n\
        [[mesh]]\npath = \"bunny.obj\"\ntransform = [{ scale = 10 }, { rotate_deg = { axis = [0, 1, 0], angle = 30 } }]\n";
    let scene = with_sets(rest, &[]).unwrap();
    assert_eq!(scene.material[0].kd(), [0.5; 3]);
    assert_eq!(scene.background.ambient(), [0.24, 0.34, 0.50]);
    assert_eq!(scene.mesh[0].transform.0.len(), 2);
    assert_eq!((scene.render.spp, scene.render.max_depth), (16, 6));
}

#[test]
fn sets_change_values_by_place_and_name() {
    let rest =
        "[[material]]\nname = \"glass\"\nkind = \"dielectric\"\n[[sphere]]\ncenter = [0,0,0]\nradius = 1\n";
    let sets = [
        "camera.fov_deg=40",
        "material.glass.ior = 1.4",
        "sphere.0.radius=2",
        "sphere.0.center.1=7",
        "render.tier=exact",
        "render.size=[32, 16]",
        "camera.kind=\"orthographic\"",
        "camera.height=3",
        "background.color=0.5",
    ];
    let scene = with_sets(rest, &sets).unwrap();
    assert_eq!((scene.camera.fov_deg, scene.camera.kind), (40.0, CameraKind::Orthographic));
    assert_eq!((scene.material[0].ior, scene.sphere[0].radius), (1.4, 2.0));
    assert_eq!((scene.sphere[0].center, scene.render.size), ([0.0, 7.0, 0.0], [32, 16]));
    assert_eq!((scene.render.tier, scene.background.color), (Tier::Exact, Some(Rgb::grey(0.5))));
}

#[test]
fn wrong_sets_say_so() {
    let rest = "[[material]]\nname = \"glass\"\n[[sphere]]\ncenter = [0,0,0]\nradius = 1\n";
    for (set, part) in [
        ("camera.fov=40", "--set camera.fov=40: unknown key `fov`\n  help: did you mean `fov_deg`?"),
        ("camra.fov_deg=40", "--set camra.fov_deg=40: unknown key `camra`\n  help: did you mean `camera`?"),
        ("material.glas.ior=2", "no element named `glas`\n  help: did you mean `material.glass`?"),
        ("sphere.3.radius=2", "`sphere` has 1 elements"),
        ("quad.0.origin=2", "the scene has no `quad`"),
        ("sphere.0.radius=0", "--set sphere.0.radius=0: `radius` must be above 0"),
        ("sphere.0.radius=big", "--set sphere.0.radius=big: invalid type: string \"big\""),
        ("sphere.0.radius.x=1", "`sphere.0.radius` has no `x` inside: it is of type integer"),
        ("sphere.0.material=glas", "--set sphere.0.material=glas: there is no material named `glas`"),
        ("fov_deg", "needs the form key=value"),
        ("a..b=1", "is not a key"),
        ("render={spp=0}", "--set render={spp=0}: `spp` must be at least 1"),
    ] {
        let text = with_sets(rest, &[set]).unwrap_err();
        assert!(text.contains(part) && text.starts_with("--set"), "{set}: {text}");
    }
}

#[test]
fn the_second_set_is_told_from_the_first() {
    let text = with_sets("", &["render.spp=4", "render.sp=4"]).unwrap_err();
    assert!(text.starts_with("--set render.sp=4: unknown key `sp`"), "{text}");
}

#[test]
fn files_give_their_folder_and_their_name() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.toml");
    std::fs::write(&path, CAMERA).unwrap();
    let scene = read(&path).unwrap();
    assert_eq!(scene.resolve("a.obj".as_ref()), folder.path().join("a.obj"));
    std::fs::write(&path, b"[camera]\n# \xff").unwrap();
    assert!(read(&path).unwrap_err().to_string().contains("byte 11 is not UTF-8"));
    assert!(matches!(read("no/such.toml".as_ref()), Err(DescribeError::Read { .. })));
}

#[test]
fn broken_scenes_never_panic() {
    let text = super::super::builtin("seed").unwrap().unwrap().to_toml();
    let pieces = ["nan", "[[", "]]", "=", "\"", "{", "}", "-1", "0", "1e999", "[sphere]", "\n", "ä"];
    let mut state = 7u64;
    let mut below = |limit: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % limit
    };
    for _ in 0..2000 {
        let mut broken = text.clone();
        let at = below(broken.len());
        let until = (at + below(30)).min(broken.len());
        broken.replace_range(at..until, pieces[below(pieces.len())]);
        let set =
            format!("{}={}", ["sphere.0.radius", "a", "material.red.kd", "."][below(4)], pieces[below(13)]);
        for sets in [vec![], vec![set]] {
            if let Err(error) = parse_with(&broken, "s.toml", &sets) {
                assert!(error.to_string().contains(": "));
            }
        }
    }
}
