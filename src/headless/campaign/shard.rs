//! The part of a campaign that this process flies, also from the environment of an array job.
#![allow(clippy::disallowed_methods, reason = "the environment of an array job names its part")]

use crate::args::ShardArg;
use crate::campaign::Shard;
use crate::process::error::AppError;

/// Returns the part that the option names.
pub(super) fn of(shard: Option<ShardArg>) -> Result<Shard, AppError> {
    let variable = |name: &str| std::env::var(name).ok();
    let shard = match shard {
        None => return Ok(Shard::WHOLE),
        Some(ShardArg::Part(shard)) => return Ok(shard),
        Some(ShardArg::Slurm) => of_slurm(&variable),
        Some(ShardArg::Kubernetes(count)) => of_kubernetes(count, &variable),
    };
    shard.map_err(AppError::input)
}

/// Returns the part of a task of a Slurm array, whose tasks need not begin at 0 or 1.
fn of_slurm(variable: &dyn Fn(&str) -> Option<String>) -> Result<Shard, String> {
    let number = |name: &str| {
        number(name, variable, "--shard slurm is for a task of an array job (sbatch --array=1-N)")
    };
    let task = number("SLURM_ARRAY_TASK_ID")?;
    let (first, count) = (number("SLURM_ARRAY_TASK_MIN")?, number("SLURM_ARRAY_TASK_COUNT")?);
    let step = number("SLURM_ARRAY_TASK_STEP").unwrap_or(1).max(1);
    let last = number("SLURM_ARRAY_TASK_MAX").unwrap_or(first + (count.max(1) - 1) * step);
    // An array such as 3,5 has gaps: its tasks are no parts of a whole.
    if task < first || (last - first.min(last)) / step + 1 != count || (task - first) % step != 0 {
        return Err(format!(
            "--shard slurm: the {count} tasks of this array go from {first} to {last} with gaps, so they are not the parts \
             of a campaign; submit --array=1-N as before (finished parts end at once), or write --shard K/N"
        ));
    }
    Shard::new((task - first) / step + 1, count).map_err(|error| format!("--shard slurm: {error}"))
}

/// Returns the part of a pod of an Indexed Job, whose indices count from 0.
fn of_kubernetes(count: u64, variable: &dyn Fn(&str) -> Option<String>) -> Result<Shard, String> {
    let name = "JOB_COMPLETION_INDEX";
    let index = number(name, variable, "--shard k8s/N is for a pod of a Job with completionMode: Indexed")?;
    if index >= count {
        return Err(format!(
            "--shard k8s/{count}: {name} is {index}; N must be the number of completions of the Job"
        ));
    }
    Shard::new(index + 1, count).map_err(|error| format!("--shard k8s: {error}"))
}

fn number(name: &str, variable: &dyn Fn(&str) -> Option<String>, why: &str) -> Result<u64, String> {
    let text = variable(name).ok_or_else(|| format!("{name} is not set: {why}"))?;
    text.trim().parse().map_err(|_| format!("{name} is {text:?}, which is no number: {why}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn slurm(values: [(&str, &str); 5]) -> Result<String, String> {
        let find = move |name: &str| {
            let found = values.iter().find(|(known, _)| *known == name);
            found.map(|(_, value)| (*value).to_owned()).filter(|value| !value.is_empty())
        };
        of_slurm(&find).map(|shard| shard.to_string())
    }

    fn task(
        id: &'static str,
        min: &'static str,
        max: &'static str,
        count: &'static str,
        step: &'static str,
    ) -> Result<String, String> {
        slurm([
            ("SLURM_ARRAY_TASK_ID", id),
            ("SLURM_ARRAY_TASK_MIN", min),
            ("SLURM_ARRAY_TASK_MAX", max),
            ("SLURM_ARRAY_TASK_COUNT", count),
            ("SLURM_ARRAY_TASK_STEP", step),
        ])
    }

    #[test]
    fn the_tasks_of_an_array_are_the_parts() {
        assert_eq!(task("3", "1", "7", "7", ""), Ok("3/7".to_owned()));
        assert_eq!(task("0", "0", "6", "7", "1"), Ok("1/7".to_owned()));
        assert_eq!(task("15", "11", "19", "5", "2"), Ok("3/5".to_owned()));
        assert_eq!(task("4", "1", "", "7", ""), Ok("4/7".to_owned()));
        let gaps = task("5", "3", "5", "2", "1").unwrap_err();
        assert!(gaps.contains("go from 3 to 5 with gaps"), "{gaps}");
        let outside = task("", "1", "7", "7", "").unwrap_err();
        assert!(
            outside.starts_with("SLURM_ARRAY_TASK_ID is not set: --shard slurm is for a task"),
            "{outside}"
        );
        assert!(task("x", "1", "7", "7", "").is_err());
    }

    #[test]
    fn the_pods_of_a_job_are_the_parts() {
        let pod = |index: &'static str| {
            of_kubernetes(20, &move |name| {
                (name == "JOB_COMPLETION_INDEX" && !index.is_empty()).then(|| index.to_owned())
            })
            .map(|shard| shard.to_string())
        };
        assert_eq!(pod("0"), Ok("1/20".to_owned()));
        assert_eq!(pod("19"), Ok("20/20".to_owned()));
        assert!(pod("20").unwrap_err().contains("the number of completions"));
        assert!(pod("").unwrap_err().contains("completionMode: Indexed"));
    }
}
