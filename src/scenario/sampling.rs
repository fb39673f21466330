//! A sample of a flight, taken from the vehicle.

use super::signal::{Flag, Signal};
use super::trace::Sample;
use crate::signals::SimTime;
use crate::telemetry::snapshot::{CraftView, EstimateView};
use crate::telemetry::{NavTelemetry, PlanSource};
use crate::vehicle::Vehicle;

/// The ground speed below which the course has no meaning, m/s.
const COURSE_MPS: f64 = 0.3;

/// The facts that a sample needs besides the vehicle.
#[derive(Debug, Clone, Copy)]
pub(super) struct Origin {
    /// The height of the centre of mass while the craft is on the ground, m.
    pub(super) standing_m: f64,
    pub(super) engaged_at: Option<SimTime>,
}

/// Takes a sample now.
pub(super) fn sample(vehicle: &Vehicle, origin: Origin) -> Sample {
    let mut values = Values([f32::NAN; Signal::COUNT]);
    let time = vehicle.time();
    values.set(Signal::BootTime, time.as_secs_f64());
    values
        .set_known(Signal::Time, origin.engaged_at.map(|engaged| time.as_secs_f64() - engaged.as_secs_f64()));
    values.of_truth(vehicle, origin.standing_m);
    let craft = vehicle.controller().craft_view();
    values.of_craft(&craft);
    values.of_estimate(&vehicle.estimate_view());
    let nav = vehicle.nav_view();
    if let Some(nav) = &nav {
        values.of_nav(nav);
    }
    let target = nav.as_ref().and_then(|nav| nav.target_ne);
    Sample {
        time,
        values: values.0,
        flags: flags(vehicle, &craft, nav.as_ref()),
        state: nav.as_ref().map(|nav| nav.state).unwrap_or_default(),
        wp: nav.as_ref().map_or(0, |nav| nav.wp),
        source: nav.as_ref().map_or(PlanSource::Stored, |nav| nav.source),
        modes: craft.modes.unwrap_or_default(),
        target_ne: target.map_or([f32::NAN; 2], |ne| [ne.x as f32, ne.y as f32]),
    }
}

struct Values([f32; Signal::COUNT]);

impl Values {
    fn set(&mut self, signal: Signal, value: f64) {
        self.0[signal as usize] = value as f32;
    }

    fn set_known(&mut self, signal: Signal, value: Option<f64>) {
        if let Some(value) = value {
            self.set(signal, value);
        }
    }

    fn of_truth(&mut self, vehicle: &Vehicle, standing_m: f64) {
        let Some(truth) = vehicle.truth() else { return };
        let (east, north) = (truth.vel_enu.x, truth.vel_enu.y);
        let speed = north.hypot(east);
        self.set(Signal::North, truth.pos_enu.y);
        self.set(Signal::East, truth.pos_enu.x);
        self.set(Signal::Altitude, truth.pos_enu.z - standing_m);
        self.set(Signal::Speed, speed);
        self.set(Signal::SpeedNorth, north);
        self.set(Signal::SpeedEast, east);
        self.set(Signal::Climb, truth.vel_enu.z);
        let (roll, pitch) = (truth.roll_deg(), truth.pitch_deg());
        self.set(Signal::Roll, roll);
        self.set(Signal::Pitch, pitch);
        self.set(Signal::Heading, truth.heading_deg());
        if speed >= COURSE_MPS {
            self.set(Signal::Course, east.atan2(north).to_degrees().rem_euclid(360.0));
        }
        self.set(Signal::Lean, (roll.to_radians().cos() * pitch.to_radians().cos()).acos().to_degrees());
        self.set(Signal::Force, truth.specific_force_flu.norm());
        let battery = truth.battery;
        self.set(Signal::Battery, battery.voltage_v);
        self.set(Signal::Current, battery.current_a);
        self.set(Signal::Charge, battery.drawn_mah * 3.6);
        self.set(Signal::BatteryUsed, battery.drawn_mah / battery.capacity_mah);
        self.set(Signal::Wind, truth.wind_enu.norm());
    }

    fn of_craft(&mut self, craft: &CraftView) {
        self.set_known(Signal::Throttle, craft.throttle_us);
        let signals = [Signal::Motor1, Signal::Motor2, Signal::Motor3, Signal::Motor4];
        for (signal, motor) in signals.into_iter().zip(craft.motors.into_iter().flatten()) {
            self.set(signal, motor);
        }
        self.set_known(Signal::Satellites, craft.sats.map(f64::from));
        if let Some(cells) = craft.battery_cells {
            let battery = f64::from(self.0[Signal::Battery as usize]);
            self.set(Signal::Cell, battery / f64::from(cells));
        }
    }

    fn of_estimate(&mut self, estimate: &EstimateView) {
        self.set_known(Signal::EstNorth, estimate.n);
        self.set_known(Signal::EstEast, estimate.e);
        self.set_known(Signal::EstAltitude, estimate.alt);
    }

    fn of_nav(&mut self, nav: &NavTelemetry) {
        if nav.engaged {
            self.set(Signal::Waypoint, f64::from(nav.wp));
        }
        self.set_known(Signal::WpDistance, nav.distance_m);
        self.set_known(Signal::CrossTrack, nav.xte_m);
        self.set_known(Signal::TargetAltitude, nav.target_alt_m);
        self.set_known(Signal::SpeedSetpoint, nav.speed_setpoint_mps);
        self.set_known(Signal::HomeDistance, nav.home_distance_m);
        self.set_known(Signal::FenceMargin, nav.fence_margin_m);
        self.set_known(Signal::HoldRemaining, nav.hold_remaining_s.filter(|left_s| left_s.is_finite()));
        self.set_known(Signal::TouchdownHeld, nav.touchdown_held_s);
        self.set(Signal::Hover, nav.hover_us);
        if nav.engaged {
            self.set(Signal::RollDemand, nav.output.roll_rad.to_degrees());
            self.set(Signal::PitchDemand, -nav.output.pitch_rad.to_degrees());
        }
    }
}

fn flags(vehicle: &Vehicle, craft: &CraftView, nav: Option<&NavTelemetry>) -> u16 {
    let truth = vehicle.truth();
    let set = [
        (Flag::Armed, craft.is_armed()),
        (Flag::Engaged, nav.is_some_and(|nav| nav.engaged)),
        (Flag::Climbing, nav.is_some_and(|nav| nav.climbing)),
        (Flag::Fix, craft.has_fix()),
        (Flag::OnGround, truth.is_some_and(|truth| truth.on_ground)),
        (Flag::Crashed, vehicle.crashed()),
        (Flag::StickOverride, nav.is_some_and(|nav| nav.stick_override)),
        (Flag::RxLink, craft.rc_link == Some(true)),
        (Flag::CannotHold, nav.is_some_and(|nav| nav.cannot_hold.is_some())),
    ];
    set.into_iter().filter(|&(_, on)| on).fold(0, |bits, (flag, _)| bits | 1 << flag as u8)
}
