//! The grid, rendered in turns.

use std::time::{Duration, Instant};

use super::axes::grid;
use super::figures::{Figures, Pictures};
use super::pareto::mark_front;
use super::report::{Report, Row, Times};
use super::score::{enlarged, score};
use super::setting::{Setting, Stage};
use super::sights::{Sight, share_wrong, sights};
use super::truth::truth;
use crate::film::Film;
use crate::intersect::TierName;
use crate::measure::compare::SizeMismatch;
use crate::scene::Scene;
use crate::wavefront::{RenderError, RenderOptions, render};

/// Share of the time that goes into the truth.
const TRUTH_SHARE: f64 = 0.4;
/// How often each setting is rendered at least.
const FEWEST_RUNS: usize = 3;
/// And at most: more say nothing new.
const MOST_RUNS: usize = 9;

/// How much is asked.
#[derive(Clone, Copy)]
pub struct Effort<'a> {
    /// About how long it may take; settings that do not fit are left out.
    pub budget: Duration,
    /// Threads and cancelling; the rest does not matter.
    pub options: RenderOptions<'a>,
    /// Told what is done.
    pub say: &'a dyn Fn(&str),
}

/// Why there is no report.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum TradeoffError {
    /// A picture could not be rendered.
    #[error(transparent)]
    Render(#[from] RenderError),
    /// Pictures that do not lie over each other.
    #[error(transparent)]
    Size(#[from] SizeMismatch),
}

/// Measures what the settings of a scene cost and bring.
///
/// **Errors:** [`TradeoffError`].
pub fn tradeoff(name: &str, scene: Scene, effort: &Effort) -> Result<Report, TradeoffError> {
    let begun = Instant::now();
    let mut stage = Stage::new(scene);
    let (base, grid) = (Setting::of(stage.scene()), grid(stage.scene()));
    (effort.say)("the truth");
    let limit = effort.budget.mul_f64(TRUTH_SHARE);
    let (film, truth) = truth(&mut stage, &effort.options, limit)?;
    let mut contest = Contest::new(stage, film, effort);
    (effort.say)("the grid");
    contest.first_round(&grid, &base)?;
    while contest.runs < MOST_RUNS && (contest.runs < FEWEST_RUNS || begun.elapsed() < effort.budget) {
        contest.further_round()?;
    }
    let mut rows = contest.rows();
    mark_front(&mut rows, |row| row.figures.rmse);
    rows.sort_by(|a, b| a.times.median_s.total_cmp(&b.times.median_s));
    Ok(Report {
        octray: String::new(),
        scene: name.into(),
        size: contest.stage.size(),
        threads: contest.threads,
        truth,
        base,
        rows,
        left_out: contest.left_out,
    })
}

/// A setting in the contest.
struct Entry {
    setting: Setting,
    change: Option<&'static str>,
    rays: u64,
    times: Vec<f64>,
    figures: Figures,
    pictures: Pictures,
}

/// Settings that take turns.
struct Contest<'a> {
    stage: Stage,
    truth: Film,
    true_sights: Vec<Sight>,
    /// By what decides what is seen, as they were needed.
    wrong: Vec<((TierName, u32, bool), f64)>,
    effort: &'a Effort<'a>,
    entries: Vec<Entry>,
    left_out: Vec<Setting>,
    runs: usize,
    threads: usize,
}

impl<'a> Contest<'a> {
    fn new(stage: Stage, truth: Film, effort: &'a Effort<'a>) -> Self {
        let true_sights = sights(stage.scene(), TierName::Exact, stage.size());
        Self {
            stage,
            truth,
            true_sights,
            wrong: Vec::new(),
            effort,
            entries: Vec::new(),
            left_out: Vec::new(),
            runs: 0,
            threads: 0,
        }
    }

    /// Renders and compares every setting once, but for those that would not fit into the time thrice.
    fn first_round(&mut self, grid: &[Setting], base: &Setting) -> Result<(), TradeoffError> {
        let budget = self.effort.budget.as_secs_f64() * (1.0 - TRUTH_SHARE) / FEWEST_RUNS as f64;
        let mut spent = 0.0;
        for setting in grid {
            if spent + self.predicted(setting) > budget {
                self.left_out.push(*setting);
                continue;
            }
            let entry = self.enter(*setting, base)?;
            spent += entry.times[0];
            self.entries.push(entry);
        }
        self.runs = 1;
        Ok(())
    }

    /// How long a setting will take, from the same one with fewer samples; no time where nothing is known of it.
    fn predicted(&self, setting: &Setting) -> f64 {
        let is_kin = |entry: &&Entry| Setting { spp: setting.spp, ..entry.setting } == *setting;
        let kin = self.entries.iter().rev().find(is_kin);
        kin.map_or(0.0, |entry| entry.times[0] * f64::from(setting.spp) / f64::from(entry.setting.spp))
    }

    fn enter(&mut self, setting: Setting, base: &Setting) -> Result<Entry, TradeoffError> {
        let (film, report) = render(self.stage.set(&setting), &self.effort.options)?;
        self.threads = report.threads;
        let wrong = self.wrong_share(&setting);
        let tone = self.stage.scene().settings.tone;
        let (figures, pictures) = score(&enlarged(&film, setting.shrink), &self.truth, tone, wrong)?;
        let (rays, times) = (report.rays.total(), vec![report.render_time.as_secs_f64()]);
        Ok(Entry {
            setting,
            change: setting.change_from(base).map(|(name, _)| name),
            rays,
            times,
            figures,
            pictures,
        })
    }

    /// The share of pixels that are seen otherwise than they should. **Needs:** a stage set so.
    fn wrong_share(&mut self, setting: &Setting) -> f64 {
        let decides = (setting.tier, setting.shrink, setting.shadows);
        if let Some((_, share)) = self.wrong.iter().find(|(known, _)| *known == decides) {
            return *share;
        }
        let [width, height] = self.stage.size().map(|side| side / setting.shrink);
        let found = sights(self.stage.scene(), setting.tier, [width, height]);
        let share = share_wrong(&self.true_sights, self.stage.size()[0], &found, setting.shrink);
        self.wrong.push((decides, share));
        share
    }

    /// Renders all settings once more, from another one on each time.
    fn further_round(&mut self) -> Result<(), TradeoffError> {
        (self.effort.say)(&format!("round {}", self.runs + 1));
        let first = self.runs * self.entries.len() / FEWEST_RUNS;
        for i in 0..self.entries.len() {
            let at = (first + i) % self.entries.len();
            let (_, report) = render(self.stage.set(&self.entries[at].setting), &self.effort.options)?;
            self.entries[at].times.push(report.render_time.as_secs_f64());
        }
        self.runs += 1;
        Ok(())
    }

    fn rows(&mut self) -> Vec<Row> {
        let row = |entry: Entry| Row {
            setting: entry.setting,
            change: entry.change,
            rays: entry.rays,
            times: Times::of(entry.times),
            figures: entry.figures,
            on_front: false,
            pictures: entry.pictures,
        };
        self.entries.drain(..).map(row).collect()
    }
}
