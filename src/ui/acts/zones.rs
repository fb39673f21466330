//! Reviews the open plan against the zones of its backdrop.

use nalgebra::Vector3;

use crate::flight::forecast::PathPoint;
use crate::geo::LatLon;
use crate::plan::feature::Feature;
use crate::plan::review::{Finding, zone_findings, zones_on_path};
use crate::ui::acts::findings;
use crate::ui::acts::origin::origin;
use crate::ui::model::backdrop::BackdropLayer;
use crate::ui::model::editor::zones::{ZoneBasis, ZoneReview};
use crate::ui::shared::Shared;

/// Reviews the shown plan again if something has changed.
pub(in crate::ui) fn follow(state: &mut Shared) {
    let open = state.editor.plan();
    let home = findings::home(state).filter(|_| !open.document().plan.waypoints.is_empty());
    let (false, Some(home)) = (open.backdrop().is_empty(), home) else {
        if state.editor.zones.basis.is_some() {
            state.editor.zones = ZoneReview::default();
        }
        return;
    };
    let flown = state.forecast.flown_path();
    let layer = |layer: &BackdropLayer| (layer.path.clone(), layer.vertices());
    let basis = ZoneBasis {
        id: open.id(),
        plan: open.document().plan.clone(),
        home,
        layers: open.backdrop().iter().map(layer).collect(),
        flown: flown.map(|(revision, _)| revision),
    };
    if state.editor.zones.basis.as_ref() == Some(&basis) {
        return;
    }
    let zones: Vec<Feature> = open.backdrop().iter().flat_map(BackdropLayer::zones).cloned().collect();
    let mut found = zone_findings(&basis.plan, home, &zones);
    if let (Some((_, path)), Some(frame)) = (flown, origin(state)) {
        let position = |point: &PathPoint| {
            let (lat, lon, _) = frame.to_geodetic(Vector3::new(point.e, point.n, 0.0));
            LatLon::from_degrees(lat, lon)
        };
        let positions: Vec<LatLon> = path.iter().map(position).collect();
        found.extend(zones_on_path(&positions, &zones).into_iter().map(|(zone, name, at)| {
            Finding::FlownAgainstZone { zone, name, along_m: path.get(at).map_or(0.0, |point| point.along_m) }
        }));
    }
    state.editor.zones = ZoneReview { basis: Some(basis), findings: found };
}
