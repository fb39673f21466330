//! The firmware on a kinematic craft, and the pilot of a rescue.

use betadeck_core::firmware::config::Configuration;
use betadeck_core::firmware::{AttitudeSource, FirmwareOptions};
use betadeck_core::signals::{MotorCommand, RcFrame, RcSource};
use betadeck_core::sim::{Noise, WorldConfig};
use betadeck_core::telemetry::{ArmingFlags, DisarmReason, EventKind, FirmwareEvent, Mode};
use betadeck_core::vehicle::{CliSession, Vehicle, VehicleCommand, VehicleConfig};

use crate::kinematic_craft::plant::{Kind, Plant};

/// The interval of the simulator's packets, µs.
const PACKET_US: u64 = 20_000;
const PACKET_S: f64 = PACKET_US as f64 * 1e-6;
/// The channels in wire order.
const THROTTLE: usize = 2;
const ARM: usize = 4;
const AUTOPILOT: usize = 5;
const ANGLE: usize = 6;
const HOLDS: usize = 7;
const RESCUE: usize = 8;

/// The configuration of the public harness for its rescues.
pub(crate) const SETTINGS: &str = "\
feature GPS
set gps_provider = VIRTUAL
set failsafe_procedure = GPS-RESCUE
set failsafe_delay = 10
set small_angle = 180
aux 0 0 0 1700 2100 0 0
aux 1 56 1 1700 2100 0 0
aux 2 1 2 1700 2100 0 0
aux 3 3 3 1700 2100 0 0
aux 4 11 3 1700 2100 0 0
aux 5 46 4 1700 2100 0 0
set trust_mag = ON
set ap_velocity_drag_coeff = 50
set gps_rescue_alt_mode = FIXED_ALT
set gps_rescue_return_alt = 30
set gps_rescue_ascend_rate = 100
set gps_rescue_descend_rate = 80
set ap_yaw_mode = FIXED
set ap_waypoint_hold_radius = 400
set ap_landing_descent_rate = 200
set landing_disarm_threshold = 10
waypoint insert 0 -27.4973051 153.0000000 1000 500 FLYOVER 0 NONE";

/// A flight.
#[derive(Clone)]
pub(crate) struct Rig {
    pub(crate) vehicle: Vehicle,
    pub(crate) plant: Plant,
    frame: RcFrame,
    link: bool,
    /// The reason and the height at which the motors first stopped.
    pub(crate) disarmed: Option<(DisarmReason, f64)>,
    /// The speed into the ground at the last touchdown, m/s.
    pub(crate) impact_mps: f64,
    /// Seconds on the ground with the motors on, since the last touchdown.
    pub(crate) stood_s: f64,
    /// The heights and sink rates of the flight, one per packet.
    pub(crate) path: Vec<(f64, f64)>,
}

impl Rig {
    /// Creates a craft at home with the settings of the harness and these lines, with warm sensors.
    pub(crate) fn new(kind: Kind, lines: &str) -> Self {
        let world = WorldConfig { noise: Noise::None, ..WorldConfig::default() };
        let firmware = FirmwareOptions {
            rate_hz: world.rate_hz,
            arm_assist: true,
            attitude: AttitudeSource::Truth,
            ..FirmwareOptions::default()
        };
        let configuration = Configuration::default();
        let config = VehicleConfig { world, firmware, configuration, live: false };
        let vehicle = Vehicle::with_external_physics(config).unwrap();
        let mut rig = Self {
            vehicle,
            plant: Plant::new(kind),
            frame: RcFrame::SAFE,
            link: true,
            disarmed: None,
            impact_mps: 0.0,
            stood_s: 0.0,
            path: Vec::new(),
        };
        rig.vehicle.apply(&VehicleCommand::CutRc(true));
        for line in SETTINGS.lines().chain(lines.lines()) {
            let reply = rig.vehicle.apply(&VehicleCommand::line(CliSession::Console, line)).line().unwrap();
            assert!(!reply.failed, "{line}: {}", reply.text);
        }
        rig
    }

    /// Flies for one packet of the simulator.
    pub(crate) fn packet(&mut self) {
        let mut sensors = self.plant.sensors(PACKET_S);
        let mut motors = MotorCommand::default();
        if self.link {
            self.vehicle.apply(&VehicleCommand::Rc(self.frame, RcSource::Udp));
        }
        for _ in 0..PACKET_US / self.vehicle.step_us() {
            motors = self.vehicle.tick_on(&sensors);
            (sensors.pressure_pa, sensors.mag_flu, sensors.gps) = (None, None, None);
        }
        let (height_m, climb_mps) = (self.plant.height_m(), self.plant.climb_mps());
        let disarmed = &mut self.disarmed;
        self.vehicle.drain_events(|event| {
            if let EventKind::Firmware(FirmwareEvent::Disarmed(reason)) = event.kind {
                disarmed.get_or_insert((reason, height_m));
            }
        });
        self.path.push((height_m, -climb_mps));
        self.plant.step(PACKET_S, &motors);
        let stands = self.plant.height_m() <= 0.0;
        if stands && height_m > 0.0 {
            self.impact_mps = -climb_mps;
        }
        self.stood_s = if stands && self.disarmed.is_none() { self.stood_s + PACKET_S } else { 0.0 };
    }

    /// Flies until the condition holds.
    #[track_caller]
    pub(crate) fn until(&mut self, limit_s: f64, what: &str, done: impl Fn(&Self) -> bool) -> &mut Self {
        for _ in 0..(limit_s / PACKET_S) as u32 {
            if done(self) {
                return self;
            }
            self.packet();
        }
        panic!("never came: {what}; height {:.1} m, {:?}", self.plant.height_m(), self.modes());
    }

    pub(crate) fn fly(&mut self, seconds: f64) -> &mut Self {
        for _ in 0..(seconds / PACKET_S).round() as u32 {
            self.packet();
        }
        self
    }

    pub(crate) fn has(&self, mode: Mode) -> bool {
        self.vehicle.embedded().unwrap().craft_view().modes.unwrap().has(mode)
    }

    fn modes(&self) -> Option<betadeck_core::telemetry::ModeFlags> {
        self.vehicle.embedded().unwrap().craft_view().modes
    }

    fn switch(&mut self, channel: usize, on: bool) {
        self.frame.channels[channel] = if on { 2000 } else { 1000 };
    }

    pub(crate) fn throttle(&mut self, us: u16) {
        self.frame.channels[THROTTLE] = us;
    }

    /// Arms and climbs in ANGLE for some seconds with this throttle.
    pub(crate) fn take_off(&mut self, us: u16, seconds: f64) -> &mut Self {
        self.until(40.0, "no arming flag", |rig| {
            rig.vehicle.embedded().unwrap().arming_flags() == ArmingFlags::NONE
        });
        self.switch(ANGLE, true);
        self.switch(ARM, true);
        self.until(8.0, "armed", |rig| rig.has(Mode::Arm));
        self.throttle(us);
        self.fly(seconds)
    }

    /// Takes off and engages in the climb.
    pub(crate) fn engaged(&mut self, us: u16) -> &mut Self {
        self.take_off(us, 3.0);
        self.switch(AUTOPILOT, true);
        self.until(20.0, "engagement", |rig| rig.has(Mode::Autopilot));
        self.throttle(1300);
        self
    }

    /// Flies out on the mission until `distance_m`, then holds by the pilot's switches.
    pub(crate) fn parked(&mut self, us: u16, distance_m: f64) -> &mut Self {
        self.engaged(us);
        self.until(90.0, "way out", |rig| rig.plant.distance_m() > distance_m);
        self.hold();
        self.switch(AUTOPILOT, false);
        self.fly(2.0)
    }

    /// Switches ALTHOLD and POS HOLD on.
    pub(crate) fn hold(&mut self) -> &mut Self {
        self.switch(HOLDS, true);
        self
    }

    /// Switches from the holds to the rescue and waits for it.
    pub(crate) fn rescue(&mut self) -> &mut Self {
        self.switch(HOLDS, false);
        self.switch(RESCUE, true);
        self.until(20.0, "rescue", |rig| rig.has(Mode::Autopilot))
    }

    /// Switches to manual flight, which only levels the craft.
    pub(crate) fn by_hand(&mut self) -> &mut Self {
        self.switch(HOLDS, false);
        self.switch(AUTOPILOT, false);
        self
    }

    pub(crate) fn lose_gps(&mut self) -> &mut Self {
        self.plant.has_gps = false;
        self
    }

    pub(crate) fn lose_link(&mut self) -> &mut Self {
        self.link = false;
        self
    }

    /// Returns the median of the sink rates between two heights since this packet of the flight, m/s.
    pub(crate) fn sink_mps(&self, since: usize, heights: std::ops::Range<f64>) -> f64 {
        let mut rates: Vec<f64> =
            self.path[since..].iter().filter(|(height, _)| heights.contains(height)).map(|s| s.1).collect();
        rates.sort_by(f64::total_cmp);
        rates[rates.len() / 2]
    }
}
