//! The forecast that the map shows.

use crate::flight::forecast::{Forecast, PathPoint};
use crate::ui::acts::setting_list::planned;
use crate::ui::model::forecast::setting_change;
use crate::ui::shared::Shared;
use crate::ui::units::Units;

/// A path that was not flown yet, and its description.
#[derive(Debug)]
pub(in crate::ui) struct Ghost<'a> {
    pub path: &'a [PathPoint],
    /// The path of the same flight without the tried setting.
    pub unchanged: &'a [PathPoint],
    /// The description of the path and, if the user requested it, of its end.
    pub line: String,
}

/// Returns the forecast on the map: the requested what-if or look-ahead, else the estimate of the open plan while no
/// plan or another one is flown.
pub(in crate::ui) fn ghost(state: &Shared) -> Option<Ghost<'_>> {
    let forecast = &state.forecast;
    if let Some(chosen) = &forecast.what_if {
        return Some(asked(state.units, &chosen.title, chosen.asked.forecast()));
    }
    if let Some(look_ahead) = &forecast.look_ahead {
        return Some(asked(state.units, "look-ahead", look_ahead.asked.forecast()));
    }
    let is_flown =
        state.view.vehicle.is_engaged() && state.view.vehicle.active_plan.as_ref() == Some(state.plan());
    if let Some(tried) = &forecast.tried {
        let flown = tried.asked.forecast();
        let unchanged = flown.and_then(|flown| flown.unchanged.as_deref());
        let difference = flown.and_then(|flown| setting_change::difference(flown, state.units));
        let ghost = asked(state.units, &tried.assignment.line(), flown);
        let planned = planned(state, &tried.assignment.name).filter(|_| !state.plan_is_on_craft());
        let planned =
            planned.map(|value| format!("compared with {value}, which the plan sets at its upload"));
        let line =
            [Some(ghost.line), difference, planned].into_iter().flatten().collect::<Vec<_>>().join("; ");
        return Some(Ghost { unchanged: unchanged.map_or(&[], |unchanged| &unchanged.path), line, ..ghost });
    }
    let estimate = forecast.estimate().filter(|_| !is_flown)?;
    Some(Ghost { path: &estimate.path, unchanged: &[], line: "predicted".to_owned() })
}

fn asked<'a>(units: Units, what: &str, forecast: Option<&'a Forecast>) -> Ghost<'a> {
    match forecast {
        Some(forecast) => {
            let line = forecast.line(|metres| units.length_text(metres, 0));
            Ghost { path: &forecast.path, unchanged: &[], line: format!("{what}: {line}") }
        }
        None => Ghost { path: &[], unchanged: &[], line: format!("{what}: …") },
    }
}
