//! Flight commands with a choice. Without an argument they open the same list as their keys.

use super::did_you_mean_end;
use crate::flight::forecast::{WHAT_IFS, WhatIf};
use crate::session::Command;
use crate::sim::{FAULTS, FaultInfo, ScheduledFault};
use crate::telemetry::InFlightCommand;
use crate::ui::acts::{availability, forecasts, surveys};
use crate::ui::model::action::Action;
use crate::ui::model::effect::Effect;
use crate::ui::model::message::{Request, requests};
use crate::ui::shared::Shared;
use crate::vehicle::VehicleCommand;

/// The name of the row of the what-ifs that flies a hundred flights of the plan.
const GO_NO_GO: &str = "go";

/// Runs `go-to 2`.
pub(super) fn go_to(state: &mut Shared, _: &str, argument: &str) -> Result<Vec<Request>, String> {
    availability::enabled(state, Action::GoTo)?;
    if argument.is_empty() {
        return Ok(vec![Request::Act(Action::GoTo)]);
    }
    Ok(requests(go_to_waypoint(state, argument)?))
}

/// Sends the craft to the waypoint with this number.
pub(in crate::ui) fn go_to_waypoint(state: &Shared, number: &str) -> Result<Vec<Effect>, String> {
    let numbers = waypoints(state);
    match number.parse().ok().filter(|_| numbers.iter().any(|known| known == number)) {
        Some(index) => {
            Ok(vec![Effect::Send(Command::Vehicle(VehicleCommand::InFlight(InFlightCommand::GoTo(index))))])
        }
        None => Err(format!("There is no waypoint {number} to go to; the craft has {}.", numbers.join(", "))),
    }
}

/// Returns the matching numbers of waypoints that have a place.
pub(super) fn complete_go_to(state: &Shared, _: &str, typed: &str) -> Vec<String> {
    waypoints(state).into_iter().filter(|number| number.starts_with(typed)).collect()
}

/// Returns the numbers of the craft's waypoints that have a place.
fn waypoints(state: &Shared) -> Vec<String> {
    let stored = state.view.vehicle.stored_plan.iter().flat_map(|plan| plan.waypoints.iter().enumerate());
    stored.filter(|(_, waypoint)| waypoint.kind.is_positional()).map(|(index, _)| index.to_string()).collect()
}

/// Runs `what-if gps-loss` or `what-if wind,,14@270`.
pub(super) fn what_if(state: &mut Shared, _: &str, argument: &str) -> Result<Vec<Request>, String> {
    availability::enabled(state, Action::WhatIf)?;
    if argument == GO_NO_GO {
        return Ok(vec![Request::Act(Action::GoNoGo)]);
    }
    if argument.is_empty() {
        return Ok(vec![Request::Act(Action::WhatIf)]);
    }
    Ok(requests(ask_what_if(state, argument)?))
}

/// Flies ahead with the what-if of this name, or of this number in the list. The last one flies a hundred flights.
pub(in crate::ui) fn ask_what_if(state: &mut Shared, name: &str) -> Result<Vec<Effect>, String> {
    if name == GO_NO_GO || name.parse() == Ok(WHAT_IFS.len() + 1) {
        return Ok(surveys::ask_go_no_go(state));
    }
    let numbered = name.parse::<usize>().ok().and_then(|number| number.checked_sub(1));
    let found = match numbered {
        Some(at) => WHAT_IFS.into_iter().nth(at).ok_or_else(|| no_what_if(name))?,
        None => {
            let word = name.split_once(',').map_or(name, |(word, _)| word);
            if !what_if_names().any(|known| known == word) {
                return Err(no_what_if(name));
            }
            WhatIf::parse(name).map_err(|problem| format!("what-if {name}: {problem}."))?
        }
    };
    Ok(fly_what_if(state, found))
}

/// Returns the names of the what-ifs, then those of the other faults.
fn what_if_names() -> impl Iterator<Item = &'static str> {
    let listed = WHAT_IFS.map(|what_if| what_if.name);
    let faults = FAULTS.iter().map(FaultInfo::name);
    listed.into_iter().chain(faults.filter(move |name| !listed.contains(name)))
}

/// Returns the sentence for a name that is no what-if.
fn no_what_if(name: &str) -> String {
    match did_you_mean_end(name, what_if_names()) {
        guess if guess.ends_with('?') => format!("There is no what-if {name}{guess}"),
        _ => {
            let names: Vec<&str> = what_if_names().collect();
            format!("There is no what-if {name}; there are {}.", names.join(", "))
        }
    }
}

/// Flies ahead with a what-if, in place of a survey.
pub(in crate::ui) fn fly_what_if(state: &mut Shared, what_if: WhatIf) -> Vec<Effect> {
    let (survey, flies) = (surveys::dismiss(state), flies(state));
    survey.into_iter().chain(forecasts::ask_what_if(state, what_if, flies)).collect()
}

/// Returns `true` if there is a flight to look ahead to. On the ground a what-if is flown from home.
pub(in crate::ui) fn flies(state: &Shared) -> bool {
    availability::flies(state).is_ok()
}

/// Runs `where gps-loss,6`.
pub(super) fn where_may(state: &mut Shared, _: &str, argument: &str) -> Result<Vec<Request>, String> {
    if argument.is_empty() {
        availability::enabled(state, Action::WhereMay)?;
        return Ok(vec![Request::Act(Action::WhereMay)]);
    }
    // A sweep that is shown gives way to the new one.
    availability::enabled(state, Action::GoNoGo)?;
    let fault =
        ScheduledFault::without_time(argument).map_err(|problem| format!("where {argument}: {problem}."))?;
    Ok(requests(surveys::ask_sweep(state, fault)))
}

/// Returns the matching names of faults.
pub(super) fn complete_where(_: &Shared, _: &str, typed: &str) -> Vec<String> {
    let names = FAULTS.iter().map(FaultInfo::name);
    names.filter(|name| name.starts_with(typed)).map(str::to_owned).collect()
}

/// Returns the matching names of what-ifs.
pub(super) fn complete_what_if(_: &Shared, _: &str, typed: &str) -> Vec<String> {
    let names = what_if_names().chain([GO_NO_GO]);
    names.filter(|name| name.starts_with(typed)).map(str::to_owned).collect()
}
