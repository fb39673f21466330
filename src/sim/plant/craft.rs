//! The moving craft: its state, and what the next step takes from the steps before.

use arrayvec::ArrayVec;
use nalgebra::{Matrix3, Vector3};

use crate::sim::airframe::ROTORS;
use crate::sim::body::{BodyState, Loads};
use crate::sim::ground::{ContactAnchors, NO_ANCHORS};

use super::rotors::RotorSums;

/// The number of earlier instants that a step of a craft in the air uses.
pub(super) const PAST: usize = 3;

/// A craft in motion. A clone continues identically.
#[derive(Debug, Clone)]
pub struct Craft {
    pub(super) body: BodyState,
    pub(super) rotors: [f64; ROTORS],
    pub(super) anchors: ContactAnchors,
    /// The instants before the present one, newest first.
    pub(super) past: ArrayVec<Trend, PAST>,
}

impl Craft {
    /// Returns a craft with stopped rotors that friction does not hold yet.
    pub fn new(body: BodyState) -> Self {
        Self::held(body, [0.0; ROTORS], NO_ANCHORS)
    }

    /// Returns a craft that friction holds at the given places.
    pub(in crate::sim) fn held(body: BodyState, rotors: [f64; ROTORS], anchors: ContactAnchors) -> Self {
        Self { body, rotors, anchors, past: ArrayVec::new() }
    }

    /// Returns the state of the body.
    pub fn body(&self) -> &BodyState {
        &self.body
    }

    /// Returns the rotor speeds, rad/s.
    pub fn rotors(&self) -> &[f64; ROTORS] {
        &self.rotors
    }

    /// Returns where friction holds the contact points.
    pub(in crate::sim) fn anchors(&self) -> &ContactAnchors {
        &self.anchors
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
    pub(super) fn remember(&mut self, trend: Trend) {
        self.past.truncate(PAST - 1);
        self.past.insert(0, trend);
    }

    /// Forgets the motion so far. To be called where the loads jump, because a step assumes that they do not.
    pub fn forget(&mut self) {
        self.past.clear();
    }
}

/// The loads at the present instant, and what the next step needs of it.
#[derive(Debug, Clone, Copy)]
pub struct Present {
    pub loads: Loads,
    /// Body → world.
    pub(super) rotation: Matrix3<f64>,
    pub(super) sums: RotorSums,
    /// The trend of the motion; `None` if the craft is not free in the air.
    pub(super) trend: Option<Trend>,
}

/// The changes of the motion of a craft in the air at one instant.
#[derive(Debug, Clone, Copy)]
pub(super) struct Trend {
    /// The derivative of the angular momentum in body axes without the static torque of the rotors, N·m.
    pub(super) turn: Vector3<f64>,
    /// Acceleration, ENU, m/s².
    pub(super) acc: Vector3<f64>,
    /// The static thrust of the rotors, N.
    pub(super) thrust: f64,
}
