//! `octray batch`, `plan`, `run`, `merge` and `status`: many pictures.

mod args;
mod report;
mod work;

use std::path::{Path, PathBuf};

use serde_json::json;

use super::error::{CliError, Exit};
use super::stdio;
use crate::batch::{self, Job, Plan, Shard, Split, Store};
use crate::load::KeptMeshes;

pub use args::{BatchArgs, MergeArgs, PlanArgs, RunArgs, SplitBy, StatusArgs, WorkArgs, Wrapper};
use work::{Batch, with_reporter};

/// `octray plan`.
pub fn plan(args: &PlanArgs) -> Result<(), CliError> {
    if let Some(advice) = args.emit.map(|wrapper| wrapper.check(args.shards)).transpose()?.flatten() {
        stdio::say(&format!("warning: {advice}"));
    }
    let job = Job::read(&args.job)?;
    let path = args.output.clone().unwrap_or_else(|| PathBuf::from(format!("{}.plan", job.name)));
    let plan = Plan::of(&job, args.split.into(), args.shards, folder_of(&path), &KeptMeshes::default())?;
    plan.write(&path)?;
    match args.emit {
        Some(wrapper) => stdio::print(wrapper.text(&plan, &path).as_bytes()),
        None => {
            let (cost, name) = (plan.cost, path.display());
            let (pictures, units, shards) = (cost.pictures, cost.units, plan.shards);
            stdio::say(&format!("{name}: {pictures} pictures, {units} units, {shards} shards"));
            Ok(())
        }
    }
}

/// `octray run`.
pub fn run_plan(args: &RunArgs) -> Result<(), CliError> {
    with_reporter(&args.work, |reporter, interrupt| {
        let plan = Plan::read(&args.plan)?;
        let environment =
            |name: &str| std::env::var_os(name).map(|value| value.to_string_lossy().into_owned());
        let shard =
            args.shard.as_ref().map(|text| Shard::parse(text, plan.shards, environment)).transpose()?;
        Batch {
            plan: &plan,
            folder: folder_of(&args.plan),
            output: &args.output,
            shard,
            work: &args.work,
            meshes: &KeptMeshes::keeping(),
        }
        .run(reporter, interrupt)
    })
}

/// `octray batch`.
pub fn run_job(args: &BatchArgs) -> Result<(), CliError> {
    with_reporter(&args.work, |reporter, interrupt| {
        let meshes = KeptMeshes::keeping();
        let plan = Plan::of(&Job::read(&args.job)?, args.split.into(), 1, Path::new(""), &meshes)?;
        let batch = Batch {
            plan: &plan,
            folder: Path::new(""),
            output: &args.output,
            shard: None,
            work: &args.work,
            meshes: &meshes,
        };
        let report = batch.run(reporter, interrupt)?;
        if plan.split != Split::Frames {
            let store = Store::look(&args.output, &plan)?;
            batch::merge::merge(&plan, Path::new(""), &store, false)?;
        }
        Ok(report)
    })
}

/// `octray merge`.
pub fn merge(args: &MergeArgs) -> Result<(), CliError> {
    let plan = Plan::read(&args.plan)?;
    let store = Store::look(&args.output, &plan)?;
    let status = batch::merge::status(&plan, &store)?;
    if let Some(array) = status.array() {
        stdio::print(format!("{array}\n").as_bytes())?;
    }
    if status.is_complete() || args.partial {
        let pictures = batch::merge::merge(&plan, folder_of(&args.plan), &store, args.partial)?;
        stdio::say(&format!("{}: {pictures} of {} pictures", plan.name, plan.pictures.len()));
    }
    match status.is_complete() {
        true => Ok(()),
        false => {
            let missing = status.units - status.done;
            let what = format!("incomplete: {missing} of {} units are missing", status.units);
            let what = what + &nothing_here(&store, &args.output);
            Err(CliError::new(Exit::Scene, what))
        }
    }
}

/// `octray status`.
pub fn status(args: &StatusArgs) -> Result<(), CliError> {
    let plan = Plan::read(&args.plan)?;
    let store = Store::look(&args.output, &plan)?;
    let status = batch::merge::status(&plan, &store)?;
    let pictures = plan.pictures.len() - status.pictures_missing.len();
    let text = match args.json {
        true => json!({
            "name": plan.name,
            "units": status.units,
            "units_done": status.done,
            "pictures": plan.pictures.len(),
            "pictures_done": pictures,
            "nan_samples": status.nan_samples,
            "shards": plan.shards,
            "shards_missing": status.shards_missing,
        })
        .to_string(),
        false => {
            let (name, done, units) = (&plan.name, status.done, status.units);
            let missing = status.array().map_or(String::new(), |array| format!("; missing {array}"));
            let missing = missing + &nothing_here(&store, &args.output);
            format!(
                "{name}: {done} of {units} units, {pictures} of {} pictures{missing}",
                plan.pictures.len()
            )
        }
    };
    stdio::print(format!("{text}\n").as_bytes())
}

/// What to know where nothing of a plan is done.
fn nothing_here(store: &Store, output: &Path) -> String {
    match store.is_begun() {
        true => String::new(),
        false => format!(
            "; {} has no work of this plan: -o is the folder that the pictures go to",
            output.display()
        ),
    }
}

fn folder_of(path: &Path) -> &Path {
    path.parent().unwrap_or(Path::new(""))
}
