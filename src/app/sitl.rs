//! `betadeck sitl`: the firmware alone, as a drop-in for the SITL executable.
#![allow(clippy::disallowed_methods, reason = "a track is dated by the wall clock")]

use std::cell::Cell;
use std::fs::File;
use std::io::{self, BufWriter, Write as _};
use std::net::{IpAddr, Ipv4Addr};
use std::path::Path;
use std::time::{SystemTime, UNIX_EPOCH};

use tokio::sync::Notify;

use crate::args::{OnOff, SitlArgs};
use crate::files::input_file;
use crate::files::output_file::KeptFiles;
use crate::firmware::cli::{ApplyReport, CliContext, CliFacts, CliMode, Interpreter, provision};
use crate::flight::FlightSetup;
use crate::flight::setup::PhysicsSource;
use crate::headless::setup::attitude_source;
use crate::link::ListenConfig;
use crate::link::proto::fdm_link::FdmLinkConfig;
use crate::process::error::AppError;
use crate::process::{error, runtime, stop_signal};
use crate::report::gpx::{GpxHeader, GpxPoint, GpxWriter, UtcSeconds};
use crate::session::sitl::{OutputLine, Sitl, SitlConfig, SitlEnd, SitlError, SitlPorts, show_links};
use crate::storage::Store;
use crate::telemetry::Snapshot;
use crate::text::printable;

/// The name of the track file.
const TRACK: &str = "sitl_track.gpx";

/// Runs until a signal, or through a configuration file, and returns the exit code.
pub(super) fn run(args: &SitlArgs) -> Result<u8, AppError> {
    if !args.doors.mavlink.is_empty() {
        let why =
            "sitl offers no MAVLink, as the SITL executable does not: use betadeck or serve with --mavlink";
        return Err(AppError::input(why));
    }
    let runtime = runtime::with_threads(2)?;
    let config = config(args);
    match &args.config {
        Some(file) => {
            let text = input_file::read(file).map_err(|error| {
                let message = match error.code {
                    error::ENVIRONMENT => format!("Config file not found: {}", file.display()),
                    _ => format!("Config file not used: {error}"),
                };
                AppError { code: error::FAILED, message: format!("[SITL] {message}") }
            })?;
            say(OutputLine::Out(format!(
                "[SITL] Config file: {} (will load, save to EEPROM, and exit)",
                file.display()
            )));
            runtime.block_on(show_links(&config, &mut say));
            apply(args, file, &text)
        }
        None => runtime.block_on(fly(args, config)),
    }
}

fn config(args: &SitlArgs) -> SitlConfig {
    let (doors, ports) = (&args.doors, args.doors.udp_ports());
    SitlConfig {
        doors: ListenConfig {
            listen: doors.listen,
            tcp_port: (!doors.no_ports).then_some(doors.tcp_port()),
            ws_port: (!doors.no_ports).then_some(doors.ws_port()),
            allow_origin: doors.allow_origin.clone(),
            ..ListenConfig::default()
        },
        motors_ip: args.ip.unwrap_or(IpAddr::V4(Ipv4Addr::LOCALHOST)),
        ports: SitlPorts { raw: ports.raw, motors: ports.motors, fdm: ports.fdm, rc: ports.rc },
        firmware: FlightSetup {
            physics: PhysicsSource::External,
            arm_assist: args.arm_assist.is_none_or(OnOff::is_on),
            attitude: args.attitude.map(attitude_source),
            ..FlightSetup::default()
        }
        .firmware_options(),
        build: crate::headless::setup::build_info(),
        fdm: FdmLinkConfig {
            dialect: args.simulator.fdm_dialect.unwrap_or_default().0,
            mirror: args.simulator.fdm_mirror.unwrap_or_default(),
            ..FdmLinkConfig::default()
        },
        motor_order: args.simulator.motor_order.unwrap_or_default(),
        profile: args.profile,
        exit_on_reboot: args.exit_on_reboot,
    }
}

fn store_directory(args: &SitlArgs) -> &Path {
    args.state_dir.as_deref().unwrap_or(Path::new("."))
}

fn open_store(args: &SitlArgs) -> Result<Store, AppError> {
    Store::open(store_directory(args), args.overwrite_config)
        .map_err(|error| AppError::environment(error.to_string()))
}

fn print(said: &OutputLine) -> io::Result<()> {
    match said {
        OutputLine::Out(line) => {
            let mut out = io::stdout().lock();
            writeln!(out, "{}", printable::line(line)).and_then(|()| out.flush())
        }
        OutputLine::Err(line) => {
            error::tell(line);
            Ok(())
        }
    }
}

/// Prints a line, with or without a reader.
#[expect(clippy::needless_pass_by_value, reason = "what a session prints with")]
fn say(said: OutputLine) {
    print(&said).ok();
}

async fn fly(args: &SitlArgs, config: SitlConfig) -> Result<u8, AppError> {
    let unread = Notify::new();
    // The error of standard output, unless its reader went away.
    let failed = Cell::new(None);
    let mut print = |said: OutputLine| {
        if let Err(error) = print(&said) {
            failed.set(Some(error).filter(|error| error.kind() != io::ErrorKind::BrokenPipe));
            unread.notify_one();
        }
    };
    if args.gpx {
        let mut kept = KeptFiles::default();
        kept.keep_store(store_directory(args));
        kept.claim("--gpx", Path::new(TRACK))?;
    }
    let stop = stop_signal::stop_in_time()
        .map_err(|error| AppError::environment(format!("cannot listen for signals: {error}")))?;
    let sitl = Sitl::open(config, open_store(args)?, &mut print)
        .await
        .map_err(|error: SitlError| AppError::environment(error.to_string()))?;
    let mut track = Track { wanted: args.gpx, writer: None };
    let was_read = Cell::new(true);
    let stop = async {
        tokio::select! {
            () = stop => {}
            () = unread.notified() => was_read.set(false),
        }
    };
    let (end, doors) = sitl.run(&mut print, &mut |vehicle| track.record(vehicle), stop).await;
    // This comes first, because a client that does not read keeps its door open for a while.
    track.finish();
    doors.close().await;
    if let Some(error) = failed.take() {
        return Err(AppError::environment(format!("cannot write the output: {error}")));
    }
    Ok(match end {
        SitlEnd::Stopped if was_read.get() => error::INTERRUPTED,
        SitlEnd::Stopped | SitlEnd::Rebooted => 0,
    })
}

/// Applies the lines of a configuration file and stores the result.
fn apply(args: &SitlArgs, file: &Path, text: &str) -> Result<u8, AppError> {
    let mut store = open_store(args)?;
    let loaded = store.load();
    loaded.findings.into_iter().for_each(|finding| say(OutputLine::Err(finding)));
    let mut configuration = loaded.configuration;
    if let Some(profile) = args.profile {
        configuration.settings.set_profile(profile);
    }
    say(OutputLine::Out(format!("[CONFIG] Processing config file: {}", file.display())));
    let facts = CliFacts { storage: store.facts(), ..CliFacts::default() };
    let mut context = CliContext { configuration: &mut configuration, facts: &facts };
    let mut interpreter = Interpreter::new(CliMode::File).lenient(args.lenient);
    let mut session = String::new();
    let report = provision(text, &mut interpreter, &mut context, |text| session += text);
    error::print(&session)?;
    say(OutputLine::Out(String::new()));
    tell_failures(&report);
    if report.batch_failed {
        say(OutputLine::Out("[CONFIG] prepareSave failed".to_owned()));
        return Ok(error::FAILED);
    }
    store.save(&configuration).map_err(|error| AppError::environment(error.to_string()))?;
    say(OutputLine::Out("[CONFIG] Config file processed, EEPROM saved".to_owned()));
    Ok(if args.strict && !report.failed.is_empty() { error::FAILED } else { 0 })
}

fn tell_failures(report: &ApplyReport) {
    if report.failed.is_empty() {
        return;
    }
    let numbers: Vec<String> = report.failed.iter().map(|failed| failed.number.to_string()).collect();
    say(OutputLine::Err(format!(
        "[CONFIG] {} of {} lines failed: {}",
        report.failed.len(),
        report.commands,
        numbers.join(", ")
    )));
}

/// The track, which begins at the first position.
struct Track {
    wanted: bool,
    writer: Option<(GpxWriter<BufWriter<File>>, f64)>,
}

impl Track {
    fn record(&mut self, vehicle: &Snapshot) {
        let Some(gps) = vehicle.craft.gps.filter(|_| self.wanted && vehicle.craft.has_fix()) else { return };
        let (place, alt_amsl_m) = (gps.position, gps.alt_amsl_m);
        if self.writer.is_none() {
            match begin(vehicle, alt_amsl_m) {
                Ok(writer) => self.writer = Some((writer, alt_amsl_m)),
                Err(error) => return self.give_up(&error),
            }
        }
        let Some((writer, home_amsl_m)) = &mut self.writer else { return };
        let point = GpxPoint {
            time: vehicle.time,
            lat_deg: place.lat_deg(),
            lon_deg: place.lon_deg(),
            alt_m: alt_amsl_m - *home_amsl_m,
        };
        if let Err(error) = writer.offer(&point) {
            self.give_up(&error);
        }
    }

    fn give_up(&mut self, error: &io::Error) {
        self.wanted = false;
        say(OutputLine::Err(format!("cannot write {TRACK}: {error}; the track ends here")));
    }

    fn finish(self) {
        if let Some((writer, _)) = self.writer {
            match writer.finish() {
                Ok(_) => say(OutputLine::Out(format!("[SITL] GPS track written to {TRACK}"))),
                Err(error) => say(OutputLine::Err(format!("cannot write {TRACK}: {error}"))),
            }
        }
    }
}

fn begin(vehicle: &Snapshot, home_amsl_m: f64) -> io::Result<GpxWriter<BufWriter<File>>> {
    let now_s = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |elapsed| elapsed.as_secs());
    // Points count from the boot of the firmware.
    let boot = UtcSeconds(now_s.saturating_sub(vehicle.time.0 / 1_000_000));
    let file = BufWriter::new(File::create(TRACK)?);
    GpxWriter::new(file, GpxHeader::sitl(home_amsl_m, boot), &vehicle.stored_plan.clone().unwrap_or_default())
}
