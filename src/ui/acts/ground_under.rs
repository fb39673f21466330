//! The ground under the open plan and under the craft.

use std::sync::Arc;

use nalgebra::Vector3;

use super::{findings, settings_in_force};
use crate::geo::{LatLon, LocalFrame};
use crate::plan::FlightPlan;
use crate::terrain::{HOME_UNKNOWN, Relief, Tiles};
use crate::ui::acts::origin::origin;
use crate::ui::model::effect::Effect;
use crate::ui::model::event_log::Severity;
use crate::ui::model::files::FileRequest;
use crate::ui::model::ground::LowBasis;
use crate::ui::model::map_point::{MapPoint, craft};
use crate::ui::shared::Shared;

/// Requests the tiles of the open plan if its places have changed.
pub(in crate::ui) fn follow_plan(state: &mut Shared) -> Option<Effect> {
    if !state.ground.can_read {
        return None;
    }
    let home = findings::home(state)?;
    let is_asked =
        |(asked_home, asked): &(LatLon, FlightPlan)| *asked_home == home && *asked == *state.plan();
    if state.ground.asked.as_ref().is_some_and(is_asked) {
        return None;
    }
    let plan = state.plan().clone();
    state.ground.asked = Some((home, plan.clone()));
    Some(Effect::Files(FileRequest::Ground { home, plan: Box::new(plan) }))
}

/// Looks for low clearances of the open plan if their input has changed.
pub(in crate::ui) fn follow_clearance(state: &mut Shared) {
    let Some((tiles, home)) = state.ground.tiles.as_ref().zip(findings::home(state)) else {
        state.ground.low.clear();
        state.ground.low_basis = None;
        return;
    };
    let basis = LowBasis {
        home,
        plan: state.plan().clone(),
        assumptions: settings_in_force::assumptions(state, state.editor.document()),
        clearance_m: state.ground.clearance_m,
        tiles: tiles.squares().count(),
        estimate: state.forecast.estimate().map(|forecast| (forecast.path.len(), forecast.time_s)),
    };
    if state.ground.low_basis.as_ref() != Some(&basis) {
        let is_home_unknown = basis.tiles > 0 && state.ground.relief(home).is_none();
        if is_home_unknown && !state.ground.is_home_unknown {
            state.notify(Severity::Warn, HOME_UNKNOWN);
        }
        state.ground.is_home_unknown = is_home_unknown;
        state.ground.low = findings::low(state, home, &basis.assumptions);
        state.ground.low_basis = Some(basis);
    }
}

/// Takes tiles that were read.
pub(in crate::ui) fn read(state: &mut Shared, tiles: Option<Arc<Tiles>>, problems: Vec<String>) {
    if tiles.is_some() {
        state.ground.tiles = tiles;
    }
    for problem in problems {
        state.notify(Severity::Warn, problem);
    }
}

/// Returns the ground as seen from the home of the open plan.
pub(in crate::ui) fn relief(state: &Shared) -> Option<Relief> {
    state.ground.relief(findings::home(state)?)
}

/// Returns the height of the ground above home at a place on the map, m.
pub(in crate::ui) fn above_home_m(relief: &Relief, frame: &LocalFrame, place: MapPoint) -> Option<f64> {
    let (lat_deg, lon_deg, _) = frame.to_geodetic(Vector3::new(place.e, place.n, 0.0));
    relief.spot(lat_deg, lon_deg).map(|(height_m, _)| height_m)
}

/// Returns the height of the craft above the ground below it, m.
pub(in crate::ui) fn agl_m(state: &Shared) -> Option<f64> {
    let altitude_m = state.view.vehicle.estimate.alt?;
    Some(altitude_m - above_home_m(&relief(state)?, &origin(state)?, craft(&state.view)?)?)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::Waypoint;
    use crate::session::SessionView;
    use crate::terrain::{HGT_SIDES, Square, decode_hgt};

    #[test]
    fn the_tiles_of_other_places_are_requested_once() {
        let mut state = Shared::bare((80, 24), SessionView::default());
        let land = Waypoint { position: LatLon::new(405_000_000, -795_000_000), ..Waypoint::default() };
        state.editor.insert("a plan", &[land]).expect("a place for a waypoint");
        assert!(follow_plan(&mut state).is_none(), "there is no directory of tiles");
        state.ground.can_read = true;
        let Some(Effect::Files(FileRequest::Ground { home, plan })) = follow_plan(&mut state) else {
            panic!("no request")
        };
        assert_eq!((home, &*plan), (land.position, state.plan()));
        assert!(follow_plan(&mut state).is_none());
        state.editor.insert("another place", &[Waypoint::default()]).expect("a place for a waypoint");
        assert!(follow_plan(&mut state).is_some());
    }

    #[test]
    fn unknown_ground_at_home_is_reported_once() {
        let mut state = Shared::bare((80, 24), SessionView::default());
        let land = Waypoint { position: LatLon::new(405_000_000, -795_000_000), ..Waypoint::default() };
        state.editor.insert("a plan", &[land]).expect("a place for a waypoint");
        let square = Square::of(land.position);
        let voids = i16::MIN.to_be_bytes().repeat(1201 * 1201);
        let mut tiles = Tiles::default();
        tiles.insert(square, decode_hgt(&voids, square, &HGT_SIDES).expect("a tile"));
        read(&mut state, Some(Arc::new(tiles)), Vec::new());
        follow_clearance(&mut state);
        assert_eq!(state.notice.take().expect("a notice").text, HOME_UNKNOWN);
        state.editor.insert("another place", &[land]).expect("a place for a waypoint");
        follow_clearance(&mut state);
        assert!(state.notice.is_none());
    }
}
