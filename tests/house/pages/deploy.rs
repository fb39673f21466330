//! The files for clusters: their commands are those of the program, and their numbers belong together.

use betadeck::args::{CampaignArgs, Command, Layers, ShardArg, parse};

fn file(name: &str) -> String {
    std::fs::read_to_string(test_support::path("deploy").join(name)).unwrap()
}

fn campaign(words: Vec<&str>) -> Box<CampaignArgs> {
    match parse(words.into_iter().map(Into::into), &Layers::default()).unwrap().command {
        Some(Command::Campaign(args)) => args,
        other => panic!("{other:?}"),
    }
}

#[test]
fn the_slurm_script_flies_the_shard_of_its_task() {
    let text = file("slurm.sh");
    let (_, command) = text.split_once("campaign \"$@\" \\\n").unwrap();
    let command = command.replace('\\', "").replace("\"${SLURM_CPUS_PER_TASK:-1}\"", "1").replace('"', "");
    let words = ["betadeck", "campaign", "my-campaign.toml"].into_iter().chain(command.split_whitespace());
    let args = campaign(words.collect());
    assert_eq!((args.shard, args.jobs), (Some(ShardArg::Slurm), Some(1)));
    assert!(
        args.out.unwrap().to_str().unwrap().contains("$SLURM_ARRAY_TASK_ID"),
        "each task has its own file"
    );
}

#[test]
fn the_job_of_kubernetes_has_as_many_completions_as_shards() {
    let text = file("kubernetes.yaml");
    let value = |key: &str| {
        let line = text.lines().find(|line| line.trim().starts_with(&format!("{key}: "))).unwrap();
        line.split(": ").nth(1).unwrap().to_owned()
    };
    assert_eq!(value("completionMode"), "Indexed");
    let (_, command) = text.split_once("exec betadeck ").unwrap();
    let command = command.split("\n          resources:").next().unwrap().replace('"', "");
    let args = campaign(["betadeck"].into_iter().chain(command.split_whitespace()).collect());
    let completions: u64 = value("completions").parse().unwrap();
    assert_eq!(args.shard, Some(ShardArg::Kubernetes(completions)));
    assert!(
        args.out.unwrap().to_str().unwrap().contains("$JOB_COMPLETION_INDEX"),
        "each pod has its own file"
    );
}
