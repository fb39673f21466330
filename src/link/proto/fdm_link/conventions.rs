//! Detects two conventions of a simulator from its packets: whether gravity is in the acceleration, and
//! whether positions are mirrored.

use nalgebra::{Vector2, Vector3};

use super::FdmNotice;
use crate::geo::LocalFrame;
use crate::link::conventions::Dialect;
use crate::link::proto::fdm::{Gravity, Packet, State, mirrored};

/// The limit of every body rate at rest, rad/s.
const REST_RATE: f64 = 0.05;
/// The time for which the craft must rest, µs.
const REST_US: u64 = 200_000;
/// The mean acceleration at rest below which gravity is missing, m/s².
const MISSING_BELOW: f64 = 2.0;
/// The mean acceleration at rest when gravity is included, m/s².
const INCLUDED: std::ops::RangeInclusive<f64> = 9.0..=10.6;

/// Detects whether the acceleration contains gravity.
#[derive(Debug, Clone, Default)]
pub(super) struct GravityTest {
    found: Option<Gravity>,
    warned: bool,
    rested_us: u64,
    sum: f64,
    count: u32,
}

impl GravityTest {
    /// Returns the detected treatment of gravity, or else the usual one of the dialect.
    pub(super) fn gravity(&self, dialect: Dialect) -> Gravity {
        self.found.unwrap_or(dialect.usual_gravity())
    }

    /// Evaluates one packet.
    pub(super) fn watch(&mut self, packet: &Packet, dialect: Dialect, elapsed_us: u64) -> Option<FdmNotice> {
        if self.found.is_some() || self.warned {
            return None;
        }
        let [_, r1, r2, r3, a1, a2, a3, ..] = packet.fields;
        if Vector3::new(r1, r2, r3).amax() >= REST_RATE {
            *self = Self::default();
            return None;
        }
        self.rested_us += elapsed_us;
        self.sum += Vector3::new(a1, a2, a3).norm();
        self.count += 1;
        if self.rested_us < REST_US {
            return None;
        }
        let mean = self.sum / f64::from(self.count);
        let found = if mean < MISSING_BELOW {
            Gravity::Missing
        } else if INCLUDED.contains(&mean) {
            Gravity::Included
        } else {
            self.warned = true;
            return Some(FdmNotice::GravityUnclear);
        };
        self.found = Some(found);
        match (found, dialect.usual_gravity()) {
            (Gravity::Missing, Gravity::Included) => Some(FdmNotice::GravityMissing),
            (Gravity::Included, Gravity::Missing) => Some(FdmNotice::GravityIncluded),
            _ => None,
        }
    }
}

/// The slowest motion from which positions can be judged, m/s.
const MOVING: f64 = 1.0;
/// The time for which the craft must move, µs.
const MOVING_US: u64 = 2_000_000;
/// The cosine between displacement and velocity above which they agree. Below its negative they are opposed.
const CLEAR: f64 = 0.8;

/// The current motion.
#[derive(Debug, Clone, Copy)]
struct Leg {
    from: (f64, f64),
    moved_us: u64,
    by_velocity: Vector2<f64>,
}

/// Undoes the mirroring of positions, and detects whether there is any.
#[derive(Debug, Clone, Default)]
pub(super) struct MirrorTest {
    centre: Option<(f64, f64)>,
    leg: Option<Leg>,
    refuted: bool,
    confirmed: bool,
}

impl MirrorTest {
    /// Returns `true` if the motion showed that positions are not mirrored.
    pub(super) fn is_refuted(&self) -> bool {
        self.refuted
    }

    /// Returns the latitude and longitude (degrees) of a state; `None` if it has none. The first position is
    /// the centre of the mirror.
    pub(super) fn place(&mut self, state: &State, mirrors: bool) -> Option<(f64, f64)> {
        let wire = (state.lat_deg, state.lon_deg);
        if !is_on_globe(wire) {
            return None;
        }
        let centre = *self.centre.get_or_insert(wire);
        if !mirrors {
            return Some(wire);
        }
        let lon = mirrored(centre.1, wire.1);
        let lon = if lon.abs() > 180.0 { lon - 360.0_f64.copysign(lon) } else { lon };
        let place = (mirrored(centre.0, wire.0), lon);
        is_on_globe(place).then_some(place)
    }

    /// Compares a motion of the unmirrored positions with the velocity.
    pub(super) fn watch(
        &mut self,
        place: Option<(f64, f64)>,
        vel_enu: Vector3<f64>,
        elapsed_us: u64,
    ) -> Option<FdmNotice> {
        if self.confirmed || self.refuted {
            return None;
        }
        let velocity = vel_enu.xy();
        let (Some(place), true) = (place, velocity.norm() > MOVING) else {
            self.leg = None;
            return None;
        };
        let leg = self.leg.get_or_insert(Leg { from: place, moved_us: 0, by_velocity: Vector2::zeros() });
        leg.moved_us += elapsed_us;
        leg.by_velocity += velocity * (elapsed_us as f64 * 1e-6);
        if leg.moved_us < MOVING_US {
            return None;
        }
        let moved = LocalFrame::new(leg.from.0, leg.from.1, 0.0).to_enu(place.0, place.1, 0.0).xy();
        let cosine =
            moved.dot(&leg.by_velocity) / (moved.norm() * leg.by_velocity.norm()).max(f64::MIN_POSITIVE);
        self.leg = None;
        self.confirmed = cosine > CLEAR;
        self.refuted = cosine < -CLEAR;
        self.refuted.then_some(FdmNotice::NotMirrored)
    }
}

fn is_on_globe((lat_deg, lon_deg): (f64, f64)) -> bool {
    lat_deg.abs() <= 90.0 && lon_deg.abs() <= 180.0
}
