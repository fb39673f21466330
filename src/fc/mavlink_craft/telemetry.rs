//! The reports for the vehicle, from the known state of a craft.

use std::time::Duration;

use super::exchange::Exchange;
use crate::geo::{LatLon, LocalFrame, distance_bearing};
use crate::math;
use crate::mavlink::state::GeoPosition;
use crate::mavlink::station::{CraftReport, Heard, StationProtocol};
use crate::mavlink::value::{GpsFix, MissionState};
use crate::plan::AltitudeReference;
use crate::signals::RC_CHANNELS;
use crate::telemetry::snapshot::{CraftView, EstimateView, GpsView};
use crate::telemetry::{NavState, NavTelemetry};
use crate::vehicle::RemoteTelemetry;

/// The age after which a value that changes in flight is unknown.
const FRESH: Duration = Duration::from_secs(5);
/// The modes of ArduPilot and INAV, PX4 and Betaflight that fly the mission.
const MISSION_MODES: [&str; 3] = ["AUTO", "Mission", "Autopilot"];
/// The throttle channel at rest and its range, µs.
const IDLE_US: f64 = 1000.0;

/// Returns the home of the craft, or its position before home is known.
pub(super) fn home(station: &StationProtocol) -> Option<GeoPosition> {
    let report = station.report();
    report.home.or(report.position).map(|heard| heard.value)
}

/// Returns the reports. Positions are relative to the origin of `frame`.
pub(super) fn of_report(
    station: &StationProtocol,
    exchange: &Exchange,
    frame: Option<&LocalFrame>,
    now: Duration,
) -> RemoteTelemetry {
    let stored_plan = exchange.plan().cloned();
    let shared = RemoteTelemetry {
        altitude_reference: AltitudeReference::Home,
        stored_plan,
        ..RemoteTelemetry::default()
    };
    if !station.is_connected() {
        return shared;
    }
    let report = station.report();
    let presence = report.presence.as_ref().map(|heard| &heard.value);
    let is_armed = presence.map(|presence| presence.is_armed);
    RemoteTelemetry {
        estimate: estimate(report, frame, now),
        craft: CraftView {
            armed: is_armed,
            mode_name: presence.map(|presence| presence.mode.clone()),
            ..craft(report, now)
        },
        nav: Some(nav(station, exchange, is_armed == Some(true), now)),
        ..shared
    }
}

/// Returns a value that is not too old.
fn fresh<T: Copy>(heard: Option<Heard<T>>, now: Duration) -> Option<T> {
    heard.filter(|heard| now.saturating_sub(heard.at) <= FRESH).map(|heard| heard.value)
}

fn estimate(report: &CraftReport, frame: Option<&LocalFrame>, now: Duration) -> EstimateView {
    let position = fresh(report.position, now);
    let offset = position
        .zip(frame)
        .map(|(position, frame)| frame.to_enu(position.lat_deg, position.lon_deg, position.alt_amsl));
    let attitude = fresh(report.attitude, now).map(|angles| angles.map(f64::to_degrees));
    let velocity = fresh(report.velocity_ned, now);
    let heading = fresh(report.heading, now).map(f64::to_degrees);
    EstimateView {
        n: offset.map(|offset| offset.y),
        e: offset.map(|offset| offset.x),
        // Above home, which is the origin unless the craft was first seen in flight.
        alt: fresh(report.altitude_above_home, now).or_else(|| offset.map(|offset| offset.z)),
        ground_speed_mps: fresh(report.ground_speed, now)
            .or_else(|| velocity.map(|[n, e, _]| math::hypot(n, e))),
        climb_mps: fresh(report.climb, now).or_else(|| velocity.map(|[_, _, down]| -down)),
        roll_deg: attitude.map(|[roll, ..]| roll),
        pitch_deg: attitude.map(|[_, pitch, _]| pitch),
        heading_deg: attitude.map(|[.., yaw]| yaw).or(heading).map(|heading| heading.rem_euclid(360.0)),
        ..EstimateView::default()
    }
}

fn craft(report: &CraftReport, now: Duration) -> CraftView {
    let gps = fresh(report.gps, now);
    let battery = fresh(report.battery, now);
    let rc = fresh(report.rc, now).filter(|rc| rc.count > 0);
    let home = report.home.map(|heard| heard.value);
    CraftView {
        gps_fix: gps.map(|gps| gps.fix >= GpsFix::Fix3d),
        gps: gps.filter(|gps| gps.fix > GpsFix::NoFix).map(|gps| GpsView {
            position: LatLon::from_degrees(gps.position.lat_deg, gps.position.lon_deg),
            alt_amsl_m: gps.position.alt_amsl,
            ground_speed_mps: gps.speed.unwrap_or_default(),
        }),
        sats: gps.and_then(|gps| gps.satellites),
        hdop: gps.and_then(|gps| gps.hdop),
        home: home.map(|home| LatLon::from_degrees(home.lat_deg, home.lon_deg)),
        battery_v: battery.map(|battery| battery.voltage),
        battery_a: battery.and_then(|battery| battery.current),
        battery_mah: battery.and_then(|battery| battery.drawn_mah),
        throttle_us: fresh(report.throttle, now).map(|throttle| IDLE_US + throttle * IDLE_US),
        channels: rc.map(|rc| std::array::from_fn::<u16, RC_CHANNELS, _>(|at| rc.channels_us[at])),
        ..CraftView::default()
    }
}

/// Returns the progress of the mission as the state of a navigator. The autopilots report an item and its state, and the way to
/// it.
fn nav(station: &StationProtocol, exchange: &Exchange, is_armed: bool, now: Duration) -> NavTelemetry {
    let report = station.report();
    let at_home = NavTelemetry {
        home_distance_m: home_distance_m(report, now),
        speed_mps: fresh(report.ground_speed, now).unwrap_or_default(),
        ..NavTelemetry::default()
    };
    let (Some(current), Some(plan)) = (fresh(report.mission, now), exchange.plan()) else { return at_home };
    let item = current.seq.checked_sub(station.first_item());
    let wp = item.and_then(|item| exchange.mission().waypoint_of_item(item)).unwrap_or_default();
    let presence = report.presence.as_ref();
    let is_mission = |mode: &str| MISSION_MODES.iter().any(|name| mode.eq_ignore_ascii_case(name));
    let flies = is_armed && presence.is_some_and(|presence| is_mission(&presence.value.mode));
    let state = match current.state {
        MissionState::Complete => NavState::Complete,
        MissionState::Paused if flies => NavState::Holding,
        _ if flies => NavState::Approaching,
        _ => NavState::Idle,
    };
    let way = fresh(report.navigation, now).filter(|_| state == NavState::Approaching);
    NavTelemetry {
        state,
        engaged: flies && state != NavState::Complete,
        wp,
        next_wp: wp,
        count: u8::try_from(plan.waypoints.len()).unwrap_or(u8::MAX),
        kind: plan.waypoints.get(usize::from(wp)).map(|waypoint| waypoint.kind),
        distance_m: way.map(|way| way.distance),
        bearing_rad: way.map(|way| way.bearing),
        xte_m: way.map(|way| way.cross_track),
        ..at_home
    }
}

/// Returns the horizontal distance from home, m.
fn home_distance_m(report: &CraftReport, now: Duration) -> Option<f64> {
    let (home, position) = (report.home?.value, fresh(report.position, now)?);
    let [from, to] = [home, position].map(|place| LatLon::from_degrees(place.lat_deg, place.lon_deg));
    Some(distance_bearing(from, to).0)
}
