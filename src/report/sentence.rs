//! The same events as sentences for people: `fly` without `--json`, `serve`, the log.

use crate::events::{EndpointAddresses, Event, SessionEvent};
use crate::link::endpoint::EndpointKind;
use crate::plan::{FlightPlan, WaypointType};
use crate::telemetry::{
    AbortReason, BatteryAlarm, CannotHold, DisarmReason, EventKind, FaultValue, FenceAction, FirmwareEvent,
    Guard, GuardUnit, HoldLimit, NavEvent, NavState, PlanSource, Refusal, TransitionReason,
};

/// Returns `  12.4 s  Armed.`; `None` for the few events that only matter inside the craft.
pub fn line(event: &Event) -> Option<String> {
    text(&event.kind).map(|text| format!("{:>7.1} s  {text}", event.time.as_secs_f64()))
}

/// Returns the sentence without the time.
pub fn text(kind: &SessionEvent) -> Option<String> {
    match kind {
        SessionEvent::Vehicle(event) => vehicle(event),
        SessionEvent::Endpoints(addresses) => Some(endpoints(addresses)),
        SessionEvent::Notice(notice)
        | SessionEvent::Warning(notice)
        | SessionEvent::ArmingBlocked(notice) => Some(sentence_end(notice)),
        SessionEvent::Remote(notice) => Some(notice.to_string()),
        SessionEvent::Replay(notice) => Some(sentence_end(&notice.to_string())),
        SessionEvent::Simulator(remark) => Some(sentence_end(&remark.to_string())),
        SessionEvent::Branch { left, .. } => Some(format!(
            "Flying on from here: the flight that had reached {:.1} s is left; everything saved is kept.",
            left.as_secs_f64()
        )),
        SessionEvent::FirstState { .. } | SessionEvent::FirstRc { .. } | SessionEvent::Restarted => None,
    }
}

fn vehicle(kind: &EventKind) -> Option<String> {
    Some(match kind {
        EventKind::Boot { seed, rate_hz, airframe, live } => {
            let live = if *live { ", open to external influence" } else { "" };
            format!("Booted: airframe {airframe}, {rate_hz} steps per second, seed {seed}{live}.")
        }
        EventKind::Firmware(event) => return firmware(event),
        EventKind::Fault { kind, on, value } => {
            let value = if *value == FaultValue::None { String::new() } else { format!(" {value}") };
            format!("Fault {kind}{value} {}.", if *on { "begins" } else { "ends" })
        }
        EventKind::Contact { impact_mps } => format!("Ground contact at {impact_mps:.2} m/s."),
        EventKind::Touchdown { impact_mps, peak_mps2 } => {
            format!("Touchdown: came down at {impact_mps:.2} m/s, peak {peak_mps2:.1} m/s².")
        }
        EventKind::Crash { cause } => format!("Crashed: {cause}."),
        EventKind::BatteryEmpty { cell_v } => battery(BatteryAlarm::Empty, *cell_v),
        EventKind::Notice(notice) => notice.to_string(),
    })
}

fn battery(state: BatteryAlarm, cell_v: f64) -> String {
    match state {
        BatteryAlarm::Warning => format!("Battery low, {cell_v:.2} V per cell: land soon."),
        BatteryAlarm::Critical => format!("Battery critical, {cell_v:.2} V per cell: land now."),
        BatteryAlarm::Empty => format!("Battery empty, {cell_v:.2} V per cell: all of its charge is used."),
    }
}

fn endpoints(addresses: &EndpointAddresses) -> String {
    let EndpointAddresses { ws, tcp, fdm, rc } = addresses;
    let all = [
        (EndpointKind::WebSocket, ws),
        (EndpointKind::Tcp, tcp),
        (EndpointKind::Fdm, fdm),
        (EndpointKind::Rc, rc),
    ];
    let open = all.iter().filter_map(|(kind, address)| address.map(|address| format!("{kind} {address}")));
    let open: Vec<_> = open.collect();
    if open.is_empty() { "No door is open.".to_owned() } else { format!("Doors open: {}.", open.join(", ")) }
}

fn firmware(event: &FirmwareEvent) -> Option<String> {
    Some(match event {
        FirmwareEvent::GpsFix { sats } => format!("GPS fix with {sats} satellites."),
        FirmwareEvent::GpsLost { sats } => format!("GPS fix lost, {sats} satellites."),
        FirmwareEvent::Armed => "Armed.".to_owned(),
        FirmwareEvent::Disarmed(reason) => format!("Disarmed: {}.", disarm(*reason)),
        FirmwareEvent::Mode(modes) => {
            let names: Vec<_> = modes.iter().map(|mode| mode.to_string()).collect();
            if names.is_empty() { "Modes: none.".to_owned() } else { format!("Modes: {}.", names.join(", ")) }
        }
        FirmwareEvent::RxLoss => "RC link lost.".to_owned(),
        FirmwareEvent::RxRecovered => "RC link is back.".to_owned(),
        FirmwareEvent::Failsafe { policy, stage, procedure } => {
            format!("Failsafe stage {stage}: procedure {procedure}, policy {policy}.")
        }
        FirmwareEvent::Nav(event) => return nav(event),
        FirmwareEvent::HeadingDoubt { on: true, error_deg } => {
            format!("The compass is {:.0}° off the GPS course: the course is used instead.", error_deg.abs())
        }
        FirmwareEvent::HeadingDoubt { on: false, .. } => "The compass agrees with the GPS course.".to_owned(),
        FirmwareEvent::TiltDoubt { on: true, error_deg } => {
            format!(
                "Gyro and accelerometer disagree with the speed of the GPS: the estimated tilt is off by {error_deg:.0}° \
                 (a step of the gyro, or a late GPS)."
            )
        }
        FirmwareEvent::TiltDoubt { on: false, .. } => "Gyro, accelerometer and GPS agree again.".to_owned(),
        FirmwareEvent::Battery { state, cell_v } => battery(*state, *cell_v),
        FirmwareEvent::Notice(notice) => notice.to_string(),
    })
}

fn nav(event: &NavEvent) -> Option<String> {
    Some(match event {
        NavEvent::Plan { source, plan } => new_plan(*source, plan),
        NavEvent::State { from, to, wp, kind, reason, guard, .. } => {
            let at = waypoint(*to, *wp, *kind);
            let why = cause(*reason, *to);
            let numbers = guard.as_ref().map_or_else(String::new, |guard| format!(" ({})", because(guard)));
            format!("{from} → {to}{at}: {why}{numbers}.")
        }
        NavEvent::Climbing(true) => "Climbing to the minimum altitude first.".to_owned(),
        NavEvent::Climbing(false) => "Climb done.".to_owned(),
        NavEvent::Limited { tilt_rad } => format!(
            "Not enough throttle: tilt limited to {:.0}° to keep the altitude, flying slower.",
            tilt_rad.to_degrees()
        ),
        NavEvent::Geofence { distance_m, limit_m, action } => {
            let what = match action {
                FenceAction::Land => "landing here",
                FenceAction::Rth => "flying home",
            };
            format!("Geofence: {distance_m:.1} m from home, the fence is {limit_m:.0} m: {what}.")
        }
        NavEvent::CannotHold { on: true, deviation } => {
            let binds = match deviation.limit {
                HoldLimit::Tilt => "; the tilt is at its limit",
                HoldLimit::Throttle => "; the throttle is at its limit",
                HoldLimit::Battery => "; the battery is too low",
                HoldLimit::None => "",
            };
            format!("Cannot hold: {}{binds}.", off(deviation))
        }
        NavEvent::CannotHold { on: false, deviation } => format!("Holds again, {}.", off(deviation)),
        NavEvent::Refused(reason) => format!("The autopilot does not engage. {}", reason.sentence()),
        NavEvent::Disarm => return None,
    })
}

/// Returns `23.4 m from the target, 0.2 m above its altitude`.
fn off(deviation: &CannotHold) -> String {
    let CannotHold { distance_m, vertical_m, .. } = deviation;
    let side = if *vertical_m < 0.0 { "below" } else { "above" };
    format!("{distance_m:.1} m from the target, {:.1} m {side} its altitude", vertical_m.abs())
}

/// Returns the cause of a transition in plain language.
pub(super) fn cause(reason: TransitionReason, to: NavState) -> &'static str {
    match reason {
        TransitionReason::Reset => "the mission starts",
        TransitionReason::Resume => "the mission goes on",
        TransitionReason::SetCurrent => "sent there",
        TransitionReason::HoldHere => "commanded to hold here",
        TransitionReason::Arrival => "reached",
        TransitionReason::HeldOffAltitude => "reached, but the craft gets no closer to its altitude",
        TransitionReason::Plane => "passed",
        TransitionReason::TurnRadius => "the turn begins",
        TransitionReason::Advance if to == NavState::Complete => "the mission is done",
        TransitionReason::Advance => "on to the next",
        TransitionReason::Hold => "holding there",
        TransitionReason::Loiter => "waiting there",
        TransitionReason::Pattern => "the pattern begins",
        TransitionReason::HoldTime => "the time is up",
        TransitionReason::Land => "the descent begins",
        TransitionReason::Touchdown => "landed",
        TransitionReason::Fence => "outside the fence",
        TransitionReason::Emergency => "emergency landing",
        TransitionReason::Disengage => "switched off",
        TransitionReason::GivenUp(AbortReason::GpsLost) => "the GPS fix is lost",
        TransitionReason::GivenUp(AbortReason::NoPlan) | TransitionReason::Refused(Refusal::NoPlan) => {
            "the plan was cleared"
        }
        TransitionReason::GivenUp(AbortReason::Stalled) => "no progress",
        TransitionReason::GivenUp(AbortReason::Flyaway) => "moving away from the waypoint",
        TransitionReason::GivenUp(AbortReason::MagFault) => "the course does not fit the heading",
        TransitionReason::ReturnHome
        | TransitionReason::Disarm
        | TransitionReason::Climb
        | TransitionReason::Missed
        | TransitionReason::Refused(_) => reason.word(),
    }
}

fn waypoint(to: NavState, wp: u8, kind: Option<WaypointType>) -> String {
    match kind {
        Some(kind) if to != NavState::Idle => format!(" (waypoint {wp}, {kind})"),
        _ => String::new(),
    }
}

/// Returns `arrival 4.9 m ≤ 5.0 m`; a count has no unit: `fix 0 < 1`.
pub(super) fn because(guard: &Guard) -> String {
    let Guard { name, value, limit, op } = guard;
    match guard.unit() {
        GuardUnit::None => format!("{name} {value} {op} {limit}"),
        unit => format!("{name} {value:.1} {unit} {op} {limit:.1} {unit}"),
    }
}

fn new_plan(source: PlanSource, plan: &FlightPlan) -> String {
    let count = plan.waypoints.len();
    let waypoints = if count == 1 { "waypoint" } else { "waypoints" };
    match source {
        PlanSource::Stored => format!("Flying the stored plan, {count} {waypoints}."),
        PlanSource::Rth => format!("Return to home: {count} {waypoints}."),
        PlanSource::Emergency => "Emergency landing at this place.".to_owned(),
    }
}

fn disarm(reason: DisarmReason) -> &'static str {
    match reason {
        DisarmReason::ArmingDisabled => "arming was disabled",
        DisarmReason::Failsafe => "failsafe",
        DisarmReason::ThrottleTimeout => "throttle low for too long",
        DisarmReason::Sticks => "stick command",
        DisarmReason::Switch => "ARM switch off",
        DisarmReason::CrashProtection => "crash protection",
        DisarmReason::RunawayTakeoff => "runaway take-off",
        DisarmReason::GpsRescue => "GPS rescue",
        DisarmReason::SerialCommand => "serial command",
        DisarmReason::Landing => "landed",
        DisarmReason::Crashflip => "crash flip",
        DisarmReason::Unknown => "the firmware gives no reason",
        DisarmReason::System => "restart",
    }
}

pub(super) fn sentence_end(text: &str) -> String {
    if text.ends_with(['.', '!', '?']) { text.to_owned() } else { format!("{text}.") }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geo::LatLon;
    use crate::signals::SimTime;
    use crate::telemetry::{FaultKind, FirmwareNotice, GuardName, GuardOp};

    fn say(event: FirmwareEvent) -> String {
        vehicle(&EventKind::Firmware(event)).expect("a sentence")
    }

    #[test]
    fn lines_start_with_the_time() {
        let armed = EventKind::Firmware(FirmwareEvent::Armed);
        let event = Event { time: SimTime(12_400_000), kind: SessionEvent::Vehicle(armed) };
        assert_eq!(line(&event).as_deref(), Some("   12.4 s  Armed."));
    }

    #[test]
    fn a_transition_says_where_and_why() {
        let state = |to, guard, reason| {
            say(FirmwareEvent::Nav(NavEvent::State {
                from: NavState::Approaching,
                to,
                wp: 2,
                kind: Some(WaypointType::Hold),
                reason,
                guard,
                target: LatLon::default(),
                target_alt_m: 50.0,
            }))
        };
        let guard = Guard { name: GuardName::Arrival, value: 1.93, limit: 2.0, op: GuardOp::AtMost };
        assert_eq!(
            state(NavState::Arrived, Some(guard), TransitionReason::Arrival),
            "APPROACHING → ARRIVED (waypoint 2, HOLD): reached (arrival 1.9 m ≤ 2.0 m)."
        );
        let fix = Guard { name: GuardName::Fix, value: 0.0, limit: 1.0, op: GuardOp::Below };
        assert_eq!(
            state(NavState::Idle, Some(fix), TransitionReason::GivenUp(AbortReason::GpsLost)),
            "APPROACHING → IDLE: the GPS fix is lost (fix 0 < 1)."
        );
        assert_eq!(
            state(NavState::Idle, None, TransitionReason::GivenUp(AbortReason::GpsLost)),
            "APPROACHING → IDLE: the GPS fix is lost."
        );
    }

    #[test]
    fn a_craft_that_cannot_hold_says_how_far_off_it_is_and_why() {
        let say = |on, vertical_m, limit| {
            let deviation = CannotHold { distance_m: 23.42, vertical_m, limit };
            say(FirmwareEvent::Nav(NavEvent::CannotHold { on, deviation }))
        };
        assert_eq!(
            say(true, -0.2, HoldLimit::Tilt),
            "Cannot hold: 23.4 m from the target, 0.2 m below its altitude; the tilt is at its limit."
        );
        assert_eq!(
            say(false, 0.1, HoldLimit::None),
            "Holds again, 23.4 m from the target, 0.1 m above its altitude."
        );
    }

    #[test]
    fn refusals_carry_the_numbers() {
        let refused = Refusal::Geofence { wp: 3, distance_cm: 15_043, limit_m: 100 };
        assert_eq!(
            say(FirmwareEvent::Nav(NavEvent::Refused(refused))),
            "The autopilot does not engage. Waypoint 3 is 150 m from home, the fence is 100 m."
        );
    }

    #[test]
    fn open_doors_are_listed() {
        let addresses = EndpointAddresses {
            tcp: "127.0.0.1:5761".parse().ok(),
            rc: "127.0.0.1:9004".parse().ok(),
            ..EndpointAddresses::default()
        };
        assert_eq!(endpoints(&addresses), "Doors open: tcp 127.0.0.1:5761, udp rc 127.0.0.1:9004.");
        assert_eq!(endpoints(&EndpointAddresses::default()), "No door is open.");
    }

    #[test]
    fn every_sentence_ends_as_one() {
        for event in [
            FirmwareEvent::GpsFix { sats: 12 },
            FirmwareEvent::Disarmed(DisarmReason::Landing),
            FirmwareEvent::Battery { state: BatteryAlarm::Warning, cell_v: 3.49 },
            FirmwareEvent::Notice(FirmwareNotice::ArmAssisted),
            FirmwareEvent::Mode(crate::telemetry::ModeFlags::NONE),
            FirmwareEvent::Nav(NavEvent::Geofence {
                distance_m: 100.4,
                limit_m: 100.0,
                action: FenceAction::Rth,
            }),
        ] {
            let sentence = say(event);
            assert!(sentence.ends_with(['.', '?']), "{sentence}");
        }
        for (notice, sentence) in [("No full stop", "No full stop."), ("A question?", "A question?")] {
            assert_eq!(text(&SessionEvent::Notice(notice.to_owned())).as_deref(), Some(sentence));
        }
        let fault = EventKind::Fault { kind: FaultKind::GpsLoss, on: true, value: FaultValue::None };
        assert_eq!(vehicle(&fault).as_deref(), Some("Fault gps-loss begins."));
    }
}
