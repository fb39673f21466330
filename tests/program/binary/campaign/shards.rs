//! Shards and their merge.

use super::{json, sandbox};
use crate::binary::support::Sandbox;

#[test]
fn seven_shards_make_the_file_of_one_process() {
    let sandbox = sandbox();
    let arguments = ["campaign", "standing.toml", "--flights", "23"];
    let whole = sandbox.run(&[&arguments[..], &["--out", "whole.jsonl"]].concat()).exits(1);
    let mut parts = Vec::new();
    for number in 1..=7 {
        let (shard, part) = (format!("{number}/7"), format!("part-{number}.jsonl"));
        let ran = sandbox.run(&[&arguments[..], &["--shard", &shard, "--out", &part]].concat()).exits(0);
        assert!(ran.out.contains(&format!(", shard {shard}: ")), "{}", ran.out);
        parts.push(part);
    }
    parts.reverse();
    let merge = |parts: &[String]| {
        let mut arguments = vec!["campaign", "merge"];
        arguments.extend(parts.iter().map(String::as_str));
        arguments.extend(["--out", "merged.jsonl", "--report", "merged.html"]);
        sandbox.run(&arguments)
    };
    let merged = merge(&parts).exits(1);
    assert_eq!(sandbox.read("merged.jsonl"), sandbox.read("whole.jsonl"));
    assert_eq!(merged.out, whole.out.replace("whole.jsonl", "merged.jsonl"));
    let page = sandbox.read("merged.html");
    assert!(page.contains("<code>betadeck open merged.jsonl:"), "{page}");
    assert!(page.contains("<code>betadeck campaign merge part-7.jsonl part-6.jsonl"), "{page}");
    std::fs::remove_file(sandbox.path("merged.jsonl")).expect("removed");

    // Lost, doubled, unfinished and foreign parts are found.
    let lost = merge(&parts[1..6]).exits(2);
    assert!(
        lost.err.contains("the shards 1/7, 7/7 are missing: fly them with the same command and --shard 1/7"),
        "{}",
        lost.err
    );
    let doubled = merge(&[&parts[..], &["part-3.jsonl".to_owned()]].concat()).exits(2);
    assert!(
        doubled.err.contains("shard 3/7 is there twice: part-3.jsonl and part-3.jsonl"),
        "{}",
        doubled.err
    );
    sandbox
        .run(&["campaign", "standing.toml", "--flights", "22", "--shard", "2/7", "--out", "foreign.jsonl"])
        .exits(0);
    let foreign =
        merge(&[&parts[..5], &["foreign.jsonl".to_owned(), "part-1.jsonl".to_owned()]].concat()).exits(2);
    assert!(
        foreign.err.contains(
            "foreign.jsonl does not belong to the campaign of part-7.jsonl: its options were others"
        ),
        "{}",
        foreign.err
    );
    let text = sandbox.read("part-4.jsonl");
    let short = text.trim_end().rsplit_once('\n').expect("lines").0;
    sandbox.write("part-4.jsonl", &format!("{short}\n{{\"ev"));
    let unfinished = merge(&parts).exits(2);
    assert!(
        unfinished.err.contains("part-4.jsonl (shard 4/7) ends after 3 of 4 flights: finish it with betadeck campaign part-4.jsonl"),
        "{}",
        unfinished.err
    );
    assert!(!sandbox.path("merged.jsonl").exists());
    sandbox.run(&["campaign", "part-4.jsonl"]).exits(0);
    assert_eq!(sandbox.read("part-4.jsonl"), text);
}

#[test]
fn array_jobs_name_their_shard_in_the_environment() {
    let sandbox = sandbox();
    let run = |shard: &str, variables: &[(&str, &str)]| {
        let mut command = sandbox.command(&[
            "campaign",
            "standing.toml",
            "--flights",
            "4",
            "--shard",
            shard,
            "--out",
            "part.jsonl",
        ]);
        let output = command.envs(variables.iter().copied()).output().expect("it runs");
        (output.status.code(), String::from_utf8(output.stderr).expect("text"))
    };
    let slurm = [
        ("SLURM_ARRAY_TASK_ID", "12"),
        ("SLURM_ARRAY_TASK_MIN", "11"),
        ("SLURM_ARRAY_TASK_MAX", "12"),
        ("SLURM_ARRAY_TASK_COUNT", "2"),
    ];
    assert_eq!(run("slurm", &slurm).0, Some(0));
    let numbers = |sandbox: &Sandbox| -> Vec<u64> {
        sandbox
            .read("part.jsonl")
            .lines()
            .skip(1)
            .map(|line| json(line)["flight"].as_u64().unwrap())
            .collect()
    };
    assert_eq!(numbers(&sandbox), [3, 4]);
    // The same shard by another name.
    assert_eq!(run("2/2", &[]).0, Some(0));
    std::fs::remove_file(sandbox.path("part.jsonl")).expect("removed");
    assert_eq!(run("k8s/4", &[("JOB_COMPLETION_INDEX", "0")]).0, Some(0));
    assert_eq!(numbers(&sandbox), [1]);
    let (code, err) = run("slurm", &[]);
    assert_eq!(code, Some(2));
    assert!(err.contains("SLURM_ARRAY_TASK_ID is not set"), "{err}");
    let (code, err) = run("k8s/4", &[("JOB_COMPLETION_INDEX", "1")]);
    assert_eq!(code, Some(2));
    assert!(err.contains("part.jsonl has shard 1/4 of this campaign"), "{err}");
}
