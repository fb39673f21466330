//! What goes into and comes out of the navigator: the seam between the firmware and the autopilot.
//!
//! Local frame: north, east (m) relative to `origin`, fixed while armed; altitude in metres above home (the arming
//! point). Angles in radians, heading clockwise from north. Sign conventions of demands: roll right +, pitch **nose
//! down** + (accelerates forward), yaw rate clockwise +.

use nalgebra::Vector2;

use crate::geo::LatLon;
use crate::plan::{FlightPlan, WaypointType};
use crate::signals::SimTime;

/// The eight states of the waypoint state machine; the discriminant is the code on the wire.
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
)]
#[strum(serialize_all = "UPPERCASE")]
#[repr(u8)]
pub enum NavState {
    /// Not flying.
    #[default]
    Idle = 0,
    /// On the way to the current waypoint.
    Approaching = 1,
    /// Reached it; lasts one update.
    Arrived = 2,
    /// Keeping station.
    Holding = 3,
    /// Circling.
    Orbiting = 4,
    /// Flying the figure of eight.
    Figure8 = 5,
    /// Descending.
    Landing = 6,
    /// Mission over.
    Complete = 7,
}

/// Facts for one update.
#[derive(Debug, Clone, PartialEq)]
pub struct NavInputs {
    /// Time of this update.
    pub time: SimTime,
    /// Seconds since the previous update (nominally 0.01).
    pub dt: f64,
    /// Whether the craft is armed.
    pub armed: bool,
    /// Whether a 3-D GPS fix is present.
    pub fix: bool,
    /// Whether the altitude estimate is valid.
    pub altitude_valid: bool,
    /// Whether the throttle has been above 25 % since arming.
    pub throttle_raised: bool,
    /// Whether stage 2 of the receiver failsafe is active.
    pub failsafe: bool,
    /// Home (GPS position at arming), when known.
    pub home: Option<LatLon>,
    /// Origin of the local frame of this flight.
    pub origin: LatLon,
    /// Estimated position, north and east of `origin`, m.
    pub pos_ne: Vector2<f64>,
    /// Estimated ground velocity, north and east, m/s.
    pub vel_ne: Vector2<f64>,
    /// Estimated altitude above home, m.
    pub alt_m: f64,
    /// Estimated climb rate, m/s, up positive.
    pub climb_mps: f64,
    /// Estimated heading, rad clockwise from north.
    pub heading_rad: f64,
    /// Estimated yaw rate, rad/s, clockwise positive.
    pub yaw_rate_rps: f64,
    /// Estimated roll, rad, right wing down positive.
    pub roll_rad: f64,
    /// Estimated pitch, rad, nose **down** positive.
    pub pitch_rad: f64,
    /// Cosine of the tilt from level.
    pub cos_tilt: f64,
    /// Earth-frame acceleration without gravity, north and east, m/s².
    pub accel_ne: Vector2<f64>,
    /// Throttle that drove the mixer in the previous cycle, as RC µs (1000…2000).
    pub throttle_us: f64,
    /// Roll stick, RC command units ±500, right positive; 0 while the link is lost.
    pub stick_roll: f64,
    /// Pitch stick, RC command units ±500, forward positive; 0 while the link is lost.
    pub stick_pitch: f64,
    /// Yaw stick, RC command units ±500, right positive; 0 while the link is lost.
    pub stick_yaw: f64,
}

/// Demands for the attitude and throttle loops.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct NavOutput {
    /// Roll demand, rad, right positive.
    pub roll_rad: f64,
    /// Pitch demand, rad, nose **down** positive.
    pub pitch_rad: f64,
    /// Yaw rate demand, rad/s, clockwise positive; `None` = the pilot's stick.
    pub yaw_rate_rps: Option<f64>,
    /// Throttle into the mixer, 0…1.
    pub throttle: f64,
    /// The same throttle as RC µs.
    pub throttle_us: f64,
    /// A landing craft does not sink although the throttle was taken off: it stands on its legs, and controllers should
    /// forget what they gathered against the ground.
    pub stands: bool,
}

/// Comparison a guard makes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, strum::Display)]
pub enum GuardOp {
    /// value ≤ limit
    #[strum(to_string = "≤")]
    AtMost,
    /// value ≥ limit
    #[strum(to_string = "≥")]
    AtLeast,
    /// value < limit
    #[strum(to_string = "<")]
    Below,
    /// value > limit
    #[strum(to_string = ">")]
    Above,
}

/// A named condition of the state machine with everything needed to say why it does or does not hold.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Guard {
    /// What is compared: `arrival`, `turn radius`, `plane`, `hold time`, `touchdown altitude`…
    pub name: &'static str,
    /// The measured value.
    pub value: f64,
    /// The limit it is compared with.
    pub limit: f64,
    /// How.
    pub op: GuardOp,
    /// Unit of both, `m`, `s`, `m/s`, `µs`, `deg`.
    pub unit: &'static str,
}

impl Guard {
    /// Whether the condition holds; never for NaN.
    #[must_use]
    pub fn holds(&self) -> bool {
        match self.op {
            GuardOp::AtMost => self.value <= self.limit,
            GuardOp::AtLeast => self.value >= self.limit,
            GuardOp::Below => self.value < self.limit,
            GuardOp::Above => self.value > self.limit,
        }
    }

    /// How far the value is on the fulfilled side: ≥ 0 when the condition holds.
    #[must_use]
    pub fn margin(&self) -> f64 {
        match self.op {
            GuardOp::AtMost | GuardOp::Below => self.limit - self.value,
            GuardOp::AtLeast | GuardOp::Above => self.value - self.limit,
        }
    }
}

/// Where the active plan came from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash, strum::Display)]
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

/// Why the autopilot does not engage or left the mission; `Display` gives the name (without the waypoint
/// number).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, strum::Display)]
#[strum(serialize_all = "SCREAMING_SNAKE_CASE")]
pub enum Refusal {
    /// The craft is not armed.
    NotArmed,
    /// The throttle has not been raised since arming.
    Throttle,
    /// No GPS fix.
    NoFix,
    /// No altitude estimate.
    NoAltitude,
    /// The stored plan is empty.
    NoPlan,
    /// The stored plan is damaged.
    PlanCorrupt,
    /// This waypoint is invalid.
    BadWaypoint(u8),
    /// A fence is set but home is unknown.
    NoHome,
    /// This waypoint lies outside the fence.
    Geofence {
        /// Index of the waypoint in the stored plan.
        wp: u8,
        /// Its distance from home, cm.
        distance_cm: u32,
        /// The fence, m.
        limit_m: u16,
    },
    /// The receiver failsafe is active.
    Failsafe,
    /// The mission was given up for this cause; cycle the switch.
    Aborted(AbortReason),
}

/// Why a mission ended without completing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, strum::Display)]
#[strum(serialize_all = "SCREAMING_SNAKE_CASE")]
pub enum AbortReason {
    /// No progress towards the waypoint for 30 s.
    Stalled,
    /// The craft moves away from the waypoint.
    Flyaway,
    /// The GPS fix was lost.
    GpsLost,
    /// The plan was cleared while it was flown.
    NoPlan,
}

/// How the aim point of the current leg was chosen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash, strum::Display)]
#[strum(serialize_all = "UPPERCASE")]
pub enum L1Mode {
    /// No path following.
    #[default]
    Off,
    /// The carrot runs on the leg.
    Track,
    /// The aim is the end of the leg.
    Direct,
}

/// Something that happened in the navigator.
#[derive(Debug, Clone, PartialEq)]
pub enum NavEvent {
    /// A new active plan.
    Plan {
        /// Where it came from.
        source: PlanSource,
        /// The plan.
        plan: Box<FlightPlan>,
    },
    /// A state transition.
    State {
        /// State left.
        from: NavState,
        /// State entered.
        to: NavState,
        /// Index of the current waypoint in the active plan.
        wp: u8,
        /// Its type, when there is one.
        kind: Option<WaypointType>,
        /// The cause in a word: a guard's name, `reset`, `resume`, `advance`, `GPS_LOST`…
        reason: &'static str,
        /// The guard that fired, if one did.
        guard: Option<Guard>,
        /// Target position.
        target: LatLon,
        /// Target altitude above home, m.
        target_alt_m: f64,
    },
    /// The climb before the first leg began (`true`) or ended.
    Climbing(bool),
    /// The craft left the fence.
    Geofence {
        /// Distance from home, m.
        distance_m: f64,
        /// The fence, m.
        limit_m: f64,
        /// What is done about it: `LAND` or `RTH`.
        action: &'static str,
    },
    /// The switch is on and the autopilot does not engage; sent once per cause.
    Refused(Refusal),
    /// The navigator saw the touchdown: disarm now, reason LANDING.
    Disarm,
}

/// The navigator's state for displays, logs and samples; refreshed by each update.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct NavTelemetry {
    /// State of the machine.
    pub state: NavState,
    /// Whether a mission is being flown.
    pub engaged: bool,
    /// The climb before the first leg is on.
    pub climbing: bool,
    /// Why the switch has no effect, if it has none.
    pub refusal: Option<Refusal>,
    /// The cause of the last transition in a word.
    pub reason: &'static str,
    /// Index of the current waypoint in the active plan.
    pub wp: u8,
    /// Index of the positional waypoint after it; the same when it is the last.
    pub next_wp: u8,
    /// Waypoints in the active plan.
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
    /// How the aim was chosen.
    pub l1_mode: L1Mode,
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
    /// Hold time left, ds; 65535 = endless, 0 outside a hold.
    pub hold_remaining_ds: u16,
    /// Distance from home, m.
    pub home_distance_m: Option<f64>,
    /// Distance left to the fence, m.
    pub fence_margin_m: Option<f64>,
    /// Time to the waypoint, s.
    pub eta_s: Option<f64>,
    /// Roll and pitch are flown by the pilot's sticks.
    pub stick_override: bool,
    /// Yaw is flown by the pilot's stick.
    pub yaw_override: bool,
    /// Time the touchdown conditions have held, s.
    pub touchdown_held_s: Option<f64>,
    /// Hover throttle in use, µs.
    pub hover_us: f64,
    /// The guards of the active state, in the order they are evaluated.
    pub guards: arrayvec::ArrayVec<Guard, 8>,
    /// The demands of this update.
    pub output: NavOutput,
}
