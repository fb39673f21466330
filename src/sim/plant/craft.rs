//! The moving craft: its state, and what the next step takes from the steps before.

use nalgebra::{Matrix3, Vector3};

use crate::sim::airframe::ROTORS;
use crate::sim::body::{BodyState, Loads};
use crate::sim::ground::{ContactAnchors, NO_ANCHORS};

use super::rotors::RotorSums;

/// The number of earlier instants that a step of a craft in the air uses.
pub(super) const PAST: usize = 3;
/// The places in the ring of earlier instants, a power of two.
const RING: usize = 4;

/// A craft in motion. A clone continues identically.
#[derive(Debug, Clone)]
pub struct Craft {
    pub(super) body: BodyState,
    pub(super) rotors: [f64; ROTORS],
    /// The places where friction holds the contact points.
    pub(in crate::sim) anchors: ContactAnchors,
    /// The instants before the present one, in a ring, and the place of the newest. The `known` newest of them count.
    past: [Trend; RING],
    newest: usize,
    known: usize,
}

impl Craft {
    /// Returns a craft with stopped rotors that friction does not hold yet.
    pub fn new(body: BodyState) -> Self {
        Self {
            body,
            rotors: [0.0; ROTORS],
            anchors: NO_ANCHORS,
            past: [Trend::default(); RING],
            newest: 0,
            known: 0,
        }
    }

    /// Returns the state of the body.
    pub fn body(&self) -> &BodyState {
        &self.body
    }

    /// Returns the rotor speeds, rad/s.
    pub fn rotors(&self) -> &[f64; ROTORS] {
        &self.rotors
    }

    /// Sets the rotor speeds, rad/s.
    pub fn set_rotors(&mut self, rotors: [f64; ROTORS]) {
        self.rotors = rotors;
        self.forget();
    }

    /// Changes the state. Where friction holds the craft, it goes on to hold it.
    pub fn set_body(&mut self, body: BodyState) {
        self.body = body;
        self.forget();
    }

    /// Moves the craft to a place where friction does not hold it yet.
    pub fn place(&mut self, body: BodyState) {
        self.anchors = NO_ANCHORS;
        self.set_body(body);
    }

    /// Adds what changed the motion at the start of a step that is over.
    #[inline]
    pub(super) fn remember(&mut self, trend: Trend) {
        self.newest = (self.newest + 1) % RING;
        self.past[self.newest] = trend;
        self.known = (self.known + 1).min(PAST);
    }

    /// Returns the instants before the present one, newest first, if a step can be made from them.
    #[inline]
    pub(super) fn past(&self) -> Option<[&Trend; PAST]> {
        let past = |age: usize| &self.past[(self.newest + RING - age) % RING];
        (self.known == PAST).then(|| [past(0), past(1), past(2)])
    }

    /// Forgets the motion so far. To be called where the loads jump, because a step assumes that they do not.
    pub fn forget(&mut self) {
        self.known = 0;
    }
}

/// The loads at the present instant, and what the next step needs of it.
#[derive(Debug, Clone, Copy)]
pub struct Present {
    /// Forces and torques on the craft.
    pub loads: Loads,
    /// Body → world.
    pub(super) rotation: Matrix3<f64>,
    pub(super) sums: RotorSums,
    /// The trend of the motion; `None` if the craft is not free in the air.
    pub(super) trend: Option<Trend>,
}

impl Present {
    /// Returns `true` if the craft is free in the air.
    pub(in crate::sim) fn is_free(&self) -> bool {
        self.trend.is_some()
    }
}

/// The changes of the motion of a craft in the air at one instant, in rows, since a step sums rows with weights.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Trend {
    /// The derivative of the angular momentum in body axes without the static torque of the rotors (N·m), and the static
    /// thrust of the rotors (N).
    pub(super) turn: [f64; 4],
    /// The acceleration, ENU, m/s², and zero.
    pub(super) acc: [f64; 4],
}

impl Trend {
    #[inline]
    pub(super) fn new(turn: &Vector3<f64>, thrust: f64, acc: &Vector3<f64>) -> Self {
        Self { turn: [turn.x, turn.y, turn.z, thrust], acc: [acc.x, acc.y, acc.z, 0.0] }
    }
}
