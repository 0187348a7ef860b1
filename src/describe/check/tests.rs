use super::super::{DescribeError, parse};

const CAMERA: &str = "[camera]\nposition = [0, 0, -5]\nlook_at = [0, 0, 0]\n";

/// The first complaint about a scene: line, column, message and help.
fn fault(rest: &str) -> (usize, usize, String) {
    match parse(&format!("{CAMERA}{rest}"), "s.toml") {
        Err(DescribeError::Invalid(all)) => {
            let first = &all[0];
            let help = first.help.as_ref().map(|help| format!(" ({help})")).unwrap_or_default();
            (first.line, first.column, format!("{}{help}", first.message))
        }
        other => panic!("expected a complaint about {rest:?}, got {other:?}"),
    }
}

/// Complaints name the line they stand in, and say this.
fn expect(rest: &str, line: usize, part: &str) {
    let (found, _, message) = fault(rest);
    assert_eq!(found, line, "{rest}: {message}");
    assert!(message.contains(part), "{rest}: {message}");
}

#[test]
fn numbers_out_of_range() {
    expect("[[sphere]]\ncenter = [0, 0, 0]\nradius = 0\n", 6, "`radius` must be above 0");
    expect("[[sphere]]\ncenter = [0, 0, 0]\nradius = -1\n", 6, "`radius` must be above 0");
    expect("[[sphere]]\nradius = 1\ncenter = [0, nan, 0]\n", 6, "`center` has no place for NaN");
    expect("[[sphere]]\nradius = inf\ncenter = [0, 0, 0]\n", 5, "`radius`");
    expect("[[plane]]\npoint = [0, 0, 0]\nnormal = [0, 0, 0]\n", 6, "has no direction");
    expect("[render]\nspp = 0\n", 5, "at least 1 sample");
    expect("[render]\nmax_depth = 257\n", 5, "more than 256");
    expect("[render]\nsize = [0, 480]\n", 5, "no pixel");
    expect("[render]\nsize = [1000000000, 1000000000]\n", 5, "more than 2^28 pixels");
    expect("[[material]]\nname = \"a\"\nior = 0\n", 6, "`ior` must be above 0");
    expect("[[material]]\nname = \"a\"\nkd = [0, -1, 0]\n", 6, "`kd` must not be negative");
    expect("[[light.point]]\nposition = [0, 0, 0]\nintensity = -2\n", 6, "`intensity` must not be negative");
    expect("[[light.directional]]\ndirection = [0, 0, 0]\nintensity = 2\n", 5, "has no direction");
    expect(
        "[[light.spot]]\nposition = [0, 0, 0]\nlook_at = [0, 0, 0]\ncone_deg = 9\nintensity = 1\n",
        6,
        "nowhere",
    );
}

#[test]
fn cameras_that_see_nothing() {
    for fov in ["0", "180", "nan", "-10"] {
        expect(&format!("fov_deg = {fov}\n"), 4, "above 0 and below 180");
    }
    expect("up = [0, 0, 7]\n", 4, "points along the view");
    expect("up = [0, 0, 0]\n", 4, "no direction");
    expect("kind = \"orthographic\"\n", 1, "needs `height`");
    let nowhere = "[camera]\nposition = [1, 2, 3]\nlook_at = [1, 2, 3]\n";
    let message = parse(nowhere, "s.toml").unwrap_err().to_string();
    assert!(message.starts_with("s.toml:3:11: `look_at` is the same point"), "{message}");
}

#[test]
fn names() {
    let two = "[[material]]\nname = \"glass\"\n[[material]]\nname = \"glass\"\n";
    expect(two, 7, "another material named `glass`");
    let misspelt =
        "[[material]]\nname = \"glass\"\n[[sphere]]\ncenter = [0,0,0]\nradius = 1\nmaterial = \"glas\"\n";
    expect(misspelt, 9, "no material named `glas` (did you mean `glass`?)");
    expect("[[instance]]\nof = \"tree\"\n", 5, "no group or named mesh named `tree`");
    let same = "[[group]]\nname = \"a\"\n[[mesh]]\nname = \"a\"\npath = \"a.obj\"\n";
    expect(same, 7, "another group or mesh named `a`");
}

#[test]
fn groups_inside_themselves() {
    expect("[[group]]\nname = \"a\"\n[[group.instance]]\nof = \"a\"\n", 7, "group `a` would contain itself");
    let circle = "[[group]]\nname = \"a\"\n[[group.instance]]\nof = \"b\"\n\
                  [[group]]\nname = \"b\"\n[[group.instance]]\nof = \"c\"\n\
                  [[group]]\nname = \"c\"\n[[group.instance]]\nof = \"a\"\n";
    expect(circle, 15, "group `a` would contain itself");
    let diamond =
        format!("{CAMERA}{}", circle.replace("of = \"a\"", "of = \"d\"") + "[[group]]\nname = \"d\"\n");
    parse(&diamond, "s.toml").unwrap();
}

#[test]
fn groups_as_deep_as_may_be() {
    let group = |i: usize| format!("[[group]]\nname = \"g{i}\"\n[[group.instance]]\nof = \"g{}\"\n", i + 1);
    let chain = |levels: usize| {
        let groups: String = (1..levels).map(group).collect();
        format!("{groups}[[group]]\nname = \"g{levels}\"\n")
    };
    parse(&format!("{CAMERA}{}", chain(256)), "s.toml").unwrap();
    expect(&chain(257), 5, "groups are nested more than 256 deep");
    expect(&chain(5_000), 5 + 4 * (5_000 - 257), "groups are nested more than 256 deep");
}

#[test]
fn transforms_that_flatten() {
    let sphere = "[[sphere]]\ncenter = [0, 0, 0]\nradius = 1\n";
    expect(&format!("{sphere}transform = [{{ scale = [1, 0, 1] }}]\n"), 7, "must not be 0");
    expect(
        &format!("{sphere}transform = [{{ rotate_deg = {{ axis = [0, 0, 0], angle = 3 }} }}]\n"),
        7,
        "no direction",
    );
    let flat = "transform = [{ matrix = [[1, 2, 3, 0], [2, 4, 6, 0], [0, 0, 1, 0]] }]\n";
    expect(&format!("{sphere}{flat}"), 7, "is singular");
    expect(&format!("{sphere}transform = [{{ matrix = [[1, 0, 0, 0]] }}]\n"), 7, "needs 3 or 4 rows");
    let last_row = "transform = [{ matrix = [[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,1,1]] }]\n";
    expect(&format!("{sphere}{last_row}"), 7, "fourth row");
    let tiny = format!("{CAMERA}{sphere}transform = [{{ scale = [1e-9, 1, -1e-9] }}]\n");
    parse(&tiny, "s.toml").unwrap();
}

#[test]
fn shapes_written_two_ways_or_not_at_all() {
    expect("[[cylinder]]\nfrom = [0, 0, 0]\nradius = 1\n", 4, "needs either");
    let both = "[[cylinder]]\nfrom = [0,0,0]\nto = [0,1,0]\ncenter = [0,0,0]\nhalf_height = 1\nradius = 1\n";
    expect(both, 4, "needs either");
    expect("[[cylinder]]\nfrom = [1, 1, 1]\nto = [1, 1, 1]\nradius = 1\n", 6, "axis has no length");
    expect("[[quad]]\norigin = [0,0,0]\nedge_u = [1,2,3]\nedge_v = [2,4,6]\n", 7, "no area");
    expect("[[mesh]]\nname = \"a\"\n", 4, "exactly one of");
    expect("[[mesh]]\nvertices = [[0,0,0],[1,0,0],[0,1,0]]\nfaces = [[0,1,2],[0,1,3]]\n", 6, "no vertex 3");
    expect("[background]\nbottom = 1\n", 4, "needs both");
    expect("[background]\ncolor = 1\nbottom = 1\ntop = 1\n", 5, "excludes");
    let metal = "[[material]]\nname = \"a\"\nkind = \"metal\"\nbounce = true\n";
    expect(metal, 7, "for diffuse materials only");
}

#[test]
fn several_faults_are_told_at_once() {
    let text = format!("{CAMERA}[render]\nspp = 0\n[[sphere]]\ncenter = [0, 0, 0]\nradius = 0\n");
    let message = parse(&text, "s.toml").unwrap_err().to_string();
    assert!(message.contains("s.toml:5:7:") && message.contains("s.toml:8:10:"), "{message}");
}

#[test]
fn faults_of_a_description_made_by_code_have_paths() {
    let mut scene = parse(&format!("{CAMERA}[[sphere]]\ncenter = [0,0,0]\nradius = 1\n"), "s.toml").unwrap();
    scene.sphere[0].radius = f64::NAN;
    let faults = scene.check().unwrap_err();
    assert_eq!(faults[0].path(), "sphere.0.radius");
    assert!(faults[0].to_string().starts_with("sphere.0.radius: `radius` must be above 0"));
}
