//! A report as a table of text.

use std::fmt::Write;

use super::report::{Report, Row};
use super::setting::Setting;

/// The report for people; a `*` marks what no other setting beats in both time and RMSE.
pub fn table(report: &Report) -> String {
    let width = report.rows.iter().map(|row| row.setting.name_beside(&report.base).len()).max().unwrap_or(0);
    let mut text = about(report);
    let _ = writeln!(
        text,
        "\n  {:width$} {:>9} {:>7} {:>7} {:>9} {:>9} {:>6} {:>7} {:>9} {:>7}",
        "setting", "ms", "spread", "Mrays", "rmse", "relmse", "psnr", "flip", "max", "wrong",
    );
    report.rows.iter().for_each(|row| line(&mut text, row, &report.base, width));
    if !report.left_out.is_empty() {
        let _ =
            writeln!(text, "\nleft out for lack of time (see --budget): {} settings", report.left_out.len());
    }
    text
}

fn about(report: &Report) -> String {
    let (truth, [width, height]) = (&report.truth, report.size);
    let error = truth.rmse_estimate.map_or("unknown".into(), |error| format!("{error:.1e}"));
    format!(
        "{}, {width}x{height}, {} threads\ntruth: {}; {} to {} samples a pixel in {:.1} s, its own rmse at most about {error}\n",
        report.scene, report.threads, truth.setting, truth.fewest_samples, truth.setting.spp, truth.time_s,
    ) + &format!("own settings: {}\n", report.base)
}

fn line(text: &mut String, row: &Row, base: &Setting, width: usize) {
    let (f, t) = (&row.figures, &row.times);
    let mark = if row.on_front { '*' } else { ' ' };
    let _ = writeln!(
        text,
        "{mark} {:width$} {:>9.2} {:>6.0}% {:>7.2} {:>9.2e} {:>9.2e} {:>6.1} {:>7.4} {:>9.2e} {:>6.2}%",
        row.setting.name_beside(base),
        t.median_s * 1e3,
        t.spread() * 100.0,
        row.rays as f64 / 1e6,
        f.rmse,
        f.relative_mse,
        f.psnr_db,
        f.flip,
        f.max_error,
        f.wrong_visibility * 100.0,
    );
}
