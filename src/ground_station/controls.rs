//! Makes commands to the session from the requests of ground stations, by the virtual transmitter.

use std::time::Duration;

use super::state::is_on_ground;
use crate::mavlink::craft::FlightMode;
use crate::mavlink::value::CommandResult;
use crate::session::policy::{self, Facts, Intent};
use crate::session::{Command, SessionView};
use crate::signals::{RcFrame, RcSource};
use crate::telemetry::switch::{self, Switch};
use crate::telemetry::{ArmingFlag, ArmingFlags, FirmwareProfile, InFlightCommand, Mode};
use crate::vehicle::VehicleCommand;

/// The channel of the throttle, its low position, and that of a climb, µs.
const THROTTLE: usize = 2;
const LOW_US: u16 = 1000;
const CLIMB_US: u16 = 1800;
/// The modes that hold a craft level and in place.
const HOLDS: [Mode; 3] = [Mode::Angle, Mode::AltHold, Mode::PosHold];
/// The climb ends this far below its altitude, m.
const NEAR_M: f64 = 0.3;
/// The time on the ground after which a landing has ended.
const LANDED: Duration = Duration::from_millis(1500);
/// The longest time between the request to arm and the move of the switch.
const ARM_WITHIN: Duration = Duration::from_secs(3);
/// The time for which sticks count that the session has not shown yet.
const CONFIRM: Duration = Duration::from_millis(500);

/// The outcome for which a request waits.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Until {
    Now,
    Armed,
    Disarmed,
    Engaged,
}

/// A refusal: the result on the link and the sentence.
pub(super) type Refused = (CommandResult, String);

/// A flight by sticks that goes on after its request.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Procedure {
    /// Moves the ARM switch when nothing blocks it. The time of the request.
    Arm(Duration),
    /// Up to an altitude above home, m.
    Climb(f64),
    /// Down to the ground, and disarmed there. The time since the touchdown.
    Sink(Option<Duration>),
}

/// The virtual transmitter, as ground stations move it.
#[derive(Debug, Default)]
pub(super) struct Controls {
    procedure: Option<Procedure>,
    sent: Option<(RcFrame, Duration)>,
}

fn not_now(sentence: impl Into<String>) -> Refused {
    (CommandResult::TemporarilyRejected, sentence.into())
}

impl Controls {
    /// Arms the craft by its switch.
    pub(super) fn arm(
        &mut self,
        view: &SessionView,
        now: Duration,
    ) -> Result<(Vec<Command>, Until), Refused> {
        let craft = &view.vehicle.craft;
        if craft.is_armed() {
            return Ok((Vec::new(), Until::Now));
        }
        let causes = by_sticks(view).into_iter().fold(craft.arming_flags().causes(), ArmingFlags::without);
        if !causes.is_empty() {
            return Err(not_now(format!("Cannot arm: {causes}.")));
        }
        let mut frame = self.frame(view, now);
        frame.channels[THROTTLE] = LOW_US;
        set(view, &mut frame, Mode::Arm, false)?;
        for mode in HOLDS.into_iter().chain([Mode::Autopilot]) {
            set(view, &mut frame, mode, false).ok();
        }
        // The switch follows once the craft sees sticks that let it arm.
        self.procedure = Some(Procedure::Arm(now));
        Ok((self.send(view, frame, now), Until::Armed))
    }

    /// Disarms a craft on the ground.
    pub(super) fn disarm(
        &mut self,
        view: &SessionView,
        now: Duration,
    ) -> Result<(Vec<Command>, Until), Refused> {
        if !view.vehicle.craft.is_armed() {
            return Ok((Vec::new(), Until::Now));
        }
        if !is_on_ground(&view.vehicle) {
            let why = "The craft is in the air and would fall: land first.";
            return Err((CommandResult::Denied, why.to_owned()));
        }
        Ok((self.disarmed(view, now)?, Until::Disarmed))
    }

    fn disarmed(&mut self, view: &SessionView, now: Duration) -> Result<Vec<Command>, Refused> {
        self.procedure = None;
        let mut frame = self.frame(view, now);
        frame.channels[THROTTLE] = LOW_US;
        set(view, &mut frame, Mode::Arm, false)?;
        for mode in HOLDS.into_iter().chain([Mode::Autopilot]) {
            set(view, &mut frame, mode, false).ok();
        }
        Ok(self.send(view, frame, now))
    }

    /// Begins a climb to this altitude above home, m.
    pub(super) fn take_off(
        &mut self,
        view: &SessionView,
        altitude_m: f64,
        now: Duration,
    ) -> Result<Vec<Command>, Refused> {
        if !view.vehicle.craft.is_armed() {
            return Err(not_now("The craft is disarmed: arm first."));
        }
        if !is_on_ground(&view.vehicle) {
            return Err(not_now("The craft is in the air."));
        }
        let mut frame = self.frame(view, now);
        hold(view, &mut frame);
        frame.channels[THROTTLE] = CLIMB_US;
        self.procedure = Some(Procedure::Climb(altitude_m));
        Ok(self.send(view, frame, now))
    }

    /// Begins to sink here. The craft is disarmed on the ground.
    pub(super) fn land(&mut self, view: &SessionView, now: Duration) -> Result<Vec<Command>, Refused> {
        if !view.vehicle.craft.is_armed() {
            return Err(not_now("The craft is disarmed."));
        }
        let settings = view.vehicle.settings.unwrap_or_default();
        let sink_us =
            settings.sink_stick_us.ok_or_else(|| not_now("No stick lets this craft sink in ALTHOLD."))?;
        let mut frame = self.frame(view, now);
        hold(view, &mut frame);
        frame.channels[THROTTLE] = sink_us;
        self.procedure = Some(Procedure::Sink(None));
        Ok(self.send(view, frame, now))
    }

    /// Flies home and lands there.
    pub(super) fn return_home(&mut self, view: &SessionView, now: Duration) -> Result<Vec<Command>, Refused> {
        if !view.vehicle.craft.is_armed() {
            return Err(not_now("The craft is disarmed."));
        }
        self.procedure = None;
        let mut frame = self.frame(view, now);
        let had = frame;
        hold_in_reserve(view, &mut frame);
        let mut commands = if frame == had { Vec::new() } else { self.send(view, frame, now) };
        commands.push(Command::Vehicle(VehicleCommand::ReturnHome));
        Ok(commands)
    }

    /// Flies the mission: in the air at once, from the ground by the scripted pilot.
    pub(super) fn start_mission(
        &mut self,
        view: &SessionView,
        now: Duration,
    ) -> Result<(Vec<Command>, Until), Refused> {
        let vehicle = &*view.vehicle;
        if vehicle.stored_plan.as_ref().is_none_or(|plan| plan.waypoints.is_empty()) {
            return Err(not_now("The craft has no mission: upload one."));
        }
        if !vehicle.craft.is_armed() {
            return Err(not_now("The craft is disarmed: arm first."));
        }
        self.procedure = None;
        if is_on_ground(vehicle) {
            return Ok((vec![Command::StartPilot], Until::Now));
        }
        let mut frame = self.frame(view, now);
        hold_in_reserve(view, &mut frame);
        set(view, &mut frame, Mode::Autopilot, true)?;
        Ok((self.send(view, frame, now), Until::Engaged))
    }

    /// Interrupts the mission and holds the position.
    pub(super) fn pause(&mut self, view: &SessionView, now: Duration) -> Result<Vec<Command>, Refused> {
        match view.vehicle.is_engaged() && takes_orders(view) {
            true => Ok(vec![Command::Vehicle(VehicleCommand::InFlight(InFlightCommand::HoldHere))]),
            false => self.set_mode(view, FlightMode::PosHold, now).map(|(commands, _)| commands),
        }
    }

    /// Continues the mission.
    pub(super) fn resume(
        &mut self,
        view: &SessionView,
        now: Duration,
    ) -> Result<(Vec<Command>, Until), Refused> {
        match view.vehicle.nav.as_ref().is_some_and(|nav| nav.engaged && nav.held_by_command) {
            true => {
                Ok((vec![Command::Vehicle(VehicleCommand::InFlight(InFlightCommand::Resume))], Until::Now))
            }
            false => self.start_mission(view, now),
        }
    }

    /// Flies to this waypoint.
    pub(super) fn go_to(&self, view: &SessionView, waypoint: u8) -> Result<Vec<Command>, Refused> {
        if !view.vehicle.is_engaged() {
            return Err(not_now("The autopilot does not fly, so no waypoint can be set."));
        }
        Ok(vec![Command::Vehicle(VehicleCommand::InFlight(InFlightCommand::GoTo(waypoint)))])
    }

    /// Moves the switches so that this mode flies.
    pub(super) fn set_mode(
        &mut self,
        view: &SessionView,
        mode: FlightMode,
        now: Duration,
    ) -> Result<(Vec<Command>, Until), Refused> {
        let wanted: &[Mode] = match mode {
            FlightMode::Autopilot => return self.start_mission(view, now),
            FlightMode::ReturnHome => return Ok((self.return_home(view, now)?, Until::Now)),
            FlightMode::Landing => return Ok((self.land(view, now)?, Until::Now)),
            FlightMode::TakeOff | FlightMode::Failsafe => {
                return Err((
                    CommandResult::Unsupported,
                    "No switch selects a take-off or a failsafe.".to_owned(),
                ));
            }
            FlightMode::Acro => &[],
            FlightMode::Horizon => &[Mode::Horizon],
            FlightMode::Angle => &[Mode::Angle],
            FlightMode::AltHold => &[Mode::Angle, Mode::AltHold],
            FlightMode::PosHold => &HOLDS,
        };
        self.procedure = None;
        let mut frame = self.frame(view, now);
        if wanted.contains(&Mode::AltHold) {
            rest_throttle(view, &mut frame);
        }
        for mode in HOLDS.into_iter().chain([Mode::Horizon, Mode::Autopilot]) {
            match wanted.contains(&mode) {
                true => set(view, &mut frame, mode, true)?,
                // A mode without a switch is off.
                false => _ = set(view, &mut frame, mode, false).ok(),
            }
        }
        // Modes may share a range of a channel.
        let ranges = view.vehicle.craft.mode_ranges();
        let is_wrong = |mode: &Mode| switch::is_on(*mode, ranges, &frame.channels) != wanted.contains(mode);
        if let Some(wrong) = HOLDS.into_iter().chain([Mode::Horizon]).find(is_wrong) {
            let why = match wanted.contains(&wrong) {
                true => format!("No position of the switches selects {wrong} alone."),
                false => format!("No position of the switches selects {mode:?} without {wrong}."),
            };
            return Err((CommandResult::Failed, why));
        }
        Ok((self.send(view, frame, now), Until::Now))
    }

    /// Continues a climb or a landing. Returns the commands that are due.
    pub(super) fn advance(&mut self, view: &SessionView, now: Duration) -> Vec<Command> {
        let vehicle = &*view.vehicle;
        let Some(procedure) = self.procedure else { return Vec::new() };
        if let Procedure::Arm(since) = procedure {
            return self.move_arm_switch(view, since, now);
        }
        if !vehicle.craft.is_armed() || vehicle.is_engaged() {
            self.procedure = None;
            return Vec::new();
        }
        match procedure {
            Procedure::Arm(_) => Vec::new(),
            Procedure::Climb(altitude_m) => {
                if vehicle.estimate.alt.is_none_or(|alt| alt < altitude_m - NEAR_M) {
                    return Vec::new();
                }
                self.procedure = None;
                let mut frame = self.frame(view, now);
                rest_throttle(view, &mut frame);
                self.send(view, frame, now)
            }
            Procedure::Sink(since) => {
                let since = is_on_ground(vehicle).then(|| since.unwrap_or(now));
                self.procedure = Some(Procedure::Sink(since));
                if since.is_some_and(|since| now.saturating_sub(since) > LANDED) {
                    return self.disarmed(view, now).unwrap_or_default();
                }
                Vec::new()
            }
        }
    }

    /// Moves the ARM switch, if nothing blocks it any more.
    fn move_arm_switch(&mut self, view: &SessionView, since: Duration, now: Duration) -> Vec<Command> {
        let craft = &view.vehicle.craft;
        if now.saturating_sub(since) > ARM_WITHIN || craft.is_armed() {
            self.procedure = None;
            return Vec::new();
        }
        if !craft.arming_flags().causes().is_empty() || (view.rc_cut && !has_own_rc(view)) {
            return Vec::new();
        }
        self.procedure = None;
        let mut frame = self.frame(view, now);
        match set(view, &mut frame, Mode::Arm, true) {
            Ok(()) => self.send(view, frame, now),
            Err(_) => Vec::new(),
        }
    }

    /// Returns the frame to change: the one that was sent last, until the session shows it.
    fn frame(&self, view: &SessionView, now: Duration) -> RcFrame {
        match self.sent {
            Some((frame, at)) if now.saturating_sub(at) < CONFIRM => frame,
            _ => view.sticks,
        }
    }

    fn send(&mut self, view: &SessionView, frame: RcFrame, now: Duration) -> Vec<Command> {
        self.sent = Some((frame, now));
        let mut commands = Vec::new();
        // Without a screen nobody has the sticks until a ground station arms.
        if view.rc_cut && !view.vehicle.craft.is_armed() && !has_own_rc(view) {
            commands.push(Command::Vehicle(VehicleCommand::CutRc(false)));
        }
        commands.push(Command::Vehicle(VehicleCommand::Sticks(frame)));
        commands
    }
}

/// Returns `true` while a program sends RC, whose loss is to be a loss of RC. The switches of the virtual transmitter are
/// part of the frames of a ground station.
fn has_own_rc(view: &SessionView) -> bool {
    let craft = &view.vehicle.craft;
    craft.rc_source == Some(RcSource::Udp) && craft.rc_link == Some(true)
}

/// Returns the arming disable flags that the sticks of a ground station clear.
fn by_sticks(view: &SessionView) -> Vec<ArmingFlag> {
    let mut flags = vec![
        ArmingFlag::Throttle,
        ArmingFlag::AltHoldSwitch,
        ArmingFlag::PosHoldSwitch,
        ArmingFlag::AutopilotSwitch,
    ];
    if view.rc_cut {
        flags.push(ArmingFlag::RxLoss);
    }
    flags
}

/// Checks that the session takes these commands now.
pub(super) fn check(view: &SessionView, commands: &[Command]) -> Result<(), Refused> {
    let facts = Facts::from(view);
    for command in commands {
        policy::check(&facts, Intent::of(command)).map_err(|refusal| not_now(refusal.to_string()))?;
    }
    Ok(())
}

/// Returns `true` if the navigator takes orders in flight beyond another waypoint.
fn takes_orders(view: &SessionView) -> bool {
    let profile = view.vehicle.settings.unwrap_or_default().profile;
    view.remote.is_none() && profile == FirmwareProfile::Guide
}

/// Moves the switch of a mode.
fn set(view: &SessionView, frame: &mut RcFrame, mode: Mode, on: bool) -> Result<(), Refused> {
    let ranges = view.vehicle.craft.mode_ranges();
    let switch = Switch::of(mode, ranges)
        .ok_or_else(|| (CommandResult::Failed, format!("No switch is assigned to {mode}.")))?;
    if let Some(channel) = frame.channels.get_mut(switch.channel) {
        *channel = if on { switch.on_us } else { switch.off_us };
    }
    Ok(())
}

/// Lets the hold modes fly: AUTOPILOT off.
fn hold(view: &SessionView, frame: &mut RcFrame) {
    for mode in HOLDS {
        set(view, frame, mode, true).ok();
    }
    set(view, frame, Mode::Autopilot, false).ok();
}

/// Prepares the hold modes for the moment when the navigator releases the craft.
fn hold_in_reserve(view: &SessionView, frame: &mut RcFrame) {
    for mode in HOLDS {
        set(view, frame, mode, true).ok();
    }
    rest_throttle(view, frame);
}

/// Moves the throttle stick to where ALTHOLD keeps the altitude.
fn rest_throttle(view: &SessionView, frame: &mut RcFrame) {
    let settings = view.vehicle.settings.unwrap_or_default();
    let rest_us = settings.hover_stick_us.max(settings.raised_stick_us);
    if rest_us > LOW_US && !is_on_ground(&view.vehicle) {
        frame.channels[THROTTLE] = rest_us;
    }
}
