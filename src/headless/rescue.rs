//! `betadeck rescue`: does the craft come home with these settings? Flies GPS RESCUE and the loss of the link from many
//! places, and tries what would mend it.

mod answer;
mod settings;
mod trial;

use std::sync::atomic::Ordering;

use crate::args::{OutputFile, RescueArgs};
use crate::files::input_file;
use crate::files::output_file::{FinalOutput, KeptFiles};
use crate::plan::format::report;
use crate::process::error::AppError;
use crate::process::interrupt::interrupt_flag;
use crate::process::{error, parallel};
use crate::scenario::{BuiltinFiles, CaseFlight, judge, read};
use answer::{Answer, Mend};
use settings::PilotSettings;
use trial::{Craft, Flown, Trial};

/// Settings that are tried when flights fail, each with the reason.
const MENDS: [(&str, &[&str]); 6] = [
    (
        "a landing that does not fall",
        &["ap_altitude_p = 2", "ap_altitude_d = 200", "gps_rescue_descend_rate = 50"],
    ),
    ("a slower descent", &["gps_rescue_descend_rate = 75", "ap_landing_descent_rate = 30"]),
    ("more speed against the wind", &["gps_rescue_ground_speed = 1500", "ap_max_angle = 50"]),
    ("more height on the way", &["gps_rescue_initial_climb = 30", "gps_rescue_return_alt = 50"]),
    ("a way home on a lost link", &["failsafe_procedure = GPS-RESCUE", "ap_rx_loss_policy = DISABLE"]),
    ("no trust in the compass", &["trust_mag = OFF"]),
];
/// The flights with which each is tried: so many that failed, evenly chosen.
const TRIED: usize = 48;

/// Flies, answers, and tries mends. The exit code is 0 if every flight came home.
pub(crate) fn run(args: &RescueArgs) -> Result<u8, AppError> {
    let text = if args.settings.as_os_str() == "-" {
        String::from_utf8_lossy(&input_file::read_stdin()?).into_owned()
    } else {
        input_file::read(&args.settings)?
    };
    let (scenario, json) = outputs(args)?;
    let settings = PilotSettings::read(&text, args.profile);
    settings.notices().iter().for_each(|notice| error::tell(notice));
    let craft = Craft::new(&settings, args.wind.unwrap_or(trial::WIND_MPS), args.airframe.clone());
    let trials = trial::all(args);
    let interrupted = interrupt_flag()?;
    let is_stopped = || interrupted.load(Ordering::Relaxed);
    let fly_all = |craft: &Craft, trials: &[Trial]| -> Result<Vec<Flown>, AppError> {
        let mut all: Vec<Result<Flown, String>> = Vec::new();
        parallel::all(
            trials,
            parallel::threads(args.jobs),
            &is_stopped,
            |_, trial| Some(fly(craft, trial)),
            |flown, _| all.push(flown),
        )?;
        all.into_iter().collect::<Result<Vec<_>, String>>().map_err(AppError::input)
    };
    let flown = fly_all(&craft, &trials)?;
    if is_stopped() {
        return Ok(error::INTERRUPTED);
    }
    let mend = mend(&craft, &flown, fly_all)?;
    let answer = Answer::new(&settings, &craft, flown, mend);
    if let Some(file) = scenario {
        let worst: Vec<Trial> = answer.worst().map(|flown| flown.trial).collect();
        file.write(craft.scenario(&worst).as_bytes())?;
    }
    if let Some(file) = json {
        file.write(answer.json().as_bytes())?;
    }
    match &args.json {
        Some(OutputFile::Stdout) => error::write_stdout(answer.json().as_bytes())?,
        Some(OutputFile::File(_)) | None => error::print(&answer.text(args.scenario.as_deref()))?,
    };
    Ok(if answer.is_safe() { 0 } else { error::FAILED })
}

/// Checks that the files can be written, so that no flight is wasted: that of the scenario and that of the JSON object.
fn outputs(args: &RescueArgs) -> Result<(Option<FinalOutput>, Option<FinalOutput>), AppError> {
    let json = match &args.json {
        Some(OutputFile::File(path)) => Some(path.as_path()),
        Some(OutputFile::Stdout) | None => None,
    };
    let mut kept = KeptFiles::default();
    kept.keep("the settings", &args.settings);
    for (option, path) in [("--scenario", args.scenario.as_deref()), ("--json", json)] {
        path.map_or(Ok(()), |path| kept.claim(option, path))?;
    }
    let prepare = |path: Option<&std::path::Path>| path.map(FinalOutput::prepare).transpose();
    Ok((prepare(args.scenario.as_deref())?, prepare(json)?))
}

/// Flies one trial.
fn fly(craft: &Craft, trial: Trial) -> Result<Flown, String> {
    let text = craft.scenario(&[trial]);
    let scenario = read("the rescue", &text, None, &mut BuiltinFiles).map_err(|errors| report(&errors))?;
    let case = scenario.cases.first().ok_or("the rescue has no flight")?;
    let air = case.airs.first().ok_or("the rescue has no air")?;
    let flown = CaseFlight::new(case, air)?.fly();
    let (_, measures) = judge(case, &flown);
    Ok(Flown::new(trial, &flown, &measures))
}

/// Tries changes of the settings with flights that failed. Returns those that help together; `None` if nothing failed or
/// nothing helps.
fn mend(
    craft: &Craft,
    flown: &[Flown],
    fly_all: impl Fn(&Craft, &[Trial]) -> Result<Vec<Flown>, AppError>,
) -> Result<Option<Mend>, AppError> {
    let failed: Vec<Trial> = flown.iter().filter(|flown| !flown.is_home).map(|flown| flown.trial).collect();
    let every = failed.len().div_ceil(TRIED).max(1);
    let tried: Vec<Trial> = failed.into_iter().step_by(every).collect();
    if tried.is_empty() {
        return Ok(None);
    }
    let (mut best, mut lines): (usize, Vec<&str>) = (0, Vec::new());
    // One after the other, because a second fault is hidden by the first.
    for (_, candidate) in MENDS {
        let with: Vec<&str> = lines.iter().chain(candidate).copied().collect();
        let again = fly_all(&craft.with(&with), &tried)?;
        let home = again.iter().filter(|flown| flown.is_home).count();
        // A few more flights are not worth another change.
        if home > best + tried.len() / 20 {
            (best, lines) = (home, with);
        }
    }
    let lines = lines.iter().map(|line| format!("set {line}")).collect();
    Ok((best > 0).then_some(Mend { lines, home: best, tried: tried.len() }))
}
