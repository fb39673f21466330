//! The station monitor: detects a craft that is away from the place it should keep and does not come closer.

use nalgebra::Vector2;

use super::hold::Pattern;
use super::leg::Leg;
use super::observed::Observed;
use crate::autopilot::control::FlightControllers;
use crate::telemetry::{CannotHold, HoldLimit, NavEvent, NavState};

/// The number of hold radii that a craft may be away beyond its pattern.
const HOLD_RADII: f64 = 2.0;
/// The height that it may be off, m.
const VERTICAL_M: f64 = 3.0;
/// The length of the two periods that are compared to see if the craft comes closer, s.
const PERIOD_S: f64 = 5.0;
/// The decrease of the mean excess from one period to the next that counts as coming closer, m.
const CLOSER_M: f64 = 0.5;
/// The throttle is at its limit when it is this close to its maximum, µs.
const THROTTLE_BINDS_US: f64 = 1.0;

/// The values of the station in one update.
#[derive(Debug, Clone, Copy)]
pub(super) struct Station {
    /// Horizontal distance from the target, m.
    distance_m: f64,
    /// Permitted distance from the target, m.
    radius_m: f64,
    /// Height above the setpoint, m.
    vertical_m: f64,
    /// `true` if the tilt demand is at its limit.
    tilt_binds: bool,
    /// `true` if the throttle demand is at its limit.
    throttle_binds: bool,
    /// `true` if the battery is at its warning voltage or below.
    battery_low: bool,
}

impl Station {
    /// Returns the station that is kept in a state, if one is. `seen` is the basis of the demands of this update.
    pub(super) fn of(
        state: NavState,
        target_ne: Vector2<f64>,
        leg: &Leg,
        seen: &Observed,
        controllers: &FlightControllers,
    ) -> Option<Self> {
        let (now, params) = (seen.now, seen.params);
        let pattern_m = match state {
            NavState::Holding
            | NavState::Landing
            | NavState::Complete
            | NavState::Orbiting
            | NavState::Figure8 => Pattern::of(state).map_or(0.0, |pattern| pattern.radius_m(params)),
            NavState::Idle | NavState::Approaching | NavState::Arrived => return None,
        };
        if seen.stick_override || controllers.land.stands() {
            return None;
        }
        let mut setpoint_m = controllers.altitude.setpoint_m();
        if state == NavState::Landing {
            // The path of a landing continues below the ground.
            setpoint_m = setpoint_m.max(leg.altitude_m.min(0.0));
        }
        Some(Self {
            distance_m: (target_ne - now.pos_ne).norm(),
            radius_m: pattern_m + HOLD_RADII * params.hold_radius_m(),
            vertical_m: now.alt_m - setpoint_m,
            tilt_binds: controllers.position.is_saturated(),
            throttle_binds: controllers.altitude.throttle_us()
                >= f64::from(params.throttle_max) - THROTTLE_BINDS_US,
            battery_low: now.battery_low,
        })
    }

    fn is_off(&self) -> bool {
        self.distance_m > self.radius_m || self.vertical_m.abs() > VERTICAL_M
    }

    /// Returns the distance by which the craft is out of its bounds, m.
    fn excess_m(&self) -> f64 {
        (self.distance_m - self.radius_m).max(0.0) + (self.vertical_m.abs() - VERTICAL_M).max(0.0)
    }
}

/// Integrals over a period out of bounds.
#[derive(Debug, Clone, Copy, Default)]
struct Period {
    time_s: f64,
    excess_ms: f64,
    tilt_s: f64,
    throttle_s: f64,
}

impl Period {
    fn add(&mut self, station: &Station, dt: f64) {
        self.time_s += dt;
        self.excess_ms += station.excess_m() * dt;
        self.tilt_s += if station.tilt_binds { dt } else { 0.0 };
        self.throttle_s += if station.throttle_binds { dt } else { 0.0 };
    }

    fn mean_excess_m(&self) -> f64 {
        self.excess_ms / self.time_s.max(f64::MIN_POSITIVE)
    }

    /// Returns the demand that was at its limit for most of the period. For a craft that is too low the throttle
    /// counts first.
    fn limit(&self, station: &Station) -> HoldLimit {
        let most = |time_s: f64| time_s > 0.5 * self.time_s;
        let too_low = station.vertical_m < -VERTICAL_M;
        let throttle = if station.battery_low { HoldLimit::Battery } else { HoldLimit::Throttle };
        match (most(self.tilt_s), most(self.throttle_s)) {
            (_, true) if too_low => throttle,
            (true, _) => HoldLimit::Tilt,
            (false, true) => throttle,
            (false, false) => HoldLimit::None,
        }
    }
}

/// The monitor, with its state since the craft left its station.
#[derive(Debug, Clone, Default)]
pub(super) struct StationMonitor {
    period: Period,
    /// Mean excess of the previous period, m.
    before_m: Option<f64>,
    pub reported: Option<CannotHold>,
}

impl StationMonitor {
    /// Takes an update, with the station unless none is kept or something else flies. Returns the event to report
    /// now.
    pub(super) fn update(&mut self, station: Option<&Station>, dt: f64) -> Option<NavEvent> {
        let Some(station) = station else {
            let reported = std::mem::take(self).reported;
            return reported.map(|deviation| NavEvent::CannotHold { on: false, deviation });
        };
        let deviation =
            |limit| CannotHold { distance_m: station.distance_m, vertical_m: station.vertical_m, limit };
        if !station.is_off() {
            let limit = self.reported.map(|reported| reported.limit);
            *self = Self::default();
            return limit.map(|limit| NavEvent::CannotHold { on: false, deviation: deviation(limit) });
        }
        if let Some(reported) = &mut self.reported {
            *reported = deviation(reported.limit);
        }
        self.period.add(station, dt);
        if self.period.time_s < PERIOD_S {
            return None;
        }
        let period = std::mem::take(&mut self.period);
        let mean_m = period.mean_excess_m();
        if let Some(reported) = &mut self.reported {
            reported.limit = period.limit(station);
            return None;
        }
        let before_m = self.before_m.replace(mean_m)?;
        if mean_m < before_m - CLOSER_M {
            return None;
        }
        let deviation = deviation(period.limit(station));
        self.reported = Some(deviation);
        Some(NavEvent::CannotHold { on: true, deviation })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_excess_is_the_sum_of_both_distances_beyond_the_bounds() {
        let station = |distance_m, vertical_m| Station {
            distance_m,
            radius_m: 20.0,
            vertical_m,
            tilt_binds: false,
            throttle_binds: false,
            battery_low: false,
        };
        for (distance_m, vertical_m, excess_m) in
            [(19.0, 2.0, 0.0), (25.0, 0.0, 5.0), (0.0, -7.0, 4.0), (25.0, 7.0, 9.0)]
        {
            assert_eq!(
                station(distance_m, vertical_m).excess_m(),
                excess_m,
                "{distance_m} m, {vertical_m} m"
            );
        }
    }

    /// Returns the updates until the report about a craft whose distance beyond its bounds is `excess_m` at a time,
    /// s. Half a second passes between two updates.
    fn reported_after_s(excess_m: impl Fn(f64) -> f64) -> Option<f64> {
        let mut monitor = StationMonitor::default();
        (1..=200).map(|step| 0.5 * f64::from(step)).find(|&seconds| {
            let station = Station {
                distance_m: 20.0 + excess_m(seconds),
                radius_m: 20.0,
                vertical_m: 0.0,
                tilt_binds: true,
                throttle_binds: false,
                battery_low: false,
            };
            monitor.update(Some(&station), 0.5).is_some()
        })
    }

    #[test]
    fn a_craft_that_stays_away_is_reported_after_two_periods_and_one_that_returns_is_not() {
        assert_eq!(reported_after_s(|_| 30.0), Some(10.0));
        assert_eq!(reported_after_s(|seconds| 5.0 + seconds), Some(10.0));
        assert_eq!(reported_after_s(|seconds| 60.0 - 0.5 * seconds), None);
        // It comes closer for 20 s, then no longer.
        let stays = reported_after_s(|seconds| 60.0 - 2.0 * seconds.min(20.0));
        assert!(stays.is_some_and(|seconds| (25.0..=35.0).contains(&seconds)), "{stays:?}");
    }
}
