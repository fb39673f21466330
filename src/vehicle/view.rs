//! The snapshot of a vehicle.

use nalgebra::Vector2;

use super::Vehicle;
use crate::firmware::Firmware;
use crate::geo::{LatLon, offset_to_degrees};
use crate::telemetry::NavTelemetry;
use crate::telemetry::snapshot::{EstimateView, Snapshot, TruthView};

impl Vehicle {
    /// Returns a snapshot of the whole vehicle at this instant.
    pub fn snapshot(&self) -> Snapshot {
        let nav = self.nav_view();
        let engaged = nav.as_ref().is_some_and(|nav| nav.engaged);
        let mut craft = self.controller.craft_view();
        if let Some(firmware) = self.embedded() {
            craft.mode_ranges = Some(firmware.mode_ranges());
        }
        Snapshot {
            time: self.time(),
            origin: self.local_frame().map(|frame| LatLon::from_degrees(frame.lat_deg, frame.lon_deg)),
            truth: self.truth_view(),
            estimate: self.estimate_view(),
            craft,
            active_plan: engaged.then(|| self.active_plan.as_deref().cloned()).flatten(),
            nav,
            stored_plan: self.controller.stored_plan().cloned(),
            settings: self.controller.settings_view(),
            world: self.physics.world_view(),
        }
    }

    /// Returns the true motion of the craft, if it is known.
    pub fn truth_view(&self) -> Option<TruthView> {
        self.physics.truth_view(self.controller.motors())
    }

    /// Converts a point from the firmware's own origin and scale to north and east of the boot place on the world's
    /// scale, m. Without an origin (no fix yet) the two are the same.
    fn count_from_boot_place(&self, ne: Vector2<f64>) -> Vector2<f64> {
        let Some(origin) = self.embedded().and_then(Firmware::origin) else { return ne };
        let (lat_deg, lon_deg) = offset_to_degrees(origin, ne);
        let Some(frame) = self.local_frame() else { return ne };
        let enu = frame.to_enu(lat_deg, lon_deg, frame.alt_amsl_m);
        Vector2::new(enu.y, enu.x)
    }

    /// Returns the telemetry of the navigator with its points relative to the boot place, or `None` if a remote
    /// controller does not report it.
    pub fn nav_view(&self) -> Option<NavTelemetry> {
        let mut nav = self.controller.nav()?.clone();
        for point in [&mut nav.aim_ne, &mut nav.target_ne].into_iter().flatten() {
            *point = self.count_from_boot_place(*point);
        }
        Some(nav)
    }

    /// Returns the state of the estimator relative to the boot place.
    pub fn estimate_view(&self) -> EstimateView {
        let mut view = self.controller.estimate_view();
        if let (Some(n), Some(e)) = (view.n, view.e) {
            let ne = self.count_from_boot_place(Vector2::new(n, e));
            (view.n, view.e) = (Some(ne.x), Some(ne.y));
        }
        view
    }
}
