//! Wrappers for schedulers, to be read and submitted by the user: nothing is submitted here.

use super::Plan;

const SLURM: &str = include_str!("emit/slurm.sh");
const OPENJD: &str = include_str!("emit/openjd.yaml");
const K8S: &str = include_str!("emit/k8s.yaml");
const PARALLEL: &str = include_str!("emit/parallel.sh");

/// A shell script that submits an array job and a merge that runs when all of it has ended, well or not: the merge looks
/// for itself what is there.
pub fn slurm(plan: &Plan, path: &str) -> String {
    let text = filled(SLURM, plan, &quoted(path));
    match plan.shards > USUAL_SLURM_SHARDS {
        true => text.replacen("set -eu\n", &format!("{}set -eu\n", large_array(plan.shards)), 1),
        false => text,
    }
}

/// An Open Job Description template: a step of shards, and one that merges.
pub fn openjd(plan: &Plan, path: &str) -> String {
    filled(OPENJD, plan, &serde_json::Value::from(path).to_string())
}

/// Most indexes of a Kubernetes job that may all run at the same time and are tried again one by one.
pub const MOST_K8S_SHARDS: u32 = 100_000;

/// Most elements of a Slurm array where `MaxArraySize` is what Slurm itself sets: 1001, and indexes stay below it.
pub const USUAL_SLURM_SHARDS: u32 = 1001;

/// A Kubernetes Indexed Job; the merge is run when it is complete.
pub fn k8s(plan: &Plan, path: &str) -> String {
    filled(K8S, plan, &serde_json::Value::from(path).to_string())
}

/// A shell script for GNU parallel.
pub fn parallel(plan: &Plan, path: &str) -> String {
    filled(PARALLEL, plan, &quoted(path))
}

/// What to know before an array of so many is submitted.
fn large_array(shards: u32) -> String {
    format!(
        "# {shards} shards need MaxArraySize={shards} or more in slurm.conf (where it is not set: {USUAL_SLURM_SHARDS}):\n\
         # see scontrol show config | grep MaxArraySize, or make the plan with fewer --shards.\n"
    )
}

fn filled(template: &str, plan: &Plan, path: &str) -> String {
    let words = [
        ("@NAME@", plain_name(&plan.name)),
        ("@SHARDS@", plan.shards.to_string()),
        ("@LAST@", (plan.shards - 1).to_string()),
        ("@PLAN@", path.to_owned()),
    ];
    words.iter().fold(template.to_owned(), |text, (word, value)| text.replace(word, value))
}

/// A word as a shell takes it.
fn quoted(text: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_./".contains(c);
    match !text.is_empty() && text.chars().all(plain) {
        true => text.to_owned(),
        false => format!("'{}'", text.replace('\'', r"'\''")),
    }
}

/// Longest name of a Kubernetes job whose pods, each with a dash and its index behind that name, are hosts.
const MOST_LETTERS: usize = 50;

/// A name that schedulers take: small letters, digits and dashes, none of them at the end.
fn plain_name(name: &str) -> String {
    let letter = |c: char| if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { '-' };
    let name: String = name.chars().map(letter).collect();
    let name: String = format!("octray-{}", name.trim_matches('-')).chars().take(MOST_LETTERS).collect();
    name.trim_matches('-').to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_safe_where_they_go() {
        assert_eq!(quoted("a/b-1.plan"), "a/b-1.plan");
        assert_eq!(quoted("it's $HOME"), r"'it'\''s $HOME'");
        assert_eq!(plain_name("My Turn_1"), "octray-my-turn-1");
        assert_eq!(plain_name("日本"), "octray");
        assert_eq!(plain_name(&format!("{}-b", "a".repeat(42))), format!("octray-{}", "a".repeat(42)));
    }
}
