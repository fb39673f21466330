//! `betadeck fly`: a whole flight without a screen.
#![allow(clippy::disallowed_methods, reason = "measures the wall time of the flight and paces it when asked")]

use std::fs::File;
use std::io::{BufWriter, Write};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use super::error::{self, AppError};
use super::setup::{self, Extras};
use crate::args::{FlyArgs, OutputFile};
use crate::firmware::cli::Interpreter;
use crate::flight::{Flight, FlightEnd, FlightOptions, FlightResult, Report, Verdict};
use crate::plan::format::PlanFile;
use crate::record::{End, GpxHeader, GpxWriter, TrackPoint, UtcSeconds, json, sentence};
use crate::session::{Pacer, upload};
use crate::signals::SimTime;
use crate::storage::Store;
use crate::vehicle::Vehicle;

/// Ticks between two looks at the clock and at an interrupt.
const SLICE: u64 = 4096;

/// Flies and reports; the exit code says whether the mission completed.
pub fn run(args: &FlyArgs) -> Result<u8, AppError> {
    let plan = setup::read_plan(&args.plan)?;
    let mut notices: Vec<String> = plan.notes.iter().map(ToString::to_string).collect();
    let mut store = open_store(args)?;
    let extras = Extras {
        faults: args.faults().collect(),
        set: args.set.clone(),
        plan_settings: plan.settings.clone(),
        arm_assist: false,
        live: false,
    };
    let mut vehicle = setup::vehicle(&args.flight, &plan, &mut store, extras, &mut notices)?;
    vehicle.hands.inputs.clone_from(&args.stick);
    upload_plan(&mut vehicle, &plan.plan)?;
    for notice in notices {
        vehicle.notice(notice);
    }
    let mut output = Output::open(args, &vehicle, &plan)?;
    let options = FlightOptions {
        takeoff_m: args.takeoff_m(),
        timeout: SimTime::from_secs_f64(args.timeout_s()),
        samples_hz: args.samples.unwrap_or(0.0),
    };
    let flight = Flight::new(vehicle, &options).map_err(|mode| {
        AppError::input(format!(
            "no channel switches {mode}: the pilot needs one; set it with an aux line in --settings"
        ))
    })?;
    let (end, wall) = fly(flight, args.speed(), &mut output)?;
    let end_record = End {
        result: end.verdict.result.to_string(),
        reason: end.verdict.reason,
        flown_s: end.flown_s,
        wall_s: wall.as_secs_f64(),
    };
    output.finish(end.time, &end_record)?;
    Ok(exit_code(end.verdict.result))
}

fn exit_code(result: FlightResult) -> u8 {
    match result {
        FlightResult::Complete => 0,
        FlightResult::Landed
        | FlightResult::Refused
        | FlightResult::Aborted
        | FlightResult::Disarmed
        | FlightResult::Crashed
        | FlightResult::Timeout => error::FAILED,
        FlightResult::Diverged => error::INTERNAL,
        FlightResult::Interrupted => error::INTERRUPTED,
    }
}

/// `fly` starts fresh unless a directory is named.
fn open_store(args: &FlyArgs) -> Result<Store, AppError> {
    match &args.flight.state_dir {
        Some(directory) => {
            Store::open(directory, false).map_err(|error| AppError::environment(error.to_string()))
        }
        None => Ok(Store::in_memory()),
    }
}

/// Uploads as a ground station does; a plan the craft refuses is invalid input.
fn upload_plan(vehicle: &mut Vehicle, plan: &crate::plan::FlightPlan) -> Result<(), AppError> {
    let mut console = Interpreter::default();
    for line in upload::lines(plan, &[]) {
        let reply = vehicle.firmware_mut().run_cli(&mut console, &line);
        if reply.failed {
            return Err(AppError::input(format!("the craft refused `{line}`: {}", reply.text.trim())));
        }
    }
    Ok(())
}

/// Runs the flight to its end; the wall time counts from the engagement, or from boot when there was none.
fn fly(mut flight: Flight, speed: f64, output: &mut Output) -> Result<(FlightEnd, Duration), AppError> {
    let interrupted = interrupt_flag()?;
    let started = Instant::now();
    let mut engaged: Option<Instant> = None;
    let mut pacer = Pacer::new(flight.vehicle().step_us(), speed);
    let mut problem = None;
    loop {
        let due = pacer.due(started.elapsed(), SLICE);
        for _ in 0..due {
            let end = flight.tick(|report| {
                if let Err(error) = output.report(&report) {
                    problem.get_or_insert(error);
                }
            });
            if engaged.is_none() && flight.engaged_at().is_some() {
                engaged = Some(Instant::now());
            }
            if let Err(error) = output.track(flight.vehicle()) {
                problem.get_or_insert(error);
            }
            if let Some(error) = problem.take() {
                return Err(error);
            }
            if let Some(end) = end {
                return Ok((end, engaged.unwrap_or(started).elapsed()));
            }
        }
        if interrupted.load(Ordering::Relaxed) {
            let verdict =
                Verdict { result: FlightResult::Interrupted, reason: "stopped by a signal".to_owned() };
            let time = flight.vehicle().time();
            let flown_s = time.seconds_since(flight.engaged_at().unwrap_or_default());
            return Ok((FlightEnd { verdict, flown_s, time }, engaged.unwrap_or(started).elapsed()));
        }
        if due < SLICE {
            // Somebody may be watching.
            output.flush()?;
            std::thread::sleep(Duration::from_millis(2));
        }
    }
}

/// A flag that SIGINT and SIGTERM set.
fn interrupt_flag() -> Result<Arc<AtomicBool>, AppError> {
    let deaf = |error| AppError::environment(format!("cannot listen for signals: {error}"));
    let flag = Arc::new(AtomicBool::new(false));
    let raised = Arc::clone(&flag);
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build().map_err(deaf)?;
    let stop = {
        let _inside = runtime.enter();
        super::signals::stop().map_err(deaf)?
    };
    std::thread::Builder::new()
        .name("signals".to_owned())
        .spawn(move || {
            runtime.block_on(stop);
            raised.store(true, Ordering::Relaxed);
        })
        .map_err(|error| AppError::environment(format!("cannot start a thread: {error}")))?;
    Ok(flag)
}

/// Where the reports go.
struct Output {
    lines: Option<BufWriter<Box<dyn Write>>>,
    /// JSON lines, or sentences.
    json: bool,
    gpx: Option<GpxWriter<BufWriter<File>>>,
}

impl Output {
    fn open(args: &FlyArgs, vehicle: &Vehicle, plan: &PlanFile) -> Result<Self, AppError> {
        let stdout = || Box::new(std::io::stdout()) as Box<dyn Write>;
        let (target, json): (Box<dyn Write>, bool) = match &args.json {
            None => (stdout(), false),
            Some(OutputFile::Stdout) => (stdout(), true),
            Some(OutputFile::File(path)) => (Box::new(create(path)?), true),
        };
        let gpx = match &args.gpx {
            None => None,
            Some(path) => {
                let home_amsl_m = vehicle.world().local_frame().alt_amsl_m;
                let header = GpxHeader {
                    creator: "betadeck (simulated)".to_owned(),
                    track: plan.name.clone(),
                    home_amsl_m,
                    boot: UtcSeconds::SIMULATED_BOOT,
                };
                let file = BufWriter::new(create(path)?);
                Some(GpxWriter::new(file, header, &plan.plan).map_err(write_failed)?)
            }
        };
        Ok(Self { lines: Some(BufWriter::new(target)), json, gpx })
    }

    fn report(&mut self, report: &Report) -> Result<(), AppError> {
        let line = match report {
            Report::Event(event) if self.json => json::event_line(event),
            Report::Event(event) => sentence::line(event),
            Report::Sample(vehicle) => Some(json::sample_line(&vehicle.snapshot())),
        };
        line.map_or(Ok(()), |line| self.line(&line))
    }

    fn line(&mut self, line: &str) -> Result<(), AppError> {
        let Some(lines) = &mut self.lines else { return Ok(()) };
        let written = writeln!(lines, "{line}");
        self.after(written)
    }

    fn flush(&mut self) -> Result<(), AppError> {
        let Some(lines) = &mut self.lines else { return Ok(()) };
        let written = lines.flush();
        self.after(written)
    }

    /// A reader that went away has seen enough; the flight and its exit code go on.
    fn after(&mut self, written: std::io::Result<()>) -> Result<(), AppError> {
        match written {
            Ok(()) => Ok(()),
            Err(error) if error.kind() == std::io::ErrorKind::BrokenPipe => {
                self.lines = None;
                Ok(())
            }
            Err(error) => Err(write_failed(error)),
        }
    }

    fn track(&mut self, vehicle: &Vehicle) -> Result<(), AppError> {
        let Some(gpx) = &mut self.gpx else { return Ok(()) };
        if !vehicle.time().0.is_multiple_of(1_000_000) {
            return Ok(());
        }
        let truth = vehicle.world().truth();
        let frame = vehicle.world().local_frame();
        let (lat_deg, lon_deg, amsl_m) = frame.to_geodetic(truth.pos_enu);
        let alt_m = amsl_m - frame.alt_amsl_m;
        gpx.offer(&TrackPoint { time: vehicle.time(), lat_deg, lon_deg, alt_m }).map_err(write_failed)
    }

    fn finish(mut self, time: SimTime, end: &End) -> Result<(), AppError> {
        if self.json {
            self.line(&json::end_line(time, end))?;
        }
        self.flush()?;
        if let Some(gpx) = self.gpx.take() {
            gpx.finish().map_err(write_failed)?.flush().map_err(write_failed)?;
        }
        error::tell(&end.result_line());
        error::tell(&end.flown_line());
        Ok(())
    }
}

fn create(path: &std::path::Path) -> Result<File, AppError> {
    File::create(path)
        .map_err(|error| AppError::environment(format!("cannot write {}: {error}", path.display())))
}

#[expect(clippy::needless_pass_by_value, reason = "a map_err argument")]
fn write_failed(error: std::io::Error) -> AppError {
    AppError::environment(format!("cannot write the output: {error}"))
}
