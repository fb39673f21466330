//! The path down of a landing.

use super::rescue::Rescue;
use crate::autopilot::control::AltitudeTarget;
use crate::autopilot::guidance::landing_setpoint_m;
use crate::autopilot::io::NavInputs;
use crate::autopilot::land_detector::{DescentFacts, LandDetector};
use crate::autopilot::params::Params;
use crate::signals::SimTime;

/// The altitude below which a rescue sinks at the landing rate, m.
const SLOW_LANDING_M: f64 = 4.0;
/// The rate at which the setpoint of a landing comes down to a craft that stopped below it, m/s.
const CATCH_UP_MPS: f64 = 2.0;
/// A LAND is approached vertically first if the craft reaches it this far above its altitude, m. The approach ends
/// this near to it, m.
const FAR_ABOVE_M: f64 = 2.0;
const NEAR_M: f64 = 0.5;
/// The minimum height above `ap_landing_altitude_m` at which the vertical approach ends, m.
const CLEARANCE_M: f64 = 5.0;

#[derive(Debug, Clone, Copy, PartialEq)]
struct Path {
    began: SimTime,
    /// Start of the part at the current rate.
    rate_since: SimTime,
    rate_start_m: f64,
    rate_mps: f64,
}

impl Path {
    fn begin(now: &NavInputs, rate_mps: f64) -> Self {
        Self { began: now.time, rate_since: now.time, rate_start_m: now.alt_m, rate_mps }
    }

    fn setpoint_m(&self, now: &NavInputs, params: &Params) -> f64 {
        let elapsed_s = now.time.seconds_since(self.rate_since);
        let landing_altitude_m = f64::from(params.landing_altitude_m);
        landing_setpoint_m(self.rate_start_m, self.rate_mps, elapsed_s, now.alt_m, landing_altitude_m)
    }
}

/// The part of a landing that is flown.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
enum Phase {
    #[default]
    Pending,
    /// Vertical descent to this altitude (m), at the limit of the altitude controller.
    Approach(f64),
    Profile(Path),
}

/// The landing, from the first update in LANDING on.
#[derive(Debug, Clone, Default)]
pub(super) struct Descent(Phase);

impl Descent {
    /// Returns `true` if the profile is being flown.
    pub(super) fn has_begun(&self) -> bool {
        matches!(self.0, Phase::Profile(_))
    }

    /// Advances the landing. Returns the time since its profile began, s. `waypoint_alt_m` is the altitude of the
    /// LAND. A rescue sinks at its own rate down to the last metres, and there no faster than a landing.
    pub(super) fn advance(
        &mut self,
        now: &NavInputs,
        params: &Params,
        waypoint_alt_m: f64,
        rescue: Option<Rescue>,
        land: &mut LandDetector,
    ) -> f64 {
        let slow = params.descent_rate_mps();
        let sinking = match rescue {
            Some(rescue) if now.alt_m > SLOW_LANDING_M => rescue.descend_mps,
            Some(rescue) => rescue.descend_mps.min(slow),
            None => slow,
        };
        if self.0 == Phase::Pending {
            let floor_m = waypoint_alt_m.max(f64::from(params.landing_altitude_m) + CLEARANCE_M);
            self.0 = Phase::Approach(if now.alt_m > floor_m + FAR_ABOVE_M { floor_m } else { f64::INFINITY });
        }
        if let Phase::Approach(floor_m) = self.0
            && now.alt_m <= floor_m + NEAR_M
        {
            land.begin_descent(now.alt_m, now.climb_mps);
            self.0 = Phase::Profile(Path::begin(now, sinking));
        }
        let Phase::Profile(path) = &mut self.0 else { return 0.0 };
        let rate = if land.is_too_fast(now) { 0.0 } else { sinking };
        #[expect(clippy::float_cmp, reason = "the rate is copied, not computed")]
        if path.rate_mps != rate {
            path.rate_start_m = path.setpoint_m(now, params);
            path.rate_since = now.time;
            path.rate_mps = rate;
        }
        now.time.seconds_since(path.began)
    }

    /// Returns the altitude target of this update, for a controller with the setpoint `setpoint_m` and the throttle
    /// `throttle_us`.
    ///
    /// A low craft that does not sink although it should is on the ground, or the air carries it. Below the landing
    /// altitude it does not climb back to a setpoint above it but continues down from its present altitude.
    pub(super) fn target(
        &mut self,
        now: &NavInputs,
        params: &Params,
        (setpoint_m, throttle_us): (f64, f64),
        land: &mut LandDetector,
    ) -> Option<AltitudeTarget> {
        let path = match &mut self.0 {
            Phase::Pending => return None,
            Phase::Approach(floor_m) => return Some(AltitudeTarget::Altitude(*floor_m)),
            Phase::Profile(path) => path,
        };
        let facts = DescentFacts::new(now, params, (setpoint_m, throttle_us), path.rate_mps);
        land.descend(&facts, now.time, now.dt);
        let is_down = path.rate_mps > 0.0 && facts.is_low;
        if is_down && land.climb_mps() > -facts.still_mps() && now.alt_m < setpoint_m {
            path.rate_start_m -= CATCH_UP_MPS * now.dt;
        }
        Some(AltitudeTarget::Landing { setpoint_m: path.setpoint_m(now, params), rate_mps: -path.rate_mps })
    }
}
