//! The input of an estimate of the open plan, and its comparison with the present one.

use crate::telemetry::snapshot::{SettingsView, WindView};
use crate::ui::acts::settings_in_force;
use crate::ui::model::forecast::estimate_basis::{Air, EstimateBasis};
use crate::ui::shared::Shared;

/// Smaller changes of the mean wind are not worth another estimate.
const WIND_MPS: f64 = 0.5;
const WIND_DEG: f64 = 10.0;

impl EstimateBasis {
    /// Returns the input for the open plan now.
    pub(in crate::ui) fn of(state: &Shared) -> Self {
        let world = &state.view.vehicle.world;
        Self {
            plan: state.plan().clone(),
            settings: to_upload(state),
            craft: state.view.vehicle.settings.map(SettingsView::chosen),
            air: Air {
                airframe: world.airframe.clone(),
                wind: world.wind,
                gust_mps: world.gust_mps,
                turbulence: world.turbulence,
                noise: world.noise,
            },
        }
    }

    /// Returns `true` if an estimate for this input still fits the open plan, apart from small changes of the wind.
    pub(in crate::ui) fn still_holds(&self, state: &Shared) -> bool {
        self.plan == *state.plan()
            && self.settings == to_upload(state)
            && self.craft == state.view.vehicle.settings.map(SettingsView::chosen)
            && self.has_air_of(state)
    }

    /// Returns `true` if the craft has got the settings of the plan, and the input is the same else.
    pub(in crate::ui) fn is_uploaded(&self, state: &Shared) -> bool {
        let has_come = !self.settings.is_empty() && to_upload(state).is_empty();
        has_come && self.plan == *state.plan() && self.has_air_of(state)
    }

    fn has_air_of(&self, state: &Shared) -> bool {
        let world = &state.view.vehicle.world;
        self.air.airframe == world.airframe
            && self.air.turbulence == world.turbulence
            && self.air.noise == world.noise
            && (self.air.gust_mps - world.gust_mps).abs() < WIND_MPS
            && is_like(self.air.wind, world.wind)
    }
}

/// Returns the settings of the open plan that have yet to be uploaded. The estimate sets them on its copy of the craft,
/// which has all other settings.
pub(in crate::ui) fn to_upload(state: &Shared) -> Vec<String> {
    let lines = settings_in_force::to_upload(state, state.editor.document());
    lines.into_iter().map(str::to_owned).collect()
}

fn is_like(old: Option<WindView>, new: Option<WindView>) -> bool {
    match (old, new) {
        (Some(old), Some(new)) => {
            let turn_deg = (old.from_deg - new.from_deg + 180.0).rem_euclid(360.0) - 180.0;
            let is_calm = old.speed_mps.max(new.speed_mps) < WIND_MPS;
            (old.speed_mps - new.speed_mps).abs() < WIND_MPS && (is_calm || turn_deg.abs() < WIND_DEG)
        }
        (old, new) => old.is_none() == new.is_none(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_changes_of_the_wind_do_not_count() {
        let wind = |speed_mps, from_deg| Some(WindView { speed_mps, from_deg });
        assert!(is_like(wind(5.0, 355.0), wind(5.3, 2.0)));
        assert!(!is_like(wind(5.0, 355.0), wind(5.6, 355.0)));
        assert!(!is_like(wind(5.0, 355.0), wind(5.0, 20.0)));
        assert!(is_like(wind(0.0, 0.0), wind(0.2, 180.0)));
        assert!(!is_like(None, wind(0.0, 0.0)));
    }
}
