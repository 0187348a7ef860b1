//! Which shard a process renders.

use super::BatchError;

/// One shard of a plan.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    /// Number, from 0.
    pub index: u32,
}

/// Variables that schedulers give an index in, and the number they count from.
const VARIABLES: [(&str, u32); 10] = [
    ("OCTRAY_SHARD", 0),
    ("SLURM_ARRAY_TASK_ID", 0),
    ("JOB_COMPLETION_INDEX", 0),
    ("AWS_BATCH_JOB_ARRAY_INDEX", 0),
    ("PBS_ARRAY_INDEX", 0),
    ("SGE_TASK_ID", 1),
    ("LSB_JOBINDEX", 1),
    ("HQ_TASK_ID", 0),
    ("CLOUD_RUN_TASK_INDEX", 0),
    ("BATCH_TASK_INDEX", 0),
];

impl Shard {
    /// The shard that `text` means in a plan of `shards`: `i/n` counted from 0, where `n` must be the plan's number, or
    /// `auto`: the index that a scheduler has put into the environment. How many there are, only the plan says.
    ///
    /// **Errors:** [`BatchError::Shard`].
    pub fn parse(
        text: &str,
        shards: u32,
        environment: impl Fn(&str) -> Option<String>,
    ) -> Result<Self, BatchError> {
        let shard = match text {
            "auto" => auto(environment)?,
            text => written(text, shards)?,
        };
        match shard {
            index if index < shards => Ok(Self { index }),
            index => Err(BatchError::Shard(format!(
                "there is no shard {index}: the plan has {shards}, counted from 0 to {}",
                shards - 1
            ))),
        }
    }
}

fn written(text: &str, shards: u32) -> Result<u32, BatchError> {
    let numbers = text.split_once('/').and_then(|(i, n)| Some((i.parse().ok()?, n.parse::<u32>().ok()?)));
    match numbers {
        Some((index, n)) if n == shards => Ok(index),
        Some((_, n)) => Err(BatchError::Shard(format!(
            "--shard {text}: the plan is cut into {shards} shards, not {n}: make another plan with --shards {n}"
        ))),
        None => Err(BatchError::Shard(format!("--shard {text}: expected i/n, such as 0/{shards}, or auto"))),
    }
}

fn auto(environment: impl Fn(&str) -> Option<String>) -> Result<u32, BatchError> {
    let mut found: Vec<(&str, u32)> = Vec::new();
    for (name, base) in VARIABLES {
        // Some schedulers set a word, or 0 where they count from 1, when a job is no array.
        let Some(value) = environment(name).filter(|value| value != "undefined") else { continue };
        if base == 1 && value == "0" {
            continue;
        }
        let number = value.parse::<u32>().ok().and_then(|number| number.checked_sub(base));
        let index =
            number.ok_or_else(|| BatchError::Shard(format!("{name}={value} is no index of a shard")))?;
        found.push((name, index));
    }
    let names = |list: &[(&str, u32)]| list.iter().map(|(name, i)| format!("{name}={i}")).collect::<Vec<_>>();
    match found.first() {
        Some(&(_, index)) if found.iter().all(|&(_, other)| other == index) => Ok(index),
        Some(_) => Err(BatchError::Shard(format!(
            "--shard auto: the environment disagrees, counted from 0: {}",
            names(&found).join(", ")
        ))),
        None => Err(BatchError::Shard(format!(
            "--shard auto: none of {} is set",
            VARIABLES.map(|(name, _)| name).join(", ")
        ))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shard(text: &str, variables: &[(&str, &str)]) -> Result<u32, String> {
        let environment =
            |name: &str| variables.iter().find(|(n, _)| *n == name).map(|(_, value)| (*value).to_owned());
        Shard::parse(text, 4, environment).map(|s| s.index).map_err(|e| e.to_string())
    }

    #[test]
    fn written_shards_count_from_zero_and_know_the_plan() {
        assert_eq!(shard("3/4", &[]), Ok(3));
        assert!(shard("4/4", &[]).unwrap_err().contains("0 to 3"));
        assert!(shard("0/5", &[]).unwrap_err().contains("4 shards, not 5"));
        for text in ["", "1", "a/4", "-1/4", "1/4/4", "AUTO"] {
            assert!(shard(text, &[]).unwrap_err().contains("expected i/n"), "{text}");
        }
    }

    #[test]
    fn auto_takes_the_index_and_nothing_else() {
        assert_eq!(shard("auto", &[("SLURM_ARRAY_TASK_ID", "2"), ("SLURM_ARRAY_TASK_COUNT", "1")]), Ok(2));
        assert_eq!(shard("auto", &[("SGE_TASK_ID", "1")]), Ok(0));
        assert_eq!(shard("auto", &[("SGE_TASK_ID", "undefined"), ("OCTRAY_SHARD", "1")]), Ok(1));
        assert_eq!(shard("auto", &[("LSB_JOBINDEX", "0"), ("OCTRAY_SHARD", "1")]), Ok(1));
        assert_eq!(shard("auto", &[("JOB_COMPLETION_INDEX", "3"), ("OCTRAY_SHARD", "3")]), Ok(3));
    }

    #[test]
    fn auto_never_guesses() {
        assert!(shard("auto", &[]).unwrap_err().contains("SLURM_ARRAY_TASK_ID"));
        assert!(shard("auto", &[("SLURM_ARRAY_TASK_COUNT", "4")]).unwrap_err().contains("none of"));
        let two = [("SLURM_ARRAY_TASK_ID", "1"), ("OCTRAY_SHARD", "2")];
        assert!(shard("auto", &two).unwrap_err().contains("disagrees"));
        assert!(shard("auto", &[("OCTRAY_SHARD", "4")]).unwrap_err().contains("no shard 4"));
        assert!(shard("auto", &[("OCTRAY_SHARD", "two")]).unwrap_err().contains("two"));
    }
}
