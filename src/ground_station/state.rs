//! Telemetry from the view of the session.

use std::time::Duration;

use crate::mavlink::craft::{CraftState, FlightMode, MissionProgress};
use crate::mavlink::state::{BatteryState, GeoPosition, GpsState, NavigationState, RcState};
use crate::mavlink::value::{GpsFix, LandedState, MissionState, sensor};
use crate::session::SessionView;
use crate::telemetry::snapshot::Snapshot;
use crate::telemetry::{Mode, NavState, PlanSource};

/// The altitude below which a craft of which only estimates are known counts as on the ground, m.
const STANDING_BELOW_M: f64 = 0.5;
/// The voltages of an empty and of a full cell, V.
const EMPTY_CELL_V: f64 = 3.3;
const FULL_CELL_V: f64 = 4.2;

/// Returns `true` if the craft is on the ground.
pub(super) fn is_on_ground(vehicle: &Snapshot) -> bool {
    match &vehicle.truth {
        Some(truth) => truth.on_ground,
        None => vehicle.estimate.alt.is_none_or(|alt| alt < STANDING_BELOW_M),
    }
}

/// Returns the mode in force.
pub(super) fn mode(vehicle: &Snapshot) -> FlightMode {
    let has = |mode| vehicle.craft.is_active(mode);
    let nav = vehicle.nav.as_ref().filter(|nav| nav.engaged);
    match nav {
        Some(nav) if nav.state == NavState::Landing => FlightMode::Landing,
        Some(nav) if nav.source == PlanSource::Rth => FlightMode::ReturnHome,
        Some(_) if has(Mode::Failsafe) && !has(Mode::Autopilot) => FlightMode::Failsafe,
        Some(_) => FlightMode::Autopilot,
        None if has(Mode::GpsRescue) => FlightMode::ReturnHome,
        None if has(Mode::Failsafe) => FlightMode::Failsafe,
        None if has(Mode::PosHold) => FlightMode::PosHold,
        None if has(Mode::AltHold) => FlightMode::AltHold,
        None if has(Mode::Angle) => FlightMode::Angle,
        None if has(Mode::Horizon) => FlightMode::Horizon,
        None => FlightMode::Acro,
    }
}

/// Returns the state of the craft. `home_amsl_m` is the altitude of home above sea level, m.
pub(super) fn craft_state(
    view: &SessionView,
    home_amsl_m: Option<f64>,
    unix: Option<Duration>,
) -> CraftState {
    let vehicle = &*view.vehicle;
    let (craft, estimate) = (&vehicle.craft, &vehicle.estimate);
    let is_armed = craft.is_armed();
    let gps = craft.gps.filter(|_| craft.gps_fix.is_some());
    let amsl = |alt: Option<f64>| Some(alt? + home_amsl_m?);
    let position = gps.map(|gps| GeoPosition {
        lat_deg: gps.position.lat_deg(),
        lon_deg: gps.position.lon_deg(),
        alt_amsl: amsl(estimate.alt).unwrap_or(gps.alt_amsl_m),
    });
    let velocity_ned = velocity_ned(vehicle);
    let sensors =
        sensor::GYRO | sensor::ACCELEROMETER | sensor::BAROMETER | sensor::GPS | sensor::RC_RECEIVER;
    let broken = [(sensor::GPS, !craft.has_fix()), (sensor::RC_RECEIVER, craft.rc_link == Some(false))];
    let broken = broken.iter().filter(|(_, is_broken)| *is_broken).fold(0, |all, (bit, _)| all | bit);
    CraftState {
        unix_time: unix,
        mode: Some(mode(vehicle)),
        is_armed,
        is_ready_to_arm: craft.arming_blocked_by.map(|_| craft.arming_flags().causes().is_empty()),
        is_failsafe: craft.failsafe_stage.is_some_and(|stage| stage > 0),
        landed: Some(landed(vehicle)),
        sensors_present: sensors,
        sensors_healthy: sensors & !broken,
        load: None,
        attitude: attitude(vehicle),
        rates: None,
        position,
        altitude_above_home: estimate.alt,
        local_ned: local_ned(vehicle),
        velocity_ned,
        airspeed: None,
        throttle: craft.throttle_us.map(|us| ((us - 1000.0) / 1000.0).clamp(0.0, 1.0)),
        home: home(vehicle, home_amsl_m),
        gps: gps.map(|gps| GpsState {
            fix: if craft.has_fix() { GpsFix::Fix3d } else { GpsFix::NoFix },
            position: GeoPosition {
                lat_deg: gps.position.lat_deg(),
                lon_deg: gps.position.lon_deg(),
                alt_amsl: gps.alt_amsl_m,
            },
            hdop: craft.hdop,
            vdop: None,
            speed: Some(gps.ground_speed_mps),
            course: velocity_ned.map(|[north, east, _]| east.atan2(north)),
            satellites: craft.sats,
        }),
        battery: battery(vehicle),
        rc: craft.channels.map(|channels| {
            let mut channels_us = [0; 18];
            channels_us.iter_mut().zip(channels).for_each(|(to, us)| *to = us);
            RcState { channels_us, count: channels.len().min(18) as u8, rssi: None }
        }),
        outputs_us: craft.motors.map(|motors| {
            let mut outputs = [0; 16];
            outputs
                .iter_mut()
                .zip(motors)
                .for_each(|(to, share)| *to = (1000.0 + 1000.0 * share).round() as u16);
            outputs
        }),
        navigation: navigation(vehicle),
        mission: progress(vehicle),
        wind_ned: vehicle.truth.as_ref().and_then(|truth| truth.wind_ne).map(|wind| [wind.x, wind.y, 0.0]),
        pressure_pa: None,
        temperature_c: None,
    }
}

/// Returns home, with its altitude above sea level: where the craft was armed, or where it stands before.
pub(super) fn home(vehicle: &Snapshot, home_amsl_m: Option<f64>) -> Option<GeoPosition> {
    let craft = &vehicle.craft;
    let here = craft.gps.filter(|_| craft.has_fix() && !craft.is_armed()).map(|gps| gps.position);
    let home = craft.home.or(here)?;
    Some(GeoPosition { lat_deg: home.lat_deg(), lon_deg: home.lon_deg(), alt_amsl: home_amsl_m? })
}

fn landed(vehicle: &Snapshot) -> LandedState {
    let nav = vehicle.nav.as_ref().filter(|nav| nav.engaged);
    match nav {
        _ if is_on_ground(vehicle) => LandedState::OnGround,
        Some(nav) if nav.state == NavState::Landing => LandedState::Landing,
        Some(nav) if nav.climbing => LandedState::TakingOff,
        Some(_) | None => LandedState::InAir,
    }
}

fn attitude(vehicle: &Snapshot) -> Option<[f64; 3]> {
    let estimate = &vehicle.estimate;
    Some([estimate.roll_deg?, estimate.pitch_deg?, estimate.heading_deg?].map(f64::to_radians))
}

/// Returns the position relative to home. Estimates are relative to the position at boot, which is home.
fn local_ned(vehicle: &Snapshot) -> Option<[f64; 3]> {
    let estimate = &vehicle.estimate;
    Some([estimate.n?, estimate.e?, -estimate.alt?])
}

/// Returns the velocity. A firmware reports its ground speed only: its direction is the true one, or that of the nose.
fn velocity_ned(vehicle: &Snapshot) -> Option<[f64; 3]> {
    let estimate = &vehicle.estimate;
    let speed = estimate.ground_speed_mps?;
    let course = match &vehicle.truth {
        Some(truth) => truth.ve.atan2(truth.vn),
        None => estimate.heading_deg?.to_radians(),
    };
    Some([speed * course.cos(), speed * course.sin(), -estimate.climb_mps.unwrap_or(0.0)])
}

fn battery(vehicle: &Snapshot) -> Option<BatteryState> {
    let craft = &vehicle.craft;
    let voltage = craft.battery_v?;
    let cells = craft.battery_cells.filter(|cells| *cells > 0);
    let by_capacity = vehicle
        .truth
        .as_ref()
        .and_then(|truth| truth.battery)
        .map(|battery| 1.0 - battery.drawn_mah / battery.capacity_mah.max(1.0));
    let by_voltage =
        cells.map(|cells| (voltage / f64::from(cells) - EMPTY_CELL_V) / (FULL_CELL_V - EMPTY_CELL_V));
    Some(BatteryState {
        voltage,
        current: craft.battery_a,
        drawn_mah: craft.battery_mah,
        remaining: by_capacity.or(by_voltage).map(|share| share.clamp(0.0, 1.0)),
    })
}

fn navigation(vehicle: &Snapshot) -> Option<NavigationState> {
    let nav = vehicle.nav.as_ref().filter(|nav| nav.engaged)?;
    let altitude_error = nav.target_alt_m.zip(vehicle.estimate.alt).map_or(0.0, |(target, alt)| target - alt);
    Some(NavigationState {
        distance: nav.distance_m?,
        bearing: nav.bearing_rad.unwrap_or(0.0),
        cross_track: nav.xte_m.unwrap_or(0.0),
        altitude_error,
    })
}

/// Returns the progress of the mission. The items of a plan are counted by `missions`.
fn progress(vehicle: &Snapshot) -> MissionProgress {
    let has_plan = vehicle.stored_plan.as_ref().is_some_and(|plan| !plan.waypoints.is_empty());
    let state = match &vehicle.nav {
        _ if !has_plan => MissionState::NoMission,
        Some(nav) if nav.state == NavState::Complete => MissionState::Complete,
        Some(nav) if nav.engaged && nav.held_by_command => MissionState::Paused,
        Some(nav) if nav.engaged && nav.source == PlanSource::Stored => MissionState::Active,
        Some(_) | None => MissionState::NotStarted,
    };
    let current = vehicle.nav.as_ref().filter(|nav| nav.engaged).map_or(0, |nav| u16::from(nav.wp));
    MissionProgress { current: has_plan.then_some(current), state }
}
