//! What a batch did, in a few lines or as JSON.

use std::fmt;

use serde_json::{Value, json};

use crate::batch::run::RunReport;
use crate::cli::human;
use crate::cli::memory;
use crate::cli::simd;
use crate::cli::summary::Ending;

/// What a batch did.
pub(super) struct Summary {
    pub(super) name: String,
    pub(super) report: RunReport,
    pub(super) threads: usize,
    pub(super) output: String,
}

impl Ending for Summary {
    fn to_json(&self) -> Value {
        let report = &self.report;
        json!({
            "event": "done",
            "name": self.name,
            "units": report.done,
            "units_done_before": report.done_before,
            "nan_samples": report.nan_samples,
            "rays": { "total": report.rays },
            "mrays_per_s": human::millions_a_second(report.rays, report.time),
            "time_s": report.time.as_secs_f64(),
            "threads": self.threads,
            "simd": simd::BUILT_FOR.name(),
            "peak_memory_bytes": memory::peak_bytes(),
            "output": self.output,
        })
    }
}

impl fmt::Display for Summary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let report = &self.report;
        let (done, before) = (report.done, report.done_before);
        writeln!(f, "{}: {done} units done, {before} were done before", self.name)?;
        let (rays, rate) = (human::count(report.rays), human::ray_rate(report.rays, report.time));
        writeln!(f, "rays     {rays}; {rate}; {}", human::time(report.time))?;
        let memory = memory::peak_bytes().map_or("unknown".into(), human::bytes);
        writeln!(f, "machine  {}, {} threads, peak memory {memory}", simd::BUILT_FOR.name(), self.threads)?;
        // Always said, so that a zero is known and not only missing.
        writeln!(f, "checks   {} samples were not a number", human::count(report.nan_samples))?;
        write!(f, "pictures in {}", self.output)
    }
}
