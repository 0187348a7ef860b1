//! The report as tables for people.

use super::report::{ClassReport, Report};

/// Rates and ratios of every class, their means over scenes, and what building cost.
pub fn table(report: &Report) -> String {
    let peers: Vec<Peer<'_>> = report.peers().into_iter().map(|name| Peer::of(report, name)).collect();
    let rays = ray_rows(report, &peers);
    let means = mean_rows(report, &peers);
    let (rows, builds) = ([rays, means].concat(), build_rows(report));
    let s = &report.settings;
    format!(
        "{} x {} camera rays, tier {}, {} thread{}, {} runs; Mrays/s: median, +- the farther end; \
         roof: {:.0} M box tests a second\n\n{}\n{}",
        s.size[0],
        s.size[1],
        s.tier,
        s.threads,
        if s.threads == 1 { "" } else { "s" },
        s.runs,
        report.peak_box_tests_s / 1e6,
        aligned(&rows),
        aligned(&builds),
    )
}

type Row = Vec<String>;

fn ray_rows(report: &Report, peers: &[Peer<'_>]) -> Vec<Row> {
    let head = ["scene", "class", "rays", "hit", "octray", "+-", "nodes", "blocks", "roof"];
    let mut head: Row = head.map(String::from).to_vec();
    head.extend(peers.iter().flat_map(|peer| peer.head()));
    let mut rows = vec![head];
    for scene in &report.scenes {
        rows.extend(scene.classes.iter().map(|class| {
            let mut row = vec![scene.scene.clone()];
            row.extend(own_cells(class));
            row.extend(peers.iter().flat_map(|peer| peer.cells(class)));
            row
        }));
    }
    rows
}

fn own_cells(class: &ClassReport) -> Row {
    let Some(own) = class.octray() else { return Vec::new() };
    let visits = |value: fn(&super::census::Visits) -> f64| {
        class.visits.as_ref().map_or("-".into(), |v| format!("{:.1}", value(v)))
    };
    vec![
        class.class.clone(),
        class.rays.to_string(),
        format!("{:.1}%", 100.0 * class.hit_share()),
        format!("{:.2}", own.mrays_s.median),
        format!("{:.0}%", 100.0 * own.mrays_s.noise()),
        visits(|v| v.nodes),
        visits(|v| v.blocks),
        class.roofline_share.map_or("-".into(), |share| format!("{:.0}%", 100.0 * share)),
    ]
}

/// The columns of another ray tracer.
struct Peer<'a> {
    name: &'a str,
    /// It has more than one mode, of which the best is named.
    has_modes: bool,
}

impl<'a> Peer<'a> {
    fn of(report: &'a Report, name: &'a str) -> Self {
        let classes = report.scenes.iter().flat_map(|scene| &scene.classes);
        let has_modes =
            classes.into_iter().any(|c| c.engines.iter().filter(|e| e.engine == name).count() > 1);
        Self { name, has_modes }
    }
    fn head(&self) -> Row {
        self.row([self.name, "best mode", "differ", "octray is"].map(String::from))
    }
    fn cells(&self, class: &ClassReport) -> Row {
        let Some((best, ratio)) = class.best_of(self.name).zip(class.ratio_to(self.name)) else {
            return self.row(["-"; 4].map(String::from));
        };
        let differ = best.differs.hits.to_string();
        self.row([format!("{:.2}", best.mrays_s.median), best.mode.clone(), differ, format!("{ratio:.2}x")])
    }
    fn means(&self, classes: &[&ClassReport]) -> Row {
        let rate = geometric_mean(classes.iter().filter_map(|c| Some(c.best_of(self.name)?.mrays_s.median)));
        let ratio = geometric_mean(classes.iter().filter_map(|c| c.ratio_to(self.name)));
        let text = |value: Option<f64>, unit: &str| value.map_or("-".into(), |v| format!("{v:.2}{unit}"));
        self.row([text(rate, ""), String::new(), String::new(), text(ratio, "x")])
    }
    fn row(&self, [rate, mode, differ, ratio]: [String; 4]) -> Row {
        if self.has_modes { vec![rate, mode, differ, ratio] } else { vec![rate, differ, ratio] }
    }
}

/// Geometric means over the scenes, a class a row.
fn mean_rows(report: &Report, peers: &[Peer<'_>]) -> Vec<Row> {
    let classes: Vec<&ClassReport> = report.scenes.iter().flat_map(|scene| &scene.classes).collect();
    let row = |name: &&str| {
        let of: Vec<&ClassReport> = classes.iter().copied().filter(|class| class.class == *name).collect();
        let rate = geometric_mean(of.iter().filter_map(|c| Some(c.octray()?.mrays_s.median)));
        let mut row: Row = ["geometric mean", name, "", ""].map(String::from).to_vec();
        row.push(rate.map_or("-".into(), |rate| format!("{rate:.2}")));
        row.extend([""; 4].map(String::from));
        row.extend(peers.iter().flat_map(|peer| peer.means(&of)));
        row
    };
    if report.scenes.len() < 2 { Vec::new() } else { report.classes().iter().map(row).collect() }
}

/// `None` of nothing.
fn geometric_mean(values: impl Iterator<Item = f64>) -> Option<f64> {
    let logarithms: Vec<f64> = values.map(f64::ln).collect();
    let count = logarithms.len() as f64;
    (count > 0.0).then(|| (logarithms.iter().sum::<f64>() / count).exp())
}

fn build_rows(report: &Report) -> Vec<Row> {
    let head = ["scene", "build", "primitives", "seconds", "Mprims/s", "bytes/prim"];
    let mut rows = vec![head.map(String::from).to_vec()];
    for scene in &report.scenes {
        rows.extend(scene.builds.iter().map(|build| {
            vec![
                scene.scene.clone(),
                format!("{}, {}", build.engine, build.mode),
                scene.primitives().to_string(),
                format!("{:.3}", build.seconds),
                format!("{:.2}", build.mprims_s),
                build.bytes_a_prim.map_or("-".into(), |bytes| format!("{bytes:.0}")),
            ]
        }));
    }
    rows
}

/// Columns of one width each: words to the left, numbers to the right.
pub(in crate::measure) fn aligned(rows: &[Row]) -> String {
    let columns = rows.iter().map(Vec::len).max().unwrap_or(0);
    let cell = |row: usize, column: usize| rows[row].get(column).map_or("", String::as_str);
    let width = |column| (0..rows.len()).map(|row| cell(row, column).chars().count()).max().unwrap_or(0);
    let is_number = |column| {
        let mut cells = (1..rows.len()).map(|row| cell(row, column)).filter(|text| !text.is_empty());
        cells.all(|text| text == "-" || text.starts_with(|c: char| c.is_ascii_digit()))
    };
    let widths: Vec<(usize, bool)> = (0..columns).map(|column| (width(column), is_number(column))).collect();
    let line = |row: usize| {
        let cells = widths.iter().enumerate().map(|(column, &(width, number))| match number {
            true => format!("{:>width$}", cell(row, column)),
            false => format!("{:width$}", cell(row, column)),
        });
        cells.collect::<Vec<_>>().join("  ").trim_end().to_owned() + "\n"
    };
    (0..rows.len()).map(line).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_stand_right_and_words_left() {
        let row = |cells: [&str; 3]| cells.map(String::from).to_vec();
        let text =
            aligned(&[row(["scene", "rays", "mode"]), row(["a", "12345", "8"]), row(["bunny", "1", "one"])]);
        assert_eq!(text, "scene   rays  mode\na      12345  8\nbunny      1  one\n");
        assert_eq!(aligned(&[]), "");
    }

    #[test]
    fn means_are_geometric() {
        let mean = geometric_mean([1.0, 4.0, 16.0].into_iter()).unwrap();
        assert!((mean - 4.0).abs() < 1e-12);
        assert_eq!(geometric_mean(std::iter::empty()), None);
    }
}
