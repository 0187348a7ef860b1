//! An earlier report, and whether this one is slower.

use std::path::{Path, PathBuf};

use super::report::{EngineReport, Report};
use super::table::aligned;

/// What runs of the same program differ by even where each of them shows no spread.
const LEAST_NOISE: f64 = 0.05;

/// A report of an earlier run.
#[derive(Clone, Debug, PartialEq)]
pub struct Baseline {
    path: PathBuf,
    report: Report,
}

/// Why there is nothing to compare with.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum BaselineError {
    /// The file cannot be read.
    #[error("cannot read {}", .path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// The file is no report.
    #[error("{}:{line}:{column}: not a report of `octray bench --json`: {message}", .path.display())]
    Malformed {
        /// The file.
        path: PathBuf,
        /// Line, from 1; 0 where the file as a whole is meant.
        line: usize,
        /// Column, from 1.
        column: usize,
        /// What was expected.
        message: String,
    },
    /// The report is of something else.
    #[error("{}: was taken with {then}, this run with {now}", .path.display())]
    Other {
        /// The file.
        path: PathBuf,
        /// Settings then.
        then: String,
        /// Settings now.
        now: String,
    },
    /// No class of a scene is in both.
    #[error("{}: has none of the scenes and classes of this run", .path.display())]
    Nothing {
        /// The file.
        path: PathBuf,
    },
}

/// A class of rays then and now.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    /// Scene.
    pub scene: String,
    /// Class.
    pub class: String,
    /// Median rate now over median rate then.
    pub ratio: f64,
    /// The least and the most that the ratio may be, given how far the runs spread.
    pub bounds: [f64; 2],
}

impl Comparison {
    fn of(scene: &str, class: &str, then: &EngineReport, now: &EngineReport) -> Self {
        let (then, now) = (&then.mrays_s, &now.mrays_s);
        let bounds = [now.min / then.max * (1.0 - LEAST_NOISE), now.max / then.min * (1.0 + LEAST_NOISE)];
        Self { scene: scene.into(), class: class.into(), ratio: now.median / then.median, bounds }
    }
    /// True if it is slower now, however the noise fell.
    pub fn is_regression(&self) -> bool {
        self.bounds[1] < 1.0
    }
    /// True if it is faster now, however the noise fell.
    pub fn is_improvement(&self) -> bool {
        self.bounds[0] > 1.0
    }
}

impl Baseline {
    /// Reads a report. **Errors:** [`BaselineError::Read`], [`BaselineError::Malformed`].
    pub fn read(path: &Path) -> Result<Self, BaselineError> {
        let text = std::fs::read_to_string(path)
            .map_err(|source| BaselineError::Read { path: path.to_owned(), source })?;
        Self::parse(path, &text)
    }

    fn parse(path: &Path, text: &str) -> Result<Self, BaselineError> {
        let report: Report = serde_json::from_str(text).map_err(|error| {
            let whole = error.to_string();
            // The place stands before the colon already.
            let message = whole.split(" at line ").next().unwrap_or(&whole).to_owned();
            BaselineError::Malformed {
                path: path.to_owned(),
                line: error.line(),
                column: error.column(),
                message,
            }
        })?;
        Ok(Self { path: path.to_owned(), report })
    }

    /// octray's rates of every class of a scene that is in both.
    ///
    /// **Errors:** other settings than now, or nothing in both.
    pub fn compare(&self, now: &Report) -> Result<Vec<Comparison>, BaselineError> {
        let [then_settings, now_settings] = [&self.report, now].map(settings);
        if then_settings != now_settings {
            return Err(BaselineError::Other {
                path: self.path.clone(),
                then: then_settings,
                now: now_settings,
            });
        }
        let rows = |report: &Report| -> Vec<(String, String, EngineReport)> {
            let scenes = report.scenes.iter().flat_map(|s| s.classes.iter().map(move |c| (s, c)));
            scenes
                .filter_map(|(s, c)| Some((s.scene.clone(), c.class.clone(), c.octray()?.clone())))
                .collect()
        };
        let old = rows(&self.report);
        let compared: Vec<Comparison> = rows(now)
            .iter()
            .filter_map(|(scene, class, now)| {
                let then = &old.iter().find(|row| (&row.0, &row.1) == (scene, class))?.2;
                Some(Comparison::of(scene, class, then, now))
            })
            .collect();
        if compared.is_empty() {
            Err(BaselineError::Nothing { path: self.path.clone() })
        } else {
            Ok(compared)
        }
    }
}

/// What must be equal for rates to compare.
fn settings(report: &Report) -> String {
    let s = &report.settings;
    format!(
        "tier {}, {} trees, {} threads, size {}x{}",
        s.tier, s.build_quality, s.threads, s.size[0], s.size[1]
    )
}

/// Comparisons for people.
pub fn comparison_table(comparisons: &[Comparison]) -> String {
    let head = ["scene", "class", "now/then", "least", "most", ""].map(String::from).to_vec();
    let rows = comparisons.iter().map(|c| {
        let verdict = match (c.is_regression(), c.is_improvement()) {
            (true, _) => "slower",
            (_, true) => "faster",
            _ => "",
        };
        let number = |x: f64| format!("{x:.3}");
        vec![
            c.scene.clone(),
            c.class.clone(),
            number(c.ratio),
            number(c.bounds[0]),
            number(c.bounds[1]),
            verdict.into(),
        ]
    });
    aligned(&std::iter::once(head).chain(rows).collect::<Vec<_>>())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::bench::{ClassReport, Difference, SceneReport, Settings, Spread};

    /// One class of one scene, octray's rates as given.
    fn report(class: &str, [min, median, max]: [f64; 3]) -> Report {
        let engine = EngineReport {
            engine: "octray".into(),
            mode: "watertight".into(),
            mrays_s: Spread { median, min, max },
            differs: Difference::default(),
            counters: None,
        };
        let class = ClassReport {
            class: class.into(),
            rays: 64,
            hits: 32,
            fingerprint: "0".into(),
            brute_force_rays: 8,
            visits: None,
            roofline_share: None,
            engines: vec![engine],
        };
        let scene = SceneReport {
            scene: "seed".into(),
            triangles: 1,
            spheres: 0,
            cylinders: 0,
            builds: Vec::new(),
            classes: vec![class],
        };
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
            scenes: vec![scene],
            scaling: None,
        }
    }

    fn compared(then: [f64; 3], now: [f64; 3]) -> Comparison {
        let text = serde_json::to_string(&report("primary", then)).unwrap();
        let baseline = Baseline::parse(Path::new("then.json"), &text).unwrap();
        baseline.compare(&report("primary", now)).unwrap().remove(0)
    }

    #[test]
    fn only_what_noise_cannot_explain_is_a_regression() {
        let then = [9.0, 10.0, 11.0];
        let same = compared(then, then);
        assert!(same.ratio == 1.0 && !same.is_regression() && !same.is_improvement());
        let overlapping = compared(then, [8.0, 8.5, 9.2]);
        assert!(!overlapping.is_regression(), "{overlapping:?}");
        let slower = compared(then, [7.0, 7.5, 8.0]);
        assert!(slower.is_regression() && slower.ratio == 0.75, "{slower:?}");
        assert!(compared(then, [14.0, 15.0, 16.0]).is_improvement());
        let steady = compared([10.0; 3], [9.7; 3]);
        assert!(!steady.is_regression(), "3% is what two runs differ by: {steady:?}");
        let table = comparison_table(&[slower]);
        assert!(table.contains("slower") && table.contains("0.750"), "{table}");
    }

    #[test]
    fn bad_baselines_say_where_and_what() {
        let whole = serde_json::to_string_pretty(&report("primary", [1.0; 3])).unwrap();
        let line_of_rate = 1 + whole.lines().position(|line| line.contains("\"min\"")).unwrap();
        for (text, line, part) in [
            ("", 1, "EOF"),
            ("[]", 1, "struct Report"),
            ("{\n  \"octray\": 3\n}", 2, "string"),
            (&whole.replace("\"octray\": \"test\"", "\"octary\": \"test\""), 2, "octary"),
            (&whole.replace("\"min\": 1.0", "\"min\": \"one\""), line_of_rate, "one"),
        ] {
            let error = Baseline::parse(Path::new("b.json"), text).unwrap_err();
            let BaselineError::Malformed { line: at, .. } = &error else { panic!("{error}") };
            let message = error.to_string();
            assert!(message.contains(part) && message.starts_with("b.json:"), "{message}");
            assert_eq!(*at, line, "{message}");
        }
    }

    #[test]
    fn other_settings_and_other_scenes_do_not_compare() {
        let baseline = Baseline { path: "b.json".into(), report: report("primary", [1.0; 3]) };
        let mut other = report("primary", [1.0; 3]);
        other.settings.tier = "fast".into();
        assert!(baseline.compare(&other).unwrap_err().to_string().contains("tier watertight"));
        let error = baseline.compare(&report("shadow", [1.0; 3])).unwrap_err();
        assert!(matches!(error, BaselineError::Nothing { .. }), "{error}");
    }
}
