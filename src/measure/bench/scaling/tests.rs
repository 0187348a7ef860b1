use super::*;
use crate::measure::bench::timing::Spread;
use crate::measure::bench::{BuildReport, ClassReport, Difference, EngineReport, Settings};

fn class(name: &str, nanoseconds: f64) -> ClassReport {
    let rate = 1e3 / nanoseconds;
    let engine = EngineReport {
        engine: "octray".into(),
        mode: "auto".into(),
        mrays_s: Spread { median: rate, min: rate, max: rate },
        differs: Difference::default(),
        counters: None,
    };
    ClassReport {
        class: name.into(),
        rays: 1,
        hits: 1,
        fingerprint: String::new(),
        brute_force_rays: 0,
        visits: None,
        roofline_share: None,
        engines: vec![engine],
    }
}

/// Builds in a microsecond a primitive, 60 bytes each, and rays in 10 + 2 log2 n nanoseconds.
fn scene(triangles: usize) -> SceneReport {
    let n = triangles as f64;
    SceneReport {
        scene: format!("terrain-{triangles}"),
        triangles,
        spheres: 0,
        cylinders: 0,
        builds: vec![BuildReport::new("octray", "default", triangles, 1e-6 * n, Some(60.0 * n))],
        classes: vec![class("primary", 10.0 + 2.0 * n.log2())],
    }
}

fn report(scenes: Vec<SceneReport>) -> Report {
    Report {
        octray: "test".into(),
        settings: Settings {
            tier: "watertight".into(),
            build_quality: "balanced".into(),
            threads: 1,
            size: [8, 8],
            runs: 3,
        },
        peak_box_tests_s: 1e9,
        scenes,
        scaling: None,
    }
}

/// In an order that no file system would give.
fn known() -> Report {
    report([1 << 20, 1 << 10, 1 << 15, 1 << 25].map(scene).to_vec())
}

#[test]
fn known_laws_are_found_in_a_report() {
    let scaling = Scaling::of(&known()).unwrap();
    let curve = |i: usize| &scaling.curves[i];
    assert_eq!(
        scaling.curves.iter().map(|c| &c.name[..]).collect::<Vec<_>>(),
        ["build", "memory", "primary"]
    );
    assert!(scaling.curves.iter().all(|curve| curve.deviation.abs() < 1e-9), "{scaling:?}");
    let Law::Power { factor, exponent } = curve(0).law else { panic!() };
    assert!((factor - 1e-6).abs() < 1e-12 && (exponent - 1.0).abs() < 1e-9);
    let Law::Power { factor, exponent } = curve(1).law else { panic!() };
    assert!((factor - 60.0).abs() < 1e-9 && exponent.abs() < 1e-9);
    let Law::Logarithm { start, a_doubling } = curve(2).law else { panic!() };
    assert!((start - 10.0).abs() < 1e-9 && (a_doubling - 2.0).abs() < 1e-9);
    assert!(curve(2).points.is_sorted_by_key(|point| point.primitives));
}

/// A cliff shows in what no law explains and in the step where it is.
#[test]
fn a_cliff_is_named() {
    let mut cliff = known();
    cliff.scenes[3].classes[0] = class("primary", 200.0);
    let curve = Scaling::of(&cliff).unwrap().curves.remove(2);
    assert!(curve.deviation.abs() > 0.2, "{}", curve.deviation);
    assert_eq!([curve.steepest.from, curve.steepest.to], [1 << 20, 1 << 25]);
    assert!((curve.steepest.exponent - (200.0_f64 / 50.0).log2() / 5.0).abs() < 1e-9);
}

#[test]
fn too_few_sizes_have_no_law() {
    assert_eq!(Scaling::of(&report(vec![])), Err(TooFewSizes(0)));
    assert_eq!(Scaling::of(&report(vec![scene(10), scene(20), scene(10)])), Err(TooFewSizes(2)));
    assert!(Scaling::expects(2).is_err() && Scaling::expects(3).is_ok());
    let mut some = known();
    some.scenes.iter_mut().take(2).for_each(|scene| scene.classes.push(class("ao", 1.0)));
    assert_eq!(Scaling::of(&some).unwrap().curves.len(), 3, "two sizes of `ao` are no law");
}

#[test]
fn the_table_has_a_row_for_each_size_and_each_law() {
    let table = Scaling::of(&known()).unwrap().table();
    let rows: Vec<Vec<&str>> = table.lines().map(|line| line.split_whitespace().collect()).collect();
    assert!(rows.contains(&vec!["32768", "0.0328", "60.0", "40.0"]), "{table}");
    assert!(rows.iter().any(|row| row.starts_with(&["primary", "ns", "10.000", "+", "2.000", "log2", "n"])));
}

#[test]
fn the_report_keeps_its_laws() {
    let mut known = known();
    known.scaling = Some(Scaling::of(&known).unwrap());
    let text = serde_json::to_string(&known).unwrap();
    assert!(text.contains(r#""form":"logarithm""#), "{text}");
    let read: Report = serde_json::from_str(&text).unwrap();
    assert_eq!(read.scaling.unwrap().curves.len(), 3);
}

/// Every size is a dot on every curve, within the picture.
#[test]
fn the_plot_is_xml_with_all_points_and_laws() {
    let scaling = Scaling::of(&known()).unwrap();
    let svg = scaling_plot(&scaling).unwrap();
    let xml = roxmltree::Document::parse(&svg).unwrap();
    let named = |name: &'static str| xml.descendants().filter(move |node| node.has_tag_name(name));
    let number = |node: roxmltree::Node, name: &str| node.attribute(name).unwrap().parse::<f64>().unwrap();
    let [width, height] = ["width", "height"].map(|side| number(xml.root_element(), side));
    let dots: Vec<_> = named("circle").collect();
    assert_eq!(dots.len(), 3 * 4 + 3, "a dot for each point, and for each curve one in a legend");
    for dot in &dots {
        assert!((0.0..width).contains(&number(*dot, "cx")) && (0.0..height).contains(&number(*dot, "cy")));
    }
    let words: String = named("text").filter_map(|node| node.text()).collect();
    for curve in &scaling.curves {
        assert!(words.contains(&format!("{}: {}", curve.name, curve.law)), "{words}");
    }
}

#[test]
fn costs_that_fall_through_zero_are_drawn_too() {
    let scenes = [(10, 100.0), (1_000, 1.0), (100_000, 0.01)].map(|(n, cost)| {
        let classes = vec![class("primary", cost)];
        SceneReport { classes, ..scene(n) }
    });
    let svg = scaling_plot(&Scaling::of(&report(scenes.to_vec())).unwrap()).unwrap();
    assert!(roxmltree::Document::parse(&svg).is_ok() && !svg.contains("NaN") && !svg.contains("inf"));
}
