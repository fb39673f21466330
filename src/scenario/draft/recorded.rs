//! A recorded flight as a draft: the configuration at the start, and the later inputs as sentences.

use super::Draft;
use super::past::Past;
use super::toml_text::{after_boot, quoted};
use crate::firmware::Firmware;
use crate::geo::LatLon;
use crate::pilot::{RcTransmitter, channel_name};
use crate::plan::format::{HomePosition, setting_line};
use crate::plan::upload_lines;
use crate::signals::{RcFrame, SimTime};
use crate::sim::WorldCommand;
use crate::telemetry::InFlightCommand;
use crate::timeline::RecordedFlight;
use crate::vehicle::{Answer, Reply, Vehicle, VehicleCommand};

/// Lines of `diff all` that set nothing on the craft, or that the scenario gives in another place.
const PASSED_OVER: [&str; 12] = [
    "#",
    "batch",
    "defaults",
    "board_name",
    "manufacturer_id",
    "mcu_id",
    "signature",
    "waypoint",
    "save",
    "profile",
    "rateprofile",
    "battery_profile",
];
/// Command lines that change nothing.
const READING: [&str; 14] = [
    "get",
    "dump",
    "diff",
    "status",
    "version",
    "help",
    "tasks",
    "list",
    "exit",
    "save",
    "#",
    "waypoint list",
    "resource",
    "mcu_id",
];

impl Draft {
    /// Returns a scenario that repeats the recorded flight.
    ///
    /// # Errors
    /// Returns a sentence with the reason if the flight cannot be repeated.
    pub fn from_recorded(name: &str, flight: RecordedFlight) -> Result<Self, String> {
        let past = Past::of(&flight);
        let RecordedFlight { mut start, inputs, .. } = flight;
        let start_at = start.time();
        let (settings, lines) = configuration(&mut start)?;
        let external = "an external simulator moved the craft: its motion cannot be repeated";
        let status = start.world_status().ok_or(external)?;
        let frame = start.local_frame().ok_or(external)?;
        let truth = start.truth().ok_or(external)?;
        let craft = start.airframe().ok_or(external)?;
        let mut air = vec![
            ("wind", quoted(&status.wind.to_string())),
            ("gust_mps", status.gust_mps.to_string()),
            ("turbulence", quoted(&status.turbulence.to_string())),
            ("noise", quoted(&status.noise.to_string())),
        ];
        let world_lines = status.switches.changed();
        if !world_lines.is_empty() {
            air.push(("world", super::toml_text::list(&world_lines)));
        }
        let airframe = craft.name.clone();
        if airframe.parse::<crate::sim::Airframe>().as_ref() != Ok(craft) {
            return Err(format!("the airframe {airframe} is from a file: name it in a scenario of your own"));
        }
        let position = LatLon::from_degrees(frame.lat_deg, frame.lon_deg);
        let mut draft = Self {
            name: name.to_owned(),
            description: "Made from a flight on the screen".to_owned(),
            plan: past.plan.clone(),
            home: Some(HomePosition { position, amsl_m: Some(frame.alt_amsl_m) }),
            heading_deg: (truth.heading_deg() * 10.0).round() / 10.0,
            airframe: Some(airframe),
            pilot: false,
            settings,
            lines,
            air,
            seed: start.clock().seed(),
            ..Self::default()
        };
        // Faults that were already active at the start stay active.
        for (fault, left_s) in start.clock().active_faults() {
            let fault = WorldCommand::FaultOn(fault, left_s).to_string();
            draft.inputs.push((after_boot(SimTime::ZERO), fault));
        }
        for fault in start.clock().waiting_faults() {
            draft.inputs.push((after_boot(SimTime::ZERO), WorldCommand::Schedule(*fault).to_string()));
        }
        let mut hands = Hands::of(start.transmitter());
        if let Some(pilot) = start.transmitter().pilot() {
            draft.pilot = true;
            draft.takeoff_m = pilot.takeoff_m();
        }
        for (number, (at, input)) in inputs.iter().enumerate() {
            let at = after_boot(since(*at, start_at));
            for what in sentences(input, &mut hands)? {
                match what.strip_prefix("cli ").map_or(Effect::Lasts, |line| effect(&mut start, line)) {
                    _ if past.is_in_plan(number, &what) => {}
                    Effect::None => {}
                    Effect::Sets(setting) if past.is_before_arming(number) => draft.set(setting),
                    Effect::Sets(_) | Effect::Lasts => draft.inputs.push((at.clone(), what)),
                }
            }
        }
        draft.ends = Some(since(past.until, start_at));
        Ok(draft)
    }
}

impl Draft {
    /// Adds a setting of the craft in place of an earlier value.
    fn set(&mut self, setting: String) {
        let name = |line: &str| line.split('=').next().map(|name| name.trim().to_ascii_lowercase());
        self.settings.retain(|earlier| name(earlier) != name(&setting));
        self.settings.push(setting);
    }
}

/// The effect of a command line on the configuration of the craft.
enum Effect {
    /// It sets what the craft has already.
    None,
    /// It sets another value: a line of settings.
    Sets(String),
    /// It is another line, or is refused.
    Lasts,
}

/// Runs a line on a craft that only follows the configuration.
fn effect(craft: &mut Vehicle, line: &str) -> Effect {
    let before = craft.embedded().map(|firmware| firmware.configuration().clone());
    let reply = craft.apply(&VehicleCommand::single_line(line));
    let is_done = matches!(&reply, Answer::Now(Reply::Line(reply)) if !reply.failed);
    match setting_line(line).filter(|_| is_done && line.starts_with("set ")) {
        Some(_) if craft.embedded().map(Firmware::configuration) == before.as_ref() => Effect::None,
        Some(setting) => Effect::Sets(setting),
        None => Effect::Lasts,
    }
}

/// Converts a time of the flight, which begins at `start_at`, to a time since boot.
fn since(at: SimTime, start_at: SimTime) -> SimTime {
    SimTime(at.0.saturating_sub(start_at.0))
}

/// Returns the settings and the other lines of the craft, as the command line reports them.
fn configuration(vehicle: &mut Vehicle) -> Result<(Vec<String>, Vec<String>), String> {
    let Answer::Now(Reply::Line(reply)) = vehicle.apply(&VehicleCommand::single_line("diff all")) else {
        return Err("the flight controller runs elsewhere: its flight cannot be repeated".to_owned());
    };
    let (mut settings, mut lines) = (Vec::new(), Vec::new());
    for line in reply.text.lines().map(str::trim) {
        let first = line.split_whitespace().next().unwrap_or("#");
        if PASSED_OVER.iter().any(|word| first == *word || *word == "#" && first.starts_with('#')) {
            continue;
        }
        match setting_line(line).filter(|_| first == "set") {
            Some(setting) => settings.push(setting),
            None => lines.push(line.to_owned()),
        }
    }
    Ok((settings, lines))
}

/// Returns the sentences of a scenario for an input.
fn sentences(input: &VehicleCommand, hands: &mut Hands) -> Result<Vec<String>, String> {
    let one = |text: &str| Ok(vec![text.to_owned()]);
    match input {
        VehicleCommand::Rc(..) => {
            Err("RC came from another program: a scenario cannot repeat what it sent".to_owned())
        }
        VehicleCommand::Message(_) => {
            Err("a client changed the craft over MSP: a scenario cannot repeat that".to_owned())
        }
        VehicleCommand::SticksFirst(_)
        | VehicleCommand::BeginCli(..)
        | VehicleCommand::EndCli(_)
        | VehicleCommand::EndAllCli
        | VehicleCommand::CliOpened
        | VehicleCommand::CliClosed => Ok(Vec::new()),
        VehicleCommand::Upload(upload) => {
            let lines = upload_lines(upload.plan.records(), &upload.settings);
            Ok(lines.map(|line| format!("cli {line}")).collect())
        }
        VehicleCommand::Line(line) => {
            let text = line.line.trim();
            let reads = text.is_empty()
                || READING.iter().any(|word| {
                    text == *word
                        || text.starts_with(&format!("{word} "))
                        || *word == "#" && text.starts_with('#')
                });
            Ok(if reads { Vec::new() } else { vec![format!("cli {text}")] })
        }
        VehicleCommand::Restart(_) | VehicleCommand::ResetCraft => {
            Err("the flight was restarted within itself".to_owned())
        }
        VehicleCommand::ReturnHome => one("return home"),
        VehicleCommand::CancelReturn => one("cancel return"),
        VehicleCommand::InFlight(InFlightCommand::GoTo(wp)) => Ok(vec![format!("go to {wp}")]),
        VehicleCommand::InFlight(InFlightCommand::HoldHere) => one("hold here"),
        VehicleCommand::InFlight(InFlightCommand::Resume) => one("go on"),
        VehicleCommand::World(command) => Ok(vec![command.to_string()]),
        VehicleCommand::Sticks(frame) => {
            // The stick positions of the scripted pilot follow from the flight.
            let moved = hands.sticks.replace(*frame) != Some(*frame);
            let values: Vec<String> = frame.channels.iter().map(ToString::to_string).collect();
            Ok(moved.then(|| format!("sticks {}", values.join(" "))).into_iter().collect())
        }
        VehicleCommand::CutRc(cut) => {
            let changed = std::mem::replace(&mut hands.cut, *cut) != *cut;
            let what = if *cut { "rc cut" } else { "rc restore" };
            Ok(changed.then(|| what.to_owned()).into_iter().collect())
        }
        VehicleCommand::StartPilot(takeoff_m) => {
            hands.sticks = None;
            Ok(vec![format!("pilot {takeoff_m}")])
        }
        VehicleCommand::StopPilot => one("pilot off"),
        VehicleCommand::HoldChannel(input) => {
            let for_s = input.for_s.map_or_else(String::new, |for_s| format!(" for {for_s} s"));
            Ok(vec![format!("stick {} {}{for_s}", channel_name(input.channel), input.value_us)])
        }
        VehicleCommand::ReleaseChannel(channel) => Ok(vec![format!("release {}", channel_name(*channel))]),
    }
}

/// The transmitter as it was last set by hand.
struct Hands {
    /// `None` after the scripted pilot moved the sticks.
    sticks: Option<RcFrame>,
    cut: bool,
}

impl Hands {
    fn of(transmitter: &RcTransmitter) -> Self {
        let sticks = transmitter.pilot().is_none().then(|| transmitter.sticks());
        Self { sticks, cut: transmitter.is_cut() }
    }
}
