//! Pictures of a flight: snapshots in a form that is small in a file and in memory.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::fingerprint::{self, Fingerprint};
use crate::geo::LatLon;
use crate::plan::FlightPlan;
use crate::signals::{RcFrame, SimTime};
use crate::telemetry::snapshot::{CraftView, EstimateView, ModeRange, SettingsView, TruthView, WorldView};
use crate::telemetry::{NavTelemetry, Snapshot};
use crate::vehicle::Vehicle;

/// The time between two pictures of a flight, µs.
pub(super) const PICTURE_US: u64 = 100_000;
/// The time between two pictures of a craft at rest, µs.
const IDLE_US: u64 = 1_000_000;

/// The state of a vehicle that is recorded as a picture.
#[derive(Debug, Clone, PartialEq)]
pub struct Seen {
    pub snapshot: Snapshot,
    /// The frame of the virtual sticks.
    pub sticks: RcFrame,
    /// `true` while the virtual sticks are cut.
    pub rc_cut: bool,
    /// The number of the instant, if its flight can be flown again.
    pub print: Option<Fingerprint>,
}

impl Seen {
    /// Returns the state of a vehicle now.
    pub fn of(vehicle: &Vehicle) -> Self {
        Self {
            snapshot: vehicle.snapshot(),
            sticks: vehicle.transmitter().sticks(),
            rc_cut: vehicle.transmitter().is_cut(),
            print: vehicle.embedded().and_then(|_| fingerprint::of(vehicle)),
        }
    }
}

/// Decides when a picture is due: ten times a second, and once a second while the craft is at rest and disarmed.
#[derive(Debug, Clone, Copy, Default)]
pub struct Cadence {
    /// The time at which it was last asked.
    asked_at: SimTime,
}

impl Cadence {
    /// Returns the state of a vehicle if a picture is due. Ask after each tick, or less often.
    pub fn due(&mut self, vehicle: &Vehicle) -> Option<Seen> {
        let now = vehicle.time().0;
        let before = std::mem::replace(&mut self.asked_at, vehicle.time()).0;
        let every = |interval: u64| now / interval != before / interval;
        (every(PICTURE_US) && (every(IDLE_US) || !vehicle.is_idle())).then(|| Seen::of(vehicle))
    }
}

/// The part of a snapshot that changes rarely.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub(super) struct Scene {
    origin: Option<LatLon>,
    active_plan: Option<FlightPlan>,
    stored_plan: Option<FlightPlan>,
    settings: Option<SettingsView>,
    mode_ranges: Option<Vec<ModeRange>>,
}

/// The part that changes with every picture.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub(super) struct Shot {
    pub(super) t: SimTime,
    truth: Option<TruthView>,
    estimate: EstimateView,
    craft: CraftView,
    nav: Option<NavTelemetry>,
    world: WorldView,
    sticks: Option<RcFrame>,
    cut: bool,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) print: Option<Fingerprint>,
}

/// Returns the two parts of a state.
pub(super) fn parts(seen: Seen) -> (Scene, Shot) {
    let Seen { snapshot, sticks, rc_cut, print } = seen;
    let Snapshot { time, origin, truth, estimate, mut craft, nav, active_plan, stored_plan, settings, world } =
        snapshot;
    let mode_ranges = craft.mode_ranges.take();
    let scene = Scene { origin, active_plan, stored_plan, settings, mode_ranges };
    let shot = Shot { t: time, truth, estimate, craft, nav, world, sticks: Some(sticks), cut: rc_cut, print };
    (scene, shot)
}

/// A picture of a flight.
#[derive(Debug, Clone, PartialEq)]
pub struct Picture {
    pub(super) shot: Shot,
    pub(super) scene: Arc<Scene>,
}

impl Picture {
    pub(super) fn new(mut shot: Shot, scene: &Arc<Scene>) -> Self {
        // They are part of the scene.
        shot.craft.mode_ranges = None;
        Self { shot, scene: Arc::clone(scene) }
    }

    pub fn time(&self) -> SimTime {
        self.shot.t
    }

    /// Returns the number of the instant, if the flight can be flown again.
    pub fn print(&self) -> Option<Fingerprint> {
        self.shot.print
    }

    /// Returns the snapshot of the instant.
    pub fn snapshot(&self) -> Snapshot {
        let Scene { origin, active_plan, stored_plan, settings, mode_ranges } = (*self.scene).clone();
        let Shot { t, truth, estimate, craft, nav, world, .. } = self.shot.clone();
        let craft = CraftView { mode_ranges, ..craft };
        Snapshot { time: t, origin, truth, estimate, craft, nav, active_plan, stored_plan, settings, world }
    }

    /// Returns the approximate memory of the part that no other picture shares, bytes.
    fn bytes(&self) -> usize {
        let world = &self.shot.world;
        size_of::<Self>() + size_of_val(world.faults.as_slice()) + world.airframe.len()
    }
}

/// The pictures of a flight, oldest first, within a bound.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Pictures {
    all: Vec<Picture>,
    bytes: usize,
    /// The least time between two pictures that are kept, µs.
    interval_us: u64,
}

/// The most memory of pictures, bytes: an hour with ten a second takes two thirds of it.
const MAX_BYTES: usize = 96 << 20;

impl Pictures {
    /// Adds a picture. A picture that is not newer than the last one, or too near to it, is left out. Once they take too
    /// much memory, every second one is dropped.
    pub(super) fn push(&mut self, picture: Picture, new_scene: bool) {
        let last = self.all.last().map(Picture::time);
        let is_due = last.is_none_or(|last| picture.time().0 >= last.0 + self.interval_us.max(1));
        if !is_due {
            return;
        }
        self.bytes += cost(&picture, new_scene);
        self.all.push(picture);
        if self.bytes > MAX_BYTES {
            self.thin_out();
        }
    }

    fn thin_out(&mut self) {
        self.interval_us = (2 * self.interval_us).max(2 * PICTURE_US);
        let mut number = 0_usize;
        self.all.retain(|_| {
            number += 1;
            number % 2 == 1
        });
        self.all.shrink_to_fit();
        self.count();
    }

    fn count(&mut self) {
        let mut scene: Option<&Arc<Scene>> = None;
        self.bytes = 0;
        for picture in &self.all {
            let is_new = scene.is_none_or(|scene| !Arc::ptr_eq(scene, &picture.scene));
            self.bytes += cost(picture, is_new);
            scene = Some(&picture.scene);
        }
    }

    /// Forgets the pictures after `time`.
    pub(super) fn forget_after(&mut self, time: SimTime) {
        self.all.truncate(self.all.partition_point(|picture| picture.time() <= time));
        self.count();
    }

    /// Returns all pictures, oldest first.
    pub fn all(&self) -> &[Picture] {
        &self.all
    }

    /// Returns the newest picture at or before `time`, or else the first one.
    pub fn at(&self, time: SimTime) -> Option<&Picture> {
        let after = self.all.partition_point(|picture| picture.time() <= time);
        self.all.get(after.saturating_sub(1))
    }
}

fn cost(picture: &Picture, new_scene: bool) -> usize {
    let of_scene = |scene: &Scene| {
        let ranges = scene.mode_ranges.as_ref().map_or(0, Vec::len);
        size_of::<Scene>() + ranges * size_of::<ModeRange>()
    };
    picture.bytes() + if new_scene { of_scene(&picture.scene) } else { 0 }
}
