//! A report as one page that needs nothing else.

use std::error::Error;

use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use maud::{DOCTYPE, Markup, PreEscaped, html};

use super::plot::plot;
use super::report::{Report, Row};

const STYLE: &str = include_str!("page.css");

/// Settings shown as pictures: at most so many of those that nothing beats.
const MOST_SHOWN: usize = 8;

/// The report as an HTML page: plots, pictures of the settings that nothing beats, and a table.
///
/// **Errors:** what the plotting library says.
pub fn page(report: &Report) -> Result<String, Box<dyn Error>> {
    let plots = [
        ("RMSE", plot(report, "RMSE, linear light", |row| row.figures.rmse)?),
        ("FLIP", plot(report, "mean FLIP", |row| row.figures.flip)?),
    ];
    let title = format!("What settings cost and bring: {}", report.scene);
    let markup = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                title { (title) }
                style { (PreEscaped(STYLE)) }
            }
            body {
                h1 { (title) }
                (about(report))
                div.plots {
                    @for (name, svg) in &plots {
                        figure { (PreEscaped(svg)) figcaption { (name) " over time. Lower left is better." } }
                    }
                }
                h2 { "What nothing beats in time and RMSE" }
                (pictures(report))
                h2 { "All settings, fastest first" }
                (table(report))
                footer { "octray " (report.octray) }
            }
        }
    };
    Ok(markup.into_string())
}

fn about(report: &Report) -> Markup {
    let (truth, [width, height]) = (&report.truth, report.size);
    html! {
        p {
            (width) "x" (height) " pixels, " (report.threads) " threads. Each setting was rendered "
            (report.rows.first().map_or(0, |row| row.times.runs))
            " times, in turns with all others; times are medians. Errors are those against "
            em { (truth.setting) } " (" (truth.fewest_samples) " to " (truth.setting.spp) " samples a pixel, "
            (format!("{:.1}", truth.time_s)) " s), whose own RMSE is "
            @match truth.rmse_estimate {
                Some(error) => { "estimated at no more than " (format!("{error:.1e}")) },
                None => "unknown",
            }
            ": what is smaller says nothing. Settings depart from the scene's own in one thing beside tier and samples: " em { (report.base) } "."
        }
        @if !report.left_out.is_empty() {
            p { "Settings left out for lack of time: " (report.left_out.len()) "." }
        }
    }
}

fn pictures(report: &Report) -> Markup {
    html! {
        div.pictures {
            figure {
                (image(&report.truth.picture, "the converged picture"))
                figcaption { "the truth" }
            }
            @for row in shown(report) {
                figure {
                    div.pair {
                        (image(&row.pictures.picture, "the picture"))
                        (image(&row.pictures.difference, "where it differs from the truth, by FLIP"))
                    }
                    figcaption {
                        b { (row.setting.name_beside(&report.base)) } br;
                        (format!("{:.1} ms, RMSE {:.2e}, FLIP {:.4}", row.times.median_s * 1e3, row.figures.rmse, row.figures.flip))
                    }
                }
            }
        }
    }
}

/// Some of the front, evenly, both ends among them.
fn shown(report: &Report) -> Vec<&Row> {
    let front: Vec<&Row> = report.rows.iter().filter(|row| row.on_front).collect();
    let count = front.len().min(MOST_SHOWN);
    (0..count).map(|i| front[i * (front.len() - 1) / (count - 1).max(1)]).collect()
}

fn image(png: &[u8], alt: &str) -> Markup {
    html! { img src=(format!("data:image/png;base64,{}", BASE64_STANDARD.encode(png))) alt=(alt); }
}

fn table(report: &Report) -> Markup {
    let names = report.base.fields().map(|(name, _)| name);
    let figures = ["ms", "spread", "Mrays", "RMSE", "relMSE", "PSNR", "FLIP", "max", "wrong pixels"];
    html! {
        div.table {
            table {
                thead { tr { @for name in names { th { (name) } } @for name in figures { th.number { (name) } } } }
                tbody {
                    @for row in &report.rows {
                        tr.front[row.on_front] {
                            @for ((name, value), (_, own)) in row.setting.fields().into_iter().zip(report.base.fields()) {
                                td.changed[value != own && name != "spp"] { (value) }
                            }
                            @for value in values(row) { td.number { (value) } }
                        }
                    }
                }
            }
        }
    }
}

fn values(row: &Row) -> [String; 9] {
    let (t, f) = (&row.times, &row.figures);
    [
        format!("{:.2}", t.median_s * 1e3),
        format!("{:.0}%", t.spread() * 100.0),
        format!("{:.2}", row.rays as f64 / 1e6),
        format!("{:.2e}", f.rmse),
        format!("{:.2e}", f.relative_mse),
        format!("{:.1}", f.psnr_db),
        format!("{:.4}", f.flip),
        format!("{:.2e}", f.max_error),
        format!("{:.2}%", f.wrong_visibility * 100.0),
    ]
}
