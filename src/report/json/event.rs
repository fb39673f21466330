//! The fields of each event.

use std::borrow::Cow;
use std::net::SocketAddr;

use serde::Serialize;

use super::super::number::{Decimals, Milli};
use crate::events::{EndpointAddresses, SessionEvent};
use crate::plan::{FlightPlan, WaypointType};
use crate::telemetry::{
    BatteryAlarm, EventKind, FaultValue, FirmwareEvent, Guard, NavEvent, PlanSource, Refusal,
};

/// A number of degrees with the resolution of plans, 1e-7.
type Degrees = Decimals<7>;

/// The fields after `t` and `event`, in the order of the output.
#[derive(Debug, Serialize)]
#[serde(untagged)]
pub(super) enum Fields<'a> {
    Boot {
        version: &'static str,
        seed: u64,
        rate: u32,
        airframe: &'a str,
        live: bool,
    },
    None {},
    Sats {
        sats: u8,
    },
    Disarmed {
        reason: String,
    },
    Mode {
        active: Vec<String>,
    },
    Plan {
        source: String,
        count: usize,
        waypoints: Vec<PlanWaypoint>,
    },
    Refused {
        reason: String,
        wp: Option<u8>,
        cause: Option<String>,
        text: Cow<'static, str>,
    },
    State(Box<State>),
    On {
        on: bool,
    },
    Limited {
        by: &'static str,
        #[serde(rename = "lean_deg")]
        tilt_deg: Milli,
    },
    Geofence {
        distance_m: Milli,
        limit_m: Milli,
        action: &'a str,
    },
    CannotHold {
        on: bool,
        distance_m: Milli,
        vertical_m: Milli,
        limit: &'a str,
    },
    Failsafe {
        policy: Option<&'a str>,
        stage: u8,
        procedure: Option<&'a str>,
    },
    Fault {
        name: &'static str,
        on: bool,
        value: Option<String>,
    },
    Contact {
        impact_mps: Milli,
    },
    Touchdown {
        impact_mps: Milli,
        peak_mps2: Milli,
    },
    Crash {
        cause: String,
    },
    HeadingDoubt {
        on: bool,
        error_deg: Milli,
    },
    TiltDoubt {
        on: bool,
        error_deg: Milli,
    },
    Battery {
        state: String,
        cell_v: Milli,
    },
    Doors {
        ws: Option<SocketAddr>,
        tcp: Option<SocketAddr>,
        fdm: Option<SocketAddr>,
        rc: Option<SocketAddr>,
    },
    Notice {
        text: Cow<'a, str>,
    },
    Branch {
        number: u32,
        left_at: Decimals<6>,
    },
}

#[derive(Debug, Serialize)]
pub(super) struct State {
    from: String,
    to: String,
    wp: u8,
    r#type: Option<String>,
    reason: &'static str,
    guard: Option<GuardFields>,
    target_lat: Degrees,
    target_lon: Degrees,
    target_alt: Milli,
}

/// The guard that fired.
#[derive(Debug, Serialize)]
struct GuardFields {
    name: &'static str,
    value: Milli,
    limit: Milli,
    unit: &'static str,
    margin: Milli,
    op: String,
}

/// A waypoint of a new plan.
#[derive(Debug, Serialize)]
pub(super) struct PlanWaypoint {
    r#type: String,
    lat: Degrees,
    lon: Degrees,
    alt: Milli,
}

impl<'a> Fields<'a> {
    /// Returns the name and the fields of an event; `None` if it has no line.
    pub(super) fn of(kind: &'a SessionEvent) -> Option<(&'static str, Self)> {
        Some(match kind {
            SessionEvent::Vehicle(event) => return Self::from_vehicle(event),
            SessionEvent::Endpoints(EndpointAddresses { ws, tcp, fdm, rc }) => {
                ("doors", Self::Doors { ws: *ws, tcp: *tcp, fdm: *fdm, rc: *rc })
            }
            SessionEvent::Notice(text) | SessionEvent::Warning(text) | SessionEvent::ArmingBlocked(text) => {
                ("notice", Self::Notice { text: text.into() })
            }
            SessionEvent::Remote(notice) => ("notice", Self::Notice { text: notice.to_string().into() }),
            SessionEvent::Replay(notice) => ("notice", Self::Notice { text: notice.to_string().into() }),
            SessionEvent::Simulator(remark) => ("notice", Self::Notice { text: remark.to_string().into() }),
            SessionEvent::Branch { number, left } => {
                ("branch", Self::Branch { number: *number, left_at: Decimals(left.as_secs_f64()) })
            }
            SessionEvent::FirstState { .. } | SessionEvent::FirstRc { .. } | SessionEvent::Restarted => {
                return None;
            }
        })
    }

    fn from_vehicle(kind: &'a EventKind) -> Option<(&'static str, Self)> {
        Some(match kind {
            EventKind::Boot { seed, rate_hz, airframe, live } => {
                let version = env!("CARGO_PKG_VERSION");
                ("boot", Self::Boot { version, seed: *seed, rate: *rate_hz, airframe, live: *live })
            }
            EventKind::Firmware(event) => return Self::from_firmware(event),
            EventKind::Fault { kind, on, value } => {
                let value = (*value != FaultValue::None).then(|| value.to_string());
                ("fault", Self::Fault { name: kind.into(), on: *on, value })
            }
            EventKind::Contact { impact_mps } => {
                ("contact", Self::Contact { impact_mps: Decimals(*impact_mps) })
            }
            EventKind::Touchdown { impact_mps, peak_mps2 } => {
                let (impact_mps, peak_mps2) = (Decimals(*impact_mps), Decimals(*peak_mps2));
                ("touchdown", Self::Touchdown { impact_mps, peak_mps2 })
            }
            EventKind::Crash { cause } => ("crash", Self::Crash { cause: cause.to_string() }),
            EventKind::BatteryEmpty { cell_v } => Self::from_battery(BatteryAlarm::Empty, *cell_v),
            EventKind::Notice(notice) => ("notice", Self::Notice { text: notice.to_string().into() }),
        })
    }

    fn from_firmware(event: &'a FirmwareEvent) -> Option<(&'static str, Self)> {
        Some(match event {
            FirmwareEvent::GpsFix { sats } => ("gps_fix", Self::Sats { sats: *sats }),
            FirmwareEvent::GpsLost { sats } => ("gps_lost", Self::Sats { sats: *sats }),
            FirmwareEvent::Armed => ("armed", Self::None {}),
            FirmwareEvent::Disarmed(reason) => ("disarmed", Self::Disarmed { reason: reason.to_string() }),
            FirmwareEvent::Mode(modes) => {
                ("mode", Self::Mode { active: modes.iter().map(|mode| mode.to_string()).collect() })
            }
            FirmwareEvent::RxLoss => ("rx_loss", Self::Failsafe { policy: None, stage: 1, procedure: None }),
            FirmwareEvent::RxRecovered => {
                ("rx_recovered", Self::Failsafe { policy: None, stage: 0, procedure: None })
            }
            FirmwareEvent::Failsafe { policy, stage, procedure } => {
                let (policy, procedure) = (Some((*policy).into()), Some((*procedure).into()));
                ("failsafe", Self::Failsafe { policy, stage: *stage, procedure })
            }
            FirmwareEvent::Nav(event) => return Self::from_nav(event),
            FirmwareEvent::HeadingDoubt { on, error_deg } => {
                ("heading_doubt", Self::HeadingDoubt { on: *on, error_deg: Decimals(*error_deg) })
            }
            FirmwareEvent::TiltDoubt { on, error_deg } => {
                ("lean_doubt", Self::TiltDoubt { on: *on, error_deg: Decimals(*error_deg) })
            }
            FirmwareEvent::Battery { state, cell_v } => Self::from_battery(*state, *cell_v),
            FirmwareEvent::Notice(notice) => ("notice", Self::Notice { text: notice.to_string().into() }),
        })
    }

    fn from_battery(state: BatteryAlarm, cell_v: f64) -> (&'static str, Self) {
        ("battery", Self::Battery { state: state.to_string(), cell_v: Decimals(cell_v) })
    }

    fn from_nav(event: &'a NavEvent) -> Option<(&'static str, Self)> {
        Some(match event {
            NavEvent::Plan { source, plan } => ("plan", Self::from_plan(*source, plan)),
            NavEvent::State { from, to, wp, kind, reason, guard, target, target_alt_m } => {
                let state = State {
                    from: from.to_string(),
                    to: to.to_string(),
                    wp: *wp,
                    r#type: kind.map(|kind: WaypointType| kind.to_string()),
                    reason: reason.word(),
                    guard: guard.as_ref().map(GuardFields::of),
                    target_lat: Decimals(target.lat_deg()),
                    target_lon: Decimals(target.lon_deg()),
                    target_alt: Decimals(*target_alt_m),
                };
                ("state", Self::State(Box::new(state)))
            }
            NavEvent::Climbing(on) => ("climbing", Self::On { on: *on }),
            NavEvent::Limited { tilt_rad } => {
                ("limited", Self::Limited { by: "throttle", tilt_deg: Decimals(tilt_rad.to_degrees()) })
            }
            NavEvent::Geofence { distance_m, limit_m, action } => {
                let (distance_m, limit_m) = (Decimals(*distance_m), Decimals(*limit_m));
                ("geofence", Self::Geofence { distance_m, limit_m, action: action.into() })
            }
            NavEvent::CannotHold { on, deviation } => {
                let (distance_m, vertical_m) =
                    (Decimals(deviation.distance_m), Decimals(deviation.vertical_m));
                let limit = deviation.limit.into();
                ("cannot_hold", Self::CannotHold { on: *on, distance_m, vertical_m, limit })
            }
            NavEvent::Refused(refusal) => ("engage_refused", Self::from_refusal(*refusal)),
            // The following disarm is the event.
            NavEvent::Disarm => return None,
        })
    }

    fn from_plan(source: PlanSource, plan: &FlightPlan) -> Self {
        let waypoints = plan.waypoints.iter().map(|waypoint| PlanWaypoint {
            r#type: waypoint.kind.to_string(),
            lat: Decimals(waypoint.position.lat_deg()),
            lon: Decimals(waypoint.position.lon_deg()),
            alt: Decimals(waypoint.altitude.above_home_m()),
        });
        Self::Plan { source: source.to_string(), count: plan.waypoints.len(), waypoints: waypoints.collect() }
    }

    fn from_refusal(refusal: Refusal) -> Self {
        let (wp, cause) = match refusal {
            Refusal::BadWaypoint(wp) | Refusal::Geofence { wp, .. } => (Some(wp), None),
            Refusal::Aborted(cause) => (None, Some(cause.to_string())),
            Refusal::NotArmed
            | Refusal::Throttle
            | Refusal::NoFix
            | Refusal::NoAltitude
            | Refusal::NoHeading
            | Refusal::NoPlan
            | Refusal::PlanCorrupt
            | Refusal::NoHome
            | Refusal::ThrottleMin { .. }
            | Refusal::Failsafe => (None, None),
        };
        Self::Refused { reason: refusal.to_string(), wp, cause, text: refusal.sentence() }
    }
}

impl GuardFields {
    fn of(guard: &Guard) -> Self {
        Self {
            name: guard.name.into(),
            value: Decimals(guard.value),
            limit: Decimals(guard.limit),
            unit: guard.unit().into(),
            margin: Decimals(guard.margin()),
            op: guard.op.to_string(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::event_line;
    use super::*;
    use crate::events::Event;
    use crate::geo::LatLon;
    use crate::plan::{Altitude, Waypoint};
    use crate::signals::SimTime;
    use crate::telemetry::{
        AbortReason, CannotHold, DisarmReason, FailsafeProcedure, FaultKind, GuardName, GuardOp, HoldLimit,
        Mode, ModeFlags, NavState, RxLossPolicy, TransitionReason,
    };

    fn session_line(kind: SessionEvent) -> String {
        event_line(&Event { time: SimTime(12_340_000), kind }).expect("a line")
    }

    fn line(kind: EventKind) -> String {
        session_line(SessionEvent::Vehicle(kind))
    }

    fn firmware(event: FirmwareEvent) -> String {
        line(EventKind::Firmware(event))
    }

    #[test]
    fn events_without_fields_have_time_and_name() {
        assert_eq!(firmware(FirmwareEvent::Armed), r#"{"t":12.34,"event":"armed"}"#);
    }

    #[test]
    fn simple_events() {
        assert_eq!(firmware(FirmwareEvent::GpsFix { sats: 7 }), r#"{"t":12.34,"event":"gps_fix","sats":7}"#);
        assert_eq!(
            firmware(FirmwareEvent::Disarmed(DisarmReason::Landing)),
            r#"{"t":12.34,"event":"disarmed","reason":"LANDING"}"#
        );
        let mut modes = ModeFlags::NONE;
        modes.set(Mode::PosHold, true);
        modes.set(Mode::Arm, true);
        assert_eq!(
            firmware(FirmwareEvent::Mode(modes)),
            r#"{"t":12.34,"event":"mode","active":["ARM","POS HOLD"]}"#
        );
        assert_eq!(
            firmware(FirmwareEvent::Failsafe {
                policy: RxLossPolicy::Land,
                stage: 2,
                procedure: FailsafeProcedure::Land,
            }),
            r#"{"t":12.34,"event":"failsafe","policy":"LAND","stage":2,"procedure":"LAND"}"#
        );
        assert_eq!(
            line(EventKind::Fault {
                kind: FaultKind::Motor,
                on: true,
                value: FaultValue::Motor { motor: 2, value: 0.8 }
            }),
            r#"{"t":12.34,"event":"fault","name":"motor","on":true,"value":"2:0.8"}"#
        );
        assert_eq!(
            line(EventKind::Touchdown { impact_mps: 0.47, peak_mps2: 43.123_456 }),
            r#"{"t":12.34,"event":"touchdown","impact_mps":0.47,"peak_mps2":43.123}"#
        );
        assert_eq!(
            firmware(FirmwareEvent::Battery { state: BatteryAlarm::Critical, cell_v: 3.2987 }),
            r#"{"t":12.34,"event":"battery","state":"CRITICAL","cell_v":3.299}"#
        );
        assert_eq!(
            line(EventKind::BatteryEmpty { cell_v: 2.9 }),
            r#"{"t":12.34,"event":"battery","state":"EMPTY","cell_v":2.9}"#
        );
        let deviation = CannotHold { distance_m: 23.4, vertical_m: -0.25, limit: HoldLimit::Tilt };
        assert_eq!(
            firmware(FirmwareEvent::Nav(NavEvent::CannotHold { on: true, deviation })),
            r#"{"t":12.34,"event":"cannot_hold","on":true,"distance_m":23.4,"vertical_m":-0.25,"limit":"lean"}"#
        );
        let places = EndpointAddresses {
            ws: "127.0.0.1:6761".parse().ok(),
            rc: "[::1]:9004".parse().ok(),
            ..EndpointAddresses::default()
        };
        assert_eq!(
            session_line(SessionEvent::Endpoints(places)),
            r#"{"t":12.34,"event":"doors","ws":"127.0.0.1:6761","tcp":null,"fdm":null,"rc":"[::1]:9004"}"#
        );
        assert_eq!(
            session_line(SessionEvent::Notice("a \"b\"".to_owned())),
            r#"{"t":12.34,"event":"notice","text":"a \"b\""}"#
        );
    }

    #[test]
    fn a_transition_says_why() {
        let guard = Guard { name: GuardName::Arrival, value: 4.95, limit: 5.0, op: GuardOp::AtMost };
        let event = NavEvent::State {
            from: NavState::Approaching,
            to: NavState::Arrived,
            wp: 2,
            kind: Some(WaypointType::Hold),
            reason: TransitionReason::Arrival,
            guard: Some(guard),
            target: LatLon::new(404_640_000, -795_175_000),
            target_alt_m: 50.0,
        };
        assert_eq!(
            firmware(FirmwareEvent::Nav(event)),
            "{\"t\":12.34,\"event\":\"state\",\"from\":\"APPROACHING\",\"to\":\"ARRIVED\",\"wp\":2,\
             \"type\":\"HOLD\",\"reason\":\"arrival\",\"guard\":{\"name\":\"arrival\",\"value\":4.95,\"limit\":5.0,\
             \"unit\":\"m\",\"margin\":0.05,\"op\":\"≤\"},\"target_lat\":40.464,\"target_lon\":-79.5175,\
             \"target_alt\":50.0}"
        );
    }

    #[test]
    fn a_refusal_names_reason_waypoint_and_sentence() {
        let refusal = Refusal::Geofence { wp: 0, distance_cm: 15_040, limit_m: 100 };
        assert_eq!(
            firmware(FirmwareEvent::Nav(NavEvent::Refused(refusal))),
            "{\"t\":12.34,\"event\":\"engage_refused\",\"reason\":\"GEOFENCE\",\"wp\":0,\"cause\":null,\
             \"text\":\"Waypoint 0 is 150 m from home, the fence is 100 m.\"}"
        );
        let aborted = firmware(FirmwareEvent::Nav(NavEvent::Refused(Refusal::Aborted(AbortReason::Stalled))));
        assert!(aborted.contains(r#""reason":"ABORTED","wp":null,"cause":"STALLED""#), "{aborted}");
    }

    #[test]
    fn a_plan_lists_its_waypoints() {
        let mut plan = FlightPlan::default();
        plan.waypoints.push(Waypoint {
            position: LatLon::new(404_635_000, -795_182_000),
            altitude: Altitude::above_home(-1.5),
            kind: WaypointType::Land,
            ..Waypoint::default()
        });
        let event = NavEvent::Plan { source: PlanSource::Rth, plan: Box::new(plan) };
        assert_eq!(
            firmware(FirmwareEvent::Nav(event)),
            "{\"t\":12.34,\"event\":\"plan\",\"source\":\"rth\",\"count\":1,\"waypoints\":[{\"type\":\"LAND\",\
             \"lat\":40.4635,\"lon\":-79.5182,\"alt\":-1.5}]}"
        );
    }

    #[test]
    fn the_navigators_disarm_request_has_no_line_of_its_own() {
        let kind = SessionEvent::Vehicle(EventKind::Firmware(FirmwareEvent::Nav(NavEvent::Disarm)));
        assert_eq!(event_line(&Event { time: SimTime::ZERO, kind }), None);
    }
}
