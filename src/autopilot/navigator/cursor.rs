//! The active plan, the current place in it, and the mission to resume.

use crate::plan::{FlightPlan, MAX_WAYPOINTS, Waypoint, WaypointType};
use crate::telemetry::PlanSource;

/// A mission that began since arming and may be resumed.
#[derive(Debug, Clone, PartialEq)]
struct Mission {
    /// The stored plan at the time.
    plan: FlightPlan,
    /// The waypoint to resume at.
    index: u8,
}

/// The active plan with its cursor.
#[derive(Debug, Clone, Default)]
pub(super) struct PlanCursor {
    plan: FlightPlan,
    source: PlanSource,
    index: u8,
    next_index: u8,
    mission: Option<Mission>,
    /// Waypoint at which the next mission begins.
    start_at: Option<u8>,
}

impl PlanCursor {
    /// Returns the active plan, empty while nothing is flown.
    pub(super) fn plan(&self) -> &FlightPlan {
        &self.plan
    }

    /// Returns the source of the active plan.
    pub(super) fn source(&self) -> PlanSource {
        self.source
    }

    /// Returns the index of the current waypoint.
    pub(super) fn index(&self) -> u8 {
        self.index
    }

    /// Returns the index of the next positional waypoint, or of the current one if it is the last.
    pub(super) fn next_index(&self) -> u8 {
        self.next_index
    }

    /// Returns the number of waypoints in the active plan.
    pub(super) fn count(&self) -> u8 {
        // A plan has at most 30 waypoints.
        self.plan.waypoints.len() as u8
    }

    /// Returns a waypoint of the active plan.
    pub(super) fn waypoint(&self, index: u8) -> Option<Waypoint> {
        self.plan.waypoints.get(usize::from(index)).copied()
    }

    pub(super) fn current(&self) -> Option<Waypoint> {
        self.waypoint(self.index)
    }

    /// Returns the type of the current waypoint, FLYOVER if there is none.
    pub(super) fn kind(&self) -> WaypointType {
        self.current().unwrap_or_default().kind
    }

    /// Returns the first positional waypoint at or after `index`.
    pub(super) fn positional_from(&self, index: u8) -> Option<u8> {
        (index..)
            .zip(self.plan.waypoints.iter().skip(usize::from(index)))
            .find(|(_, waypoint)| waypoint.kind.is_positional())
            .map(|(index, _)| index)
    }

    /// Returns the positional waypoint after the current one.
    pub(super) fn following(&self) -> Option<u8> {
        self.positional_from(self.index.saturating_add(1))
    }

    /// Returns the number of positional waypoints.
    pub(super) fn positional_count(&self) -> usize {
        self.plan.waypoints.iter().filter(|waypoint| waypoint.kind.is_positional()).count()
    }

    /// Returns the last YAW_RATE before `index`.
    pub(super) fn yaw_rate_before(&self, index: u8) -> Option<&Waypoint> {
        let before = self.plan.waypoints.iter().take(usize::from(index));
        before.rev().find(|waypoint| waypoint.kind.has_yaw_rate())
    }

    /// Makes the stored plan the active one.
    pub(super) fn load(&mut self, stored: &FlightPlan) {
        self.plan.clone_from(stored);
        self.source = PlanSource::Stored;
    }

    /// Replaces the active plan and forgets the mission.
    pub(super) fn inject(&mut self, source: PlanSource, waypoints: &[Waypoint]) {
        self.mission = None;
        self.source = source;
        self.plan.waypoints.clear();
        self.plan.waypoints.extend(waypoints.iter().copied());
    }

    /// Follows the clearing of the stored plan in flight.
    pub(super) fn follow_clearing(&mut self, stored: &FlightPlan) {
        if self.source == PlanSource::Stored && stored.waypoints.is_empty() {
            self.plan.waypoints.clear();
        }
    }

    /// Drops the active plan.
    pub(super) fn unload(&mut self) {
        self.plan.waypoints.clear();
        self.source = PlanSource::default();
    }

    /// Makes `index` the current waypoint. A mission on the stored plan remembers it.
    pub(super) fn move_to(&mut self, index: u8) {
        self.index = index;
        self.next_index = self.following().unwrap_or(index);
        if self.source == PlanSource::Stored
            && let Some(mission) = &mut self.mission
        {
            mission.index = index;
        }
    }

    /// Goes back to the first record, since there is no positional waypoint to fly to.
    pub(super) fn rewind(&mut self) {
        self.index = 0;
    }

    /// Ends the plan and forgets the mission. Nothing follows any more.
    pub(super) fn finish(&mut self) {
        self.mission = None;
        self.next_index = self.index;
    }

    /// Begins a mission on the stored plan. Returns the record at which it begins.
    pub(super) fn begin_mission(&mut self, stored: &FlightPlan) -> u8 {
        let index = self.start_at.take().unwrap_or(0);
        self.mission = Some(Mission { plan: stored.clone(), index });
        index
    }

    /// Returns the waypoint at which the mission goes on, if the stored plan is still the same.
    pub(super) fn resume_index(&self, stored: &FlightPlan) -> Option<u8> {
        self.mission.as_ref().filter(|mission| mission.plan == *stored).map(|mission| mission.index)
    }

    /// Makes `index` of the stored plan the waypoint at which the next mission begins. Returns `false` if it does not
    /// exist.
    pub(super) fn start_next_at(&mut self, index: u8, stored: &FlightPlan) -> bool {
        let accepted = usize::from(index) < stored.waypoints.len().min(MAX_WAYPOINTS);
        if accepted {
            self.start_at = Some(index);
            self.mission = None;
        }
        accepted
    }

    /// Forgets the mission, so that it cannot be resumed.
    pub(super) fn forget_mission(&mut self) {
        self.mission = None;
    }

    /// Ends the flight. Forgets the mission and the start of the next one.
    pub(super) fn forget_flight(&mut self) {
        self.mission = None;
        self.start_at = None;
    }
}
