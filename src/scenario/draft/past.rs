//! A second flight of a recorded flight. It finds the plan at the beginning and the end of all activity.

use crate::plan::FlightPlan;
use crate::plan::validate::check_plan;
use crate::signals::SimTime;
use crate::telemetry::{EventKind, FirmwareEvent};
use crate::timeline::RecordedFlight;
use crate::vehicle::{Vehicle, VehicleCommand};

/// The time for which the craft is watched after the last activity, µs.
const WATCH_US: u64 = 10_000_000;

/// The facts about a recorded flight that a draft needs.
#[derive(Debug)]
pub(super) struct Past {
    /// The plan that was stored when the navigator first used one.
    pub(super) plan: FlightPlan,
    /// The number of inputs before that. The draft leaves out those that uploaded the plan.
    pub(super) inputs_before: usize,
    /// The number of inputs before the first arming, or zero if one of them resets the craft's settings.
    inputs_before_arming: usize,
    /// The time at which all activity was over.
    pub(super) until: SimTime,
}

impl Past {
    /// Flies the flight again.
    pub(super) fn of(flight: &RecordedFlight) -> Self {
        let mut vehicle = flight.start.clone();
        vehicle.keep_inputs(false);
        vehicle.drain_events(drop);
        let (mut begun, mut armed) = (None, None);
        let mut next = 0;
        let mut active_at = vehicle.time();
        while vehicle.time() < flight.until {
            while let Some((_, input)) = flight.inputs.get(next).filter(|(at, _)| *at <= vehicle.time()) {
                if needs_plan(input) {
                    begun.get_or_insert_with(|| (stored_plan(&vehicle), next));
                }
                let _reported = vehicle.apply(input);
                next += 1;
                active_at = vehicle.time();
            }
            vehicle.tick();
            let mut navigates = false;
            vehicle.drain_events(|event| {
                navigates |= matches!(event.kind, EventKind::Firmware(FirmwareEvent::Nav(_)));
            });
            if navigates {
                begun.get_or_insert_with(|| (stored_plan(&vehicle), next));
            }
            if vehicle.controller().is_armed() {
                armed.get_or_insert(next);
            }
            if !vehicle.is_idle() {
                active_at = vehicle.time();
            }
            let is_over = next == flight.inputs.len() && vehicle.time().0 >= active_at.0 + WATCH_US;
            if is_over {
                break;
            }
        }
        let until = vehicle.time().min(flight.until);
        let (plan, inputs_before) = begun.unwrap_or_else(|| (stored_plan(&vehicle), next));
        // A later `defaults` would empty a plan stored at boot, and a scenario cannot begin with a refused plan.
        let is_reset = |(_, input): &(SimTime, VehicleCommand)| matches!(input, VehicleCommand::Line(line) if is_defaults(&line.line));
        let inputs_before_arming = armed.unwrap_or(next);
        let is_refused = !plan.waypoints.is_empty() && check_plan(&plan).is_err();
        if is_refused || flight.inputs.iter().take(inputs_before).any(is_reset) {
            return Self {
                plan: stored_plan(&flight.start),
                inputs_before: 0,
                inputs_before_arming: 0,
                until,
            };
        }
        Self { plan, inputs_before, inputs_before_arming, until }
    }

    /// Returns `true` if the input with this number came before the craft was armed, so that its settings may be those of
    /// the start.
    pub(super) fn is_before_arming(&self, number: usize) -> bool {
        number < self.inputs_before_arming
    }

    /// Returns `true` if this sentence of the input with this number is already part of the plan.
    pub(super) fn is_in_plan(&self, number: usize, sentence: &str) -> bool {
        number < self.inputs_before && sentence.split_whitespace().take(2).eq(["cli", "waypoint"])
    }
}

fn stored_plan(vehicle: &Vehicle) -> FlightPlan {
    vehicle.controller().stored_plan().cloned().unwrap_or_default()
}

/// Returns `true` if the effect of an input depends on the stored plan.
fn needs_plan(input: &VehicleCommand) -> bool {
    matches!(input, VehicleCommand::InFlight(_) | VehicleCommand::ReturnHome)
}

fn is_defaults(line: &str) -> bool {
    line.split_whitespace().next() == Some("defaults")
}
