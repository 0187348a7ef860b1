//! What a render did, in a few lines or as JSON.

use std::fmt;
use std::time::Duration;

use serde_json::{Value, json};

use super::human;
use super::pipeline::{Reached, RenderReport};
use super::simd;
use crate::output::Written;

/// How work ended well.
pub(super) trait Ending: fmt::Display {
    /// The event `done`.
    fn to_json(&self) -> Value;
}

/// What a render did.
pub(super) struct Summary {
    /// The scene's name.
    pub(super) scene: String,
    /// Width and height in pixels.
    pub(super) size: [u32; 2],
    /// Triangles left out because they have no area.
    pub(super) skipped_triangles: usize,
    /// Samples, rays, threads and time of the render itself.
    pub(super) report: RenderReport,
    /// From the program's begin to its first rays, without reading and compiling the scene.
    pub(super) start_time: Duration,
    /// Reading and checking the scene.
    pub(super) load_time: Duration,
    /// Compiling the scene and building the tree.
    pub(super) build_time: Duration,
    /// Encoding and storing the picture.
    pub(super) write_time: Duration,
    /// Where the picture went.
    pub(super) output: String,
    /// What was written.
    pub(super) written: Written,
    /// Greatest resident memory, if the system tells.
    pub(super) peak_memory_bytes: Option<u64>,
}

impl Ending for Summary {
    fn to_json(&self) -> Value {
        let (report, rays) = (&self.report, &self.report.rays);
        json!({
            "event": "done",
            "scene": self.scene,
            "width": self.size[0],
            "height": self.size[1],
            "skipped_triangles": self.skipped_triangles,
            "samples": report.samples,
            "reached": report.reached.map(|reached| json!({
                // Infinite is null.
                "rmse_estimate": reached.rmse_estimate,
                "pixels_above": reached.pixels_above,
                "samples_fewest": reached.samples[0],
                "samples_most": reached.samples[1],
                "first_sample_late": reached.first_sample_late,
            })),
            "nan_samples": report.nan_samples,
            "nan_values_written_as_zero": self.written.nan_values,
            "rays": {
                "camera": rays.camera, "shadow": rays.shadow, "reflected": rays.reflected,
                "refracted": rays.refracted, "diffuse": rays.diffuse, "total": self.rays(),
            },
            "mrays_per_s": human::millions_a_second(self.rays(), report.render_time),
            "start_s": self.start_time.as_secs_f64(),
            "load_s": self.load_time.as_secs_f64(),
            "build_s": self.build_time.as_secs_f64(),
            "render_s": report.render_time.as_secs_f64(),
            "write_s": self.write_time.as_secs_f64(),
            "threads": report.threads,
            "simd": simd::BUILT_FOR.name(),
            "peak_memory_bytes": self.peak_memory_bytes,
            "output": self.output,
            "size_bytes": self.written.size_bytes,
        })
    }
}

impl Summary {
    fn rays(&self) -> u64 {
        let rays = &self.report.rays;
        rays.camera + rays.shadow + rays.reflected + rays.refracted + rays.diffuse
    }

    fn pixels(&self) -> u64 {
        self.size.map(u64::from).iter().product()
    }

    fn rays_by_class(&self) -> String {
        let rays = &self.report.rays;
        let classes = [
            ("camera", rays.camera),
            ("shadow", rays.shadow),
            ("reflected", rays.reflected),
            ("refracted", rays.refracted),
            ("diffuse", rays.diffuse),
        ];
        let shot = classes.iter().filter(|(_, rays)| *rays > 0);
        shot.map(|(class, rays)| format!("{class} {}", human::count(*rays))).collect::<Vec<_>>().join(", ")
    }
}

impl fmt::Display for Summary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (report, [width, height]) = (&self.report, self.size);
        writeln!(f, "{}: {width}x{height}, {} samples", self.scene, human::count(report.samples))?;
        let rate = human::ray_rate(self.rays(), report.render_time);
        writeln!(f, "rays     {} = {}; {rate}", self.rays_by_class(), human::count(self.rays()))?;
        if let Some(reached) = &report.reached {
            writeln!(f, "reached  {}", told(reached, self.pixels()))?;
        }
        let times = [self.start_time, self.load_time, self.build_time, report.render_time, self.write_time];
        let [start, load, build, render, write] = times.map(human::time);
        writeln!(f, "time     start {start}, load {load}, build {build}, render {render}, write {write}")?;
        let memory = self.peak_memory_bytes.map_or("unknown".into(), human::bytes);
        let (simd, threads) = (simd::BUILT_FOR.name(), report.threads);
        writeln!(f, "machine  {simd}, {threads} threads, peak memory {memory}")?;
        // Always said, so that a zero is known and not only missing.
        let (samples, values) = (report.nan_samples, self.written.nan_values);
        writeln!(f, "checks   {samples} samples were not a number, {values} values written as 0 for it")?;
        if self.skipped_triangles > 0 {
            writeln!(f, "skipped  {} triangles without area", human::count(self.skipped_triangles as u64))?;
        }
        write!(f, "picture  {}, {}", self.output, human::bytes(self.written.size_bytes))
    }
}

/// How near a goal the picture came.
fn told(reached: &Reached, pixels: u64) -> String {
    let [fewest, most] = reached.samples;
    let samples = if fewest == most { format!("{most}") } else { format!("{fewest} to {most}") };
    let error = match reached.rmse_estimate.is_finite() {
        true => format!("{:.2e}", reached.rmse_estimate),
        false => "unknown".into(),
    };
    let of_limit = |above| format!(", {} pixels within the limit", human::count(pixels - above));
    let pixels = reached.pixels_above.map_or(String::new(), of_limit);
    let late = match reached.first_sample_late {
        true => "; the time limit was over before each pixel had its first sample",
        false => "",
    };
    format!("estimated rmse {error}, {samples} samples a pixel{pixels}{late}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::wavefront::RayCounts;

    fn summary() -> Summary {
        let rays = RayCounts { camera: 1_228_800, shadow: 2_000_000, reflected: 5, refracted: 0, diffuse: 0 };
        Summary {
            scene: "seed".into(),
            size: [640, 480],
            skipped_triangles: 0,
            report: RenderReport {
                rays,
                samples: 1_228_800,
                nan_samples: 0,
                render_time: Duration::from_millis(500),
                threads: 2,
                reached: None,
            },
            start_time: Duration::from_micros(1500),
            load_time: Duration::from_micros(120),
            build_time: Duration::from_micros(340),
            write_time: Duration::from_millis(7),
            output: "seed.png".into(),
            written: Written { size_bytes: 345_678, nan_values: 0 },
            peak_memory_bytes: None,
        }
    }

    #[test]
    fn the_text_has_every_figure() {
        let text = summary().to_string();
        for part in [
            "seed: 640x480, 1.23 M samples",
            "camera 1.23 M, shadow 2.00 M, reflected 5 = 3.23 M; 6.46 Mrays/s",
            "start 1.50 ms, load 0.12 ms, build 0.34 ms, render 500 ms, write 7.00 ms",
            simd::BUILT_FOR.name(),
            "2 threads, peak memory unknown",
            "0 samples were not a number, 0 values",
            "seed.png, 346 kB",
        ] {
            assert!(text.contains(part), "{part} in\n{text}");
        }
        assert!(!text.contains("diffuse") && !text.ends_with('\n'));
    }

    #[test]
    fn a_goal_says_how_near_it_was_reached() {
        let reached = |rmse_estimate, samples, first_sample_late| {
            Some(Reached { rmse_estimate, pixels_above: Some(7_200), samples, first_sample_late })
        };
        let mut summary = summary();
        summary.report.reached = reached(0.0123, [16, 384], false);
        let text = summary.to_string();
        assert!(
            text.contains("estimated rmse 1.23e-2, 16 to 384 samples a pixel, 300 k pixels within"),
            "{text}"
        );
        assert!(!text.contains("limit was over"), "{text}");
        assert_eq!(summary.to_json()["reached"]["samples_most"], 384);
        summary.report.reached = reached(f64::INFINITY, [1, 1], true);
        assert!(summary.to_string().contains("estimated rmse unknown, 1 samples a pixel"), "{summary}");
        assert_eq!(summary.to_json()["reached"]["rmse_estimate"], Value::Null);
    }

    #[test]
    fn the_event_is_one_line_of_raw_numbers() {
        let event = summary().to_json();
        assert_eq!(event["event"], "done");
        assert_eq!(event["rays"]["total"], 3_228_805);
        assert_eq!(event["peak_memory_bytes"], Value::Null);
        assert!(!event.to_string().contains('\n'));
    }
}
