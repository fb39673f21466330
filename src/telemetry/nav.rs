//! The public state of the navigator: state, events and the values for displays, logs and samples.

use nalgebra::Vector2;

use super::cannot_hold::CannotHold;
use super::guard::Guard;
use super::refusal::Refusal;
use super::transition::TransitionReason;
use crate::geo::LatLon;
use crate::plan::{FlightPlan, WaypointType};

/// The eight states of the waypoint state machine. The discriminant is the code on the wire.
#[derive(
    Debug,
    Clone,
    Copy,
    PartialEq,
    Eq,
    PartialOrd,
    Ord,
    Default,
    Hash,
    strum::Display,
    strum::EnumIter,
    strum::IntoStaticStr,
    serde::Serialize,
    serde::Deserialize,
)]
#[strum(serialize_all = "UPPERCASE")]
#[repr(u8)]
pub enum NavState {
    /// The autopilot does not fly.
    #[default]
    Idle = 0,
    /// On the way to the current waypoint.
    Approaching = 1,
    /// At the current waypoint. Lasts one update.
    Arrived = 2,
    /// Holding the position of the waypoint.
    Holding = 3,
    /// On a circle about the waypoint.
    Orbiting = 4,
    /// Flying a figure of eight.
    Figure8 = 5,
    /// Descending to the touchdown.
    Landing = 6,
    /// The plan is flown to its end.
    Complete = 7,
}

/// The origin of the active plan.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, Default, Hash, strum::Display, serde::Serialize, serde::Deserialize,
)]
#[strum(serialize_all = "lowercase")]
pub enum PlanSource {
    /// The user's stored plan.
    #[default]
    Stored,
    /// Return to home: FLYOVER and LAND at home.
    Rth,
    /// Emergency landing: LAND here.
    Emergency,
}

/// The choice of the aim point on the current leg.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, Default, Hash, strum::Display, serde::Serialize, serde::Deserialize,
)]
#[strum(serialize_all = "UPPERCASE")]
pub enum L1Mode {
    /// No leg is followed.
    #[default]
    Off,
    /// The aim point moves along the leg.
    Track,
    /// The aim point is the end of the leg.
    Direct,
}

/// The reaction to leaving the fence.
#[derive(
    Debug,
    Clone,
    Copy,
    PartialEq,
    Eq,
    Default,
    Hash,
    strum::Display,
    strum::EnumIter,
    strum::FromRepr,
    strum::IntoStaticStr,
    strum::VariantNames,
    serde::Serialize,
    serde::Deserialize,
)]
#[strum(serialize_all = "UPPERCASE")]
#[repr(u8)]
pub enum FenceAction {
    /// Land on the spot.
    #[default]
    Land = 0,
    /// Fly home and land.
    Rth = 1,
}

/// An event of the navigator.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub enum NavEvent {
    /// A new active plan.
    Plan {
        /// The origin of the plan.
        source: PlanSource,
        /// The plan.
        plan: Box<FlightPlan>,
    },
    /// The state machine entered a state.
    State {
        /// The old state.
        from: NavState,
        /// The new state.
        to: NavState,
        /// The index of the current waypoint in the active plan.
        wp: u8,
        /// The type of the waypoint, if there is one.
        kind: Option<WaypointType>,
        /// The cause of the transition.
        reason: TransitionReason,
        /// The guard that caused the transition, if there is one.
        guard: Option<Guard>,
        /// The target position, degrees × 10⁷.
        target: LatLon,
        /// The target altitude above home, m.
        target_alt_m: f64,
    },
    /// The climb before the first leg began (`true`) or ended.
    Climbing(bool),
    /// The thrust does not suffice for the requested tilt, so the tilt is limited and the speed is lower.
    /// Sent once per leg.
    Limited {
        /// The current maximum tilt, rad.
        #[serde(rename = "lean_rad")]
        tilt_rad: f64,
    },
    /// The craft left the fence.
    Geofence {
        /// Distance from home, m.
        distance_m: f64,
        /// The radius of the fence, m.
        limit_m: f64,
        /// The reaction.
        action: FenceAction,
    },
    /// The craft cannot hold its position (`on`), or can again.
    CannotHold {
        /// `true` if it cannot, `false` if it can again.
        on: bool,
        /// The deviation of the craft.
        deviation: CannotHold,
    },
    /// The switch is on and the autopilot does not engage. Sent once per cause.
    Refused(Refusal),
    /// The navigator detected the touchdown: disarm now, with reason LANDING.
    Disarm,
}

/// The navigator's state for displays, logs and samples. Each update refreshes it.
#[derive(Debug, Clone, PartialEq, Default, serde::Serialize, serde::Deserialize)]
#[serde(default)]
pub struct NavTelemetry {
    /// The state of the machine.
    pub state: NavState,
    /// `true` while a mission is flown.
    pub engaged: bool,
    /// `true` during the climb before the first leg.
    pub climbing: bool,
    /// The reason why the switch has no effect, if it has none.
    pub refusal: Option<Refusal>,
    /// The cause of the last transition.
    pub reason: Option<TransitionReason>,
    /// Index of the current waypoint in the active plan.
    pub wp: u8,
    /// The index of the positional waypoint after it; the same index for the last one.
    pub next_wp: u8,
    /// The number of waypoints in the active plan.
    pub count: u8,
    /// Origin of the active plan.
    pub source: PlanSource,
    /// Type of the current waypoint.
    pub kind: Option<WaypointType>,
    /// Distance to the current waypoint, m.
    pub distance_m: Option<f64>,
    /// Bearing to the current waypoint, rad clockwise from north.
    pub bearing_rad: Option<f64>,
    /// Cross-track error, m, positive right of the leg.
    pub xte_m: Option<f64>,
    /// Distance along the leg, m.
    pub along_m: Option<f64>,
    /// Effective lookahead, m.
    pub lookahead_m: Option<f64>,
    /// The choice of the aim point, if it is reported.
    pub l1_mode: Option<L1Mode>,
    /// Aim point, north and east of the origin of the local frame, m.
    pub aim_ne: Option<Vector2<f64>>,
    /// Lateral acceleration of the L1 law, m/s², right positive.
    pub a_lat_mps2: Option<f64>,
    /// Horizontal target, north and east of the origin, m.
    pub target_ne: Option<Vector2<f64>>,
    /// Altitude setpoint above home, m.
    pub target_alt_m: Option<f64>,
    /// Start of the current leg.
    pub leg_start: Option<LatLon>,
    /// Ground speed, m/s.
    pub speed_mps: f64,
    /// Speed setpoint, m/s.
    pub speed_setpoint_mps: Option<f64>,
    /// Phase of the hold pattern, rad.
    pub pattern_angle_rad: Option<f64>,
    /// The remaining hold time, s, if it is reported; infinite if the hold is endless, 0 outside a hold.
    pub hold_remaining_s: Option<f64>,
    /// `true` if the hold was commanded, not planned.
    pub held_by_command: bool,
    /// Distance from home, m.
    pub home_distance_m: Option<f64>,
    /// Distance remaining to the fence, m.
    pub fence_margin_m: Option<f64>,
    /// Time to the waypoint, s.
    pub eta_s: Option<f64>,
    /// `true` while the pilot's sticks control roll and pitch.
    pub stick_override: bool,
    /// `true` while the pilot's stick controls yaw.
    pub yaw_override: bool,
    /// The deviation while the craft cannot hold its position.
    pub cannot_hold: Option<CannotHold>,
    /// Time for which the touchdown conditions have held, s.
    pub touchdown_held_s: Option<f64>,
    /// The hover throttle in use, µs.
    pub hover_us: f64,
    /// The guards of the active state, in the order of evaluation.
    pub guards: arrayvec::ArrayVec<Guard, 9>,
    /// The roll demand, rad, right positive.
    pub roll_demand_rad: f64,
    /// The pitch demand, rad, nose down positive.
    pub pitch_down_demand_rad: f64,
}

impl NavTelemetry {
    /// Returns the telemetry of a navigator that flies nothing and reports everything.
    pub fn idle() -> Self {
        Self { l1_mode: Some(L1Mode::Off), hold_remaining_s: Some(0.0), ..Self::default() }
    }
}
