//! Scripts for schedulers.

use super::{SMALL, done, fails, folder};

#[test]
fn wrappers_know_how_many_shards_schedulers_take() {
    let folder = folder(SMALL);
    let plan = |shards: u32, wrapper: &str| format!("plan turn.toml --shards {shards} --emit {wrapper}");
    done(folder.path(), &plan(100_000, "k8s"));
    std::fs::remove_file(folder.path().join("turn.plan")).unwrap();
    fails(folder.path(), &plan(100_001, "k8s"), 2, &["Kubernetes", "100000", "--shards"]);
    assert!(!folder.path().join("turn.plan").exists());
    assert!(!done(folder.path(), &plan(1001, "slurm")).contains("MaxArraySize"));
    let said = done(folder.path(), &plan(1002, "slurm"));
    assert!(
        said.contains("warning: an array of 1002") && said.contains("# 1002 shards need MaxArraySize=1002")
    );
    assert!(said.starts_with("#!/bin/sh\n"), "{said}");
}

#[test]
fn wrappers_name_the_plan_and_every_shard() {
    let folder = folder(SMALL);
    for (wrapper, words) in [
        (
            "slurm",
            &[
                "--array=0-7",
                "--requeue",
                "--open-mode=append",
                "--signal=B:USR1@30",
                "exec octray run turn.plan --shard auto",
                "afterany",
                "exec octray merge turn.plan",
            ][..],
        ),
        ("openjd", &["jobtemplate-2023-09", "0-7", "/8", "dependsOn"]),
        ("k8s", &["completionMode: Indexed", "completions: 8", "[2, 3]"]),
        ("parallel", &["seq 0 7", "--quote", "{}/8", "octray merge turn.plan"]),
    ] {
        let text = done(folder.path(), &format!("plan turn.toml --shards 8 --emit {wrapper}"));
        for word in words {
            assert!(text.contains(word), "{wrapper}: `{word}` is not in:\n{text}");
        }
        let unfilled = ["@NAME@", "@PLAN@", "@SHARDS@", "@LAST@"].iter().any(|word| text.contains(word));
        assert!(!unfilled, "{text}");
    }
}
