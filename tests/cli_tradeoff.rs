//! `octray tradeoff` through the real binary, and its page in a real browser.

use std::fs;
use std::path::Path;
use std::process::{Command as Plain, Output};
use std::sync::OnceLock;

use assert_cmd::Command;
use serde_json::Value;

fn tradeoff(folder: &Path, args: &str) -> Output {
    let mut command = Command::cargo_bin("octray").unwrap();
    command.current_dir(folder).arg("tradeoff").args(args.split_whitespace()).output().unwrap()
}

/// A scene with glass, mirrors and lights, measured once for all tests: the report, and the page.
fn measured() -> &'static (Value, String) {
    static MEASURED: OnceLock<(Value, String)> = OnceLock::new();
    MEASURED.get_or_init(|| {
        let folder = tempfile::tempdir().unwrap();
        let output = tradeoff(folder.path(), "seed --size 32x24 --budget 8 -o out");
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        let read = |name: &str| fs::read_to_string(folder.path().join("out").join(name)).unwrap();
        (serde_json::from_str(&read("tradeoff.json")).unwrap(), read("tradeoff.html"))
    })
}

fn number(row: &Value, path: &str) -> f64 {
    row.pointer(path).and_then(Value::as_f64).unwrap_or_else(|| panic!("{path} in {row}"))
}

#[test]
fn more_samples_are_slower_and_better_and_the_front_is_unbeaten() {
    let (report, _) = measured();
    let rows = report["rows"].as_array().unwrap();
    let own = |spp: u64| {
        let is_own = |row: &&Value| {
            row["change"].is_null() && row["setting"]["tier"] == "watertight" && row["setting"]["spp"] == spp
        };
        rows.iter().find(is_own).unwrap_or_else(|| panic!("no row of {spp} samples"))
    };
    for figure in ["rmse", "relative_mse", "flip", "max_error"] {
        let path = format!("/figures/{figure}");
        assert!(number(own(4), &path) < number(own(1), &path), "{figure}");
    }
    assert!(number(own(4), "/figures/psnr_db") > number(own(1), "/figures/psnr_db") + 3.0);
    assert!(number(own(4), "/rays") > 3.5 * number(own(1), "/rays"));
    assert_eq!(number(own(1), "/figures/wrong_visibility"), 0.0);
    for row in rows {
        let point = |row: &Value| [number(row, "/times/median_s"), number(row, "/figures/rmse")];
        let own = point(row);
        let beats = |[t, e]: [f64; 2]| t <= own[0] && e <= 1.01 * own[1] && (t < own[0] || e < own[1]);
        let beaten = rows.iter().any(|other| beats(point(other)));
        assert_eq!(row["on_front"], !beaten, "{row}");
        assert!(number(row, "/times/runs") >= 3.0 && number(row, "/times/least_s") <= own[0], "{row}");
    }
}

#[test]
fn every_choice_that_the_scene_has_is_there_and_no_other() {
    let (report, _) = measured();
    let rows = report["rows"].as_array().unwrap();
    let has = |change: &str| rows.iter().any(|row| row["change"] == change);
    for (change, expected) in [
        ("sampler", true),
        ("depth", true),
        ("cutoff", true),
        ("size", true),
        ("shadows", true),
        ("bounce", false),
    ] {
        assert_eq!(has(change), expected, "{change}");
    }
    for row in rows.iter().filter(|row| row["change"] == "depth" && row["setting"]["max_depth"] == 0) {
        assert!(number(row, "/figures/rmse") > 0.05, "without reflections nothing is like the truth: {row}");
    }
    let small = rows.iter().find(|row| row["setting"]["shrink"] == 4).expect("a quarter of the size");
    assert!(number(small, "/figures/wrong_visibility") > 0.02, "{small}");
    assert_eq!(report["truth"]["setting"]["tier"], "exact");
    assert!(number(&report["truth"], "/rmse_estimate") < 0.05);
}

#[test]
fn the_table_goes_to_standard_output_and_nothing_to_files_unless_asked() {
    let folder = tempfile::tempdir().unwrap();
    let output = tradeoff(folder.path(), "terrain:200 --size 16x12 --budget 1 -q");
    let told = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success() && output.stderr.is_empty());
    for word in ["truth: exact", "rmse", "flip", "* ", "watertight 1 spp"] {
        assert!(told.contains(word), "`{word}` is not in: {told}");
    }
    assert!(!told.contains("depth 0"), "nothing is mirrored there: {told}");
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
}

#[test]
fn bad_use_is_told_before_any_work() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("file"), "").unwrap();
    for (args, code) in [
        ("nothing-like-this", 2),
        ("missing.toml", 3),
        ("seed --budget 0", 2),
        ("seed -o file", 1),
        ("seed -o file/in", 1),
    ] {
        let output = tradeoff(folder.path(), args);
        assert_eq!(output.status.code(), Some(code), "{args}: {}", String::from_utf8_lossy(&output.stderr));
        assert!(output.stdout.is_empty() && !output.stderr.is_empty(), "{args}");
    }
}

/// Tells by the title what a browser has loaded and drawn.
const CHECK: &str = "<script>onload = () => {
    const sizes = [...document.images].map(image => image.naturalWidth + 'x' + image.naturalHeight);
    const count = (what) => document.querySelectorAll(what).length;
    const fits = document.documentElement.scrollWidth <= innerWidth;
    document.title = [sizes.join(' '), count('tbody tr'), count('svg circle'), innerWidth, fits].join(';');
}</script></body>";

/// What a browser makes of the page: all of it is there, without a network, and the pictures have pixels.
#[test]
fn a_browser_shows_the_page() {
    let Some(browser) = ["chromium", "chromium-browser", "google-chrome"].into_iter().find(|name| runs(name))
    else {
        return println!("skipped: no Chromium is installed");
    };
    let folder = tempfile::tempdir().unwrap();
    let (report, html) = measured();
    let page = folder.path().join("page.html");
    assert!(!html.contains("src=\"http") && !html.contains("href="), "the page needs nothing else");
    fs::write(&page, html.replace("</body>", CHECK)).unwrap();
    let [images, rows, dots, ..] = &seen(browser, folder.path(), &page, 1200)[..] else { panic!("no title") };
    assert!(images.split(' ').all(|size| size == "32x24") && images.split(' ').count() >= 5, "{images}");
    let [rows, dots] = [rows, dots].map(|count| count.parse::<usize>().unwrap());
    assert_eq!(rows, report["rows"].as_array().unwrap().len());
    assert!(dots > 2 * rows, "{dots} dots, one a row in two plots");
    for width in [1200, 800] {
        let seen = seen(browser, folder.path(), &page, width);
        assert_eq!(seen[3..], [width.to_string(), "true".into()], "the page is not wider than its window");
    }
}

fn runs(browser: &str) -> bool {
    Plain::new(browser).arg("--version").output().is_ok_and(|output| output.status.success())
}

/// What [`CHECK`] saw in a window so wide.
fn seen(browser: &str, folder: &Path, page: &Path, width: u32) -> Vec<String> {
    let dom = shown(browser, folder, page, width);
    let title = dom.split("<title>").nth(1).and_then(|rest| rest.split("</title>").next()).unwrap();
    title.split(';').map(str::to_owned).collect()
}

/// The page's content after its scripts have run.
fn shown(browser: &str, folder: &Path, page: &Path, width: u32) -> String {
    let size = format!("--window-size={width},900");
    let profile = format!("--user-data-dir={}", folder.join("profile").display());
    let flags = ["--headless", "--no-sandbox", "--disable-gpu", "--virtual-time-budget=5000", "--dump-dom"];
    let output = Plain::new(browser)
        .args(flags)
        .args([profile, size])
        .arg(format!("file://{}", page.display()))
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8_lossy(&output.stdout).into_owned()
}
