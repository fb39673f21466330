//! The options of `campaign`.

use std::path::PathBuf;
use std::str::FromStr;

use super::value::{self, OutputFile};
use super::{FirmwareArgs, FirmwareChoice, FirmwarePortArgs, FlightArgs, MissionArgs, TroubleArgs, help};
use crate::campaign::Shard;
use crate::design::Design;
use crate::scenario::MAX_CAMPAIGN;
use crate::sim::ScheduledFault;

/// The options of `campaign`.
#[derive(Debug, Clone, Default, PartialEq, clap::Args)]
// Each flight starts from defaults, as fast as the machine allows.
#[command(
    after_help = help::CAMPAIGN,
    args_conflicts_with_subcommands = true,
    subcommand_negates_reqs = true,
    disable_help_subcommand = true,
    mut_arg("state_dir", |option| option.hide(true)),
    mut_arg("fresh", |option| option.hide(true)),
    mut_arg("speed", |option| option.hide(true)),
    mut_arg("arm_assist", |option| option.hide(true))
)]
pub struct CampaignArgs {
    /// Another task than flying.
    #[command(subcommand)]
    pub command: Option<CampaignCommand>,

    /// A scenario or a plan: a built-in name or a file, - for standard input; or the file of an earlier --out, to go on
    #[arg(value_name = "FILE|PLAN", required = true)]
    pub what: Option<String>,

    /// Number of flights [default: the one of the file; a plan: 1000]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=MAX_CAMPAIGN), help_heading = "Which")]
    pub flights: Option<u64>,

    /// Lets a scenario name files that are not in its folder: plans, settings, airframes
    #[arg(long, help_heading = "Which")]
    pub any_folder: bool,

    /// How the flights are spread over the inputs: grid, monte-carlo, latin-hypercube, sobol [default: the one of the
    /// file; lists only: grid, else monte-carlo]
    #[arg(long, value_name = "DESIGN", value_parser = design, help_heading = "Which")]
    pub design: Option<Design>,

    /// Takes these seeds in turn, such as 1..20, instead of another one for each flight
    #[arg(long, value_name = "A..B", value_parser = seed_range, conflicts_with = "seed", help_heading = "Which")]
    pub seeds: Option<(u64, u64)>,

    /// Varies an input of a plan's flights, such as wind=6+-2@250+-20, mass_pct=+-3, settings.ap_max_angle=20..40,
    /// faults.gps-loss,6=5..40; repeatable
    ///
    /// NAME is a key of [vary] in a scenario. VALUES is a distribution (4..8 uniform, 6+-2 normal, weibull(6, 2)), the
    /// file of a wind rose or a forecast (wind='table rose.csv'), or a list ('turbulence=["none", "light"]').
    #[arg(long, value_name = "NAME=VALUES", help_heading = "Which")]
    pub vary: Vec<String>,

    /// Expects this of all flights together, such as 'success >= 99 % with 95 % confidence' or 'p95(touchdown) <= 2 m';
    /// repeatable
    #[arg(long, value_name = "TEXT", help_heading = "Which")]
    pub expect: Vec<String>,

    /// Flies a plan with this fault at every second of the flight instead, such as gps-loss,6 or motor,,2:0.7, and shows
    /// when and where it is fatal
    #[arg(
        long, value_name = "NAME[,FOR][,VALUE]", value_parser = ScheduledFault::without_time, help_heading = "Which",
        conflicts_with_all = ["flights", "design", "seeds", "vary", "expect", "shard", "vs", "vs_settings", "vs_firmware",
            "out", "junit", "markdown"]
    )]
    pub sweep: Option<ScheduledFault>,

    /// Flies only a part of the campaign: K/N (K from 1), slurm (a task of an array job), k8s/N (a pod of an indexed job)
    #[arg(long, value_name = "PART", help_heading = "Which")]
    pub shard: Option<ShardArg>,

    /// Number of flights at the same time [default: one per processor]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=256), help_heading = "How")]
    pub jobs: Option<u32>,

    /// Flies each flight a second time with this setting, and compares the two; repeatable
    #[arg(long, value_name = "NAME=VALUE", value_parser = value::setting, help_heading = "Comparison")]
    pub vs: Vec<String>,

    /// The same with each `set` line of a file
    #[arg(long, value_name = "FILE", help_heading = "Comparison")]
    pub vs_settings: Option<PathBuf>,

    /// The same with another firmware: embedded, or the path of a SITL executable
    #[arg(long, value_name = "WHICH", help_heading = "Comparison")]
    pub vs_firmware: Option<FirmwareChoice>,

    /// Appends each flight to this file as a line of JSON, and goes on where the file ends
    #[arg(long, value_name = "FILE", value_parser = value::output_path, help_heading = "Output")]
    pub out: Option<PathBuf>,

    /// The outputs of the answer.
    #[command(flatten)]
    pub output: CampaignOutputArgs,

    /// The flight and the judgement of the plan.
    #[command(flatten)]
    pub mission: MissionArgs,

    /// The sticks and the faults.
    #[command(flatten)]
    pub trouble: TroubleArgs,

    /// The choice of the firmware.
    #[command(flatten)]
    pub firmware: FirmwareArgs,

    /// The ports of the firmware.
    #[command(flatten)]
    pub firmware_ports: FirmwarePortArgs,

    /// The craft, its position and the air.
    #[command(flatten)]
    pub flight: FlightArgs,
}

/// The outputs of an answer.
#[derive(Debug, Clone, Default, PartialEq, clap::Args)]
pub struct CampaignOutputArgs {
    /// Writes the flights as a table with commas
    #[arg(long, value_name = "FILE", value_parser = value::output_path, help_heading = "Output")]
    pub csv: Option<PathBuf>,

    /// Writes the answer as one JSON object; - is standard output, in place of the sentences
    #[arg(long, value_name = "FILE|-", help_heading = "Output")]
    pub json: Option<OutputFile>,

    /// Writes a JUnit file with one testcase for each expectation of the campaign
    #[arg(long, value_name = "FILE", value_parser = value::output_path, help_heading = "Output")]
    pub junit: Option<PathBuf>,

    /// Writes the answer in Markdown, for a pull request
    #[arg(long, value_name = "FILE", value_parser = value::output_path, help_heading = "Output")]
    pub markdown: Option<PathBuf>,

    /// Writes a report as one HTML file: the answer, distributions, what explains the failures, the worst flights
    #[arg(long, value_name = "FILE", value_parser = value::output_path, help_heading = "Output")]
    pub report: Option<PathBuf>,
}

/// The other tasks of `campaign`.
#[derive(Debug, Clone, PartialEq, clap::Subcommand)]
pub enum CampaignCommand {
    /// Joins the files of all shards to the one that a single machine would have written, and answers
    #[command(before_help = help::examples(&[
        ("betadeck campaign merge part-*.jsonl --out run.jsonl", "the answer, and the file for betadeck open"),
    ]))]
    Merge(MergeArgs),
}

/// The options of `campaign merge`.
#[derive(Debug, Clone, PartialEq, clap::Args)]
pub struct MergeArgs {
    /// The files of the shards, in any order
    #[arg(value_name = "PART", required = true)]
    pub parts: Vec<PathBuf>,

    /// Writes the flights of all shards
    #[arg(long, value_name = "FILE", value_parser = value::output_path, help_heading = "Output")]
    pub out: PathBuf,

    /// The outputs of the answer.
    #[command(flatten)]
    pub output: CampaignOutputArgs,
}

/// A part of a campaign.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ShardArg {
    Part(Shard),
    /// The part of a task of a Slurm array.
    Slurm,
    /// The part of a pod of a Kubernetes Indexed Job with so many completions.
    Kubernetes(u64),
}

impl FromStr for ShardArg {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if text == "slurm" {
            return Ok(Self::Slurm);
        }
        let shard = |text: &str| text.parse::<Shard>().map_err(|error| error.to_string());
        match text.strip_prefix("k8s/") {
            // The number of pods is checked like one of so many shards.
            Some(count) => Ok(Self::Kubernetes(shard(&format!("1/{count}"))?.of)),
            None => shard(text).map(Self::Part).map_err(|error| format!("{error}, slurm or k8s/N")),
        }
    }
}

fn design(text: &str) -> Result<Design, String> {
    use strum::VariantNames as _;
    text.parse().map_err(|_| format!("allowed are {}", Design::VARIANTS.join(", ")))
}

fn seed_range(text: &str) -> Result<(u64, u64), String> {
    crate::scenario::seed_range(text)
        .map(|seeds| (*seeds.start(), *seeds.end()))
        .map_err(|problem| format!("{problem}; write 1..20, both included"))
}

impl CampaignArgs {
    /// Returns `true` if each flight is flown by two sides.
    pub fn has_two_sides(&self) -> bool {
        !self.vs.is_empty() || self.vs_settings.is_some() || self.vs_firmware.is_some()
    }

    /// Returns the given options that only a plan takes.
    pub fn of_plan(&self) -> Vec<&'static str> {
        let (mission, trouble, flight) = (&self.mission, &self.trouble, &self.flight);
        let given = [
            ("--vary", !self.vary.is_empty()),
            ("--expect", !self.expect.is_empty()),
            ("--takeoff", mission.takeoff.is_some()),
            ("--tolerance", mission.tolerance.is_some()),
            ("--timeout", mission.timeout.is_some()),
            ("--set", !mission.set.is_empty()),
            ("--stick", !trouble.stick.is_empty()),
            ("--rx-loss-at", trouble.rx_loss_at.is_some()),
            ("--gps-loss-at", trouble.gps_loss_at.is_some()),
            ("--fault", !trouble.fault.is_empty()),
            ("--home", flight.home.is_some()),
            ("--heading", flight.heading.is_some()),
            ("--airframe", flight.airframe.is_some()),
            ("--settings", flight.settings.is_some()),
            ("--profile", flight.profile.is_some()),
            ("--attitude", flight.attitude.is_some()),
            ("--wind", flight.wind.is_some()),
            ("--gust", flight.gust.is_some()),
            ("--turbulence", flight.turbulence.is_some()),
            ("--noise", flight.noise.is_some()),
            ("--world", !flight.world.is_empty()),
            ("--terrain", flight.terrain.directory.is_some()),
            ("--seed", flight.seed.is_some()),
            ("--rate", flight.rate.is_some()),
        ];
        given.into_iter().filter(|(_, is_given)| *is_given).map(|(option, _)| option).collect()
    }

    /// Checks the combination of the typed options.
    pub(super) fn check(&self) -> Result<(), String> {
        let flight = &self.flight;
        if flight.state_dir.is_some() || flight.arm_assist.is_some() || flight.speed.is_some() {
            return Err("--state-dir, --arm-assist and --speed: the flights of a campaign start from defaults, and are \
                        flown as fast as the machine allows; leave the option out"
                .to_owned());
        }
        if self.shard.is_some() && self.out.is_none() {
            return Err("--shard needs --out FILE: the files of all shards are merged later".to_owned());
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_are_numbers_or_the_names_of_engines() {
        assert_eq!("3/7".parse(), Ok(ShardArg::Part(Shard::new(3, 7).unwrap())));
        assert_eq!("slurm".parse(), Ok(ShardArg::Slurm));
        assert_eq!("k8s/20".parse(), Ok(ShardArg::Kubernetes(20)));
        let error = "0/7".parse::<ShardArg>().unwrap_err();
        assert!(
            error.starts_with("there is no shard 0 of 7") && error.ends_with("slurm or k8s/N"),
            "{error}"
        );
        assert!("k8s/0".parse::<ShardArg>().is_err());
        assert!("pbs".parse::<ShardArg>().is_err());
    }
}
