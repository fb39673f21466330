//! The touchdown detector: first contact, settled touchdown, crash.

use nalgebra::Vector3;

use crate::signals::SimTime;

use super::body::BodyState;
use super::event::WorldEventKind;
use super::ground::GroundContact;
use crate::telemetry::CrashCause;

/// A touch ends a flight after this time in the air, s, or this much clearance, m.
const FLIGHT_S: f64 = 0.5;
const FLIGHT_CLEARANCE_M: f64 = 0.05;
/// Load on all legs for this time, s, below this speed, m/s, is a touchdown.
const SETTLED_S: f64 = 0.2;
const SETTLED_MPS: f64 = 0.2;
/// A contact faster than this, into the ground or along it, is a crash, m/s.
const CRASH_MPS: f64 = 3.0;

/// The state of the detector.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Phase {
    /// On the ground since the start or the last touchdown.
    Standing,
    /// No leg has touched since `since`.
    Airborne { since: SimTime, cleared: bool },
    /// Touched, not settled. `loaded` is the time at which all legs began to carry load.
    Settling { impact_mps: f64, peak_mps2: f64, loaded: Option<SimTime> },
}

/// Detects contact and touchdown from the load on the legs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct TouchdownDetector {
    phase: Phase,
}

impl TouchdownDetector {
    /// The detector of a craft on the ground.
    pub(super) const STANDING: Self = Self { phase: Phase::Standing };

    /// Takes one step: the present contact, the state before the step (whose velocity the ground has not changed yet)
    /// and after it, and the present specific force, m/s².
    pub(super) fn update(
        &mut self,
        now: SimTime,
        contact: GroundContact,
        before: &BodyState,
        after: &BodyState,
        force: &Vector3<f64>,
    ) -> Option<WorldEventKind> {
        match self.phase {
            Phase::Standing => {
                if !contact.any_leg {
                    self.phase = Phase::Airborne { since: now, cleared: false };
                }
                None
            }
            Phase::Airborne { since, cleared } if !contact.any_leg && !contact.hull => {
                let cleared = cleared
                    || contact.clearance_m > FLIGHT_CLEARANCE_M
                    || now.seconds_since(since) >= FLIGHT_S;
                self.phase = Phase::Airborne { since, cleared };
                None
            }
            Phase::Airborne { cleared: false, .. } => {
                self.phase = Phase::Standing;
                None
            }
            Phase::Airborne { .. } => {
                let impact_mps = (-before.vel_enu.dot(contact.plane.normal())).max(0.0);
                self.phase = Phase::Settling { impact_mps, peak_mps2: force.norm(), loaded: None };
                Some(WorldEventKind::Contact { impact_mps })
            }
            Phase::Settling { impact_mps, peak_mps2, loaded } => {
                let peak_mps2 = peak_mps2.max(force.norm());
                let settled = contact.all_legs && after.vel_enu.norm() < SETTLED_MPS;
                let loaded = settled.then(|| loaded.unwrap_or(now));
                if loaded.is_some_and(|since| now.seconds_since(since) >= SETTLED_S) {
                    self.phase = Phase::Standing;
                    return Some(WorldEventKind::Touchdown { impact_mps, peak_mps2 });
                }
                self.phase = if !contact.any_leg && contact.clearance_m > FLIGHT_CLEARANCE_M {
                    Phase::Airborne { since: now, cleared: true }
                } else {
                    Phase::Settling { impact_mps, peak_mps2, loaded }
                };
                None
            }
        }
    }

    /// Forgets the flight, since the craft was moved to another place.
    pub(super) fn set_airborne(&mut self, now: SimTime) {
        self.phase = Phase::Airborne { since: now, cleared: true };
    }
}

/// Returns the cause of a crash if this ground contact is one. `new_contact` is `true` if this step is the first
/// contact.
pub(super) fn crash_cause(
    contact: GroundContact,
    new_contact: bool,
    before: &BodyState,
) -> Option<CrashCause> {
    let down = -before.vel_enu.dot(contact.plane.normal());
    if new_contact && down > CRASH_MPS {
        return Some(CrashCause::HardLanding(down));
    }
    let sideways = contact.plane.along(&before.vel_enu).norm();
    if new_contact && sideways > CRASH_MPS {
        return Some(CrashCause::SidewaysLanding(sideways));
    }
    contact.hull.then_some(CrashCause::HullContact)
}
