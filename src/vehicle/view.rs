//! The snapshot of a vehicle.

use nalgebra::Vector2;

use super::outside::Outside;
use super::{EXTERNAL, Vehicle};
use crate::geo::{LocalFrame, offset_to_degrees};
use crate::sim::{Fault, Noise};
use crate::telemetry::snapshot::{EstimateView, FaultView, Snapshot, TruthView, WorldView};

impl Vehicle {
    /// A picture of the whole vehicle at this instant.
    #[must_use]
    pub fn snapshot(&self) -> Snapshot {
        let firmware = &self.firmware;
        let mut nav = firmware.nav().clone();
        for point in [&mut nav.aim_ne, &mut nav.target_ne].into_iter().flatten() {
            *point = self.count_from_boot_place(*point);
        }
        Snapshot {
            time: self.time(),
            truth: self.truth_view(),
            estimate: self.estimate_view(),
            craft: firmware.craft_view(),
            active_plan: nav.engaged.then(|| self.active_plan.as_deref().cloned()).flatten(),
            nav,
            stored_plan: firmware.stored_plan().clone(),
            settings: firmware.settings_view(),
            world: self.world_view(),
        }
    }

    /// A point that the firmware counts from its own origin and on its own scale, counted north and east from the boot
    /// place on the world's scale, m. Without an origin (no fix yet) the two are the same.
    fn count_from_boot_place(&self, ne: Vector2<f64>) -> Vector2<f64> {
        let Some(origin) = self.firmware.origin() else { return ne };
        let (lat_deg, lon_deg) = offset_to_degrees(origin, ne);
        let Some(frame) = self.local_frame() else { return ne };
        let enu = frame.to_enu(lat_deg, lon_deg, frame.alt_amsl_m);
        Vector2::new(enu.y, enu.x)
    }

    /// The frame whose origin is the boot place; `None` before a simulator outside has told where that is.
    fn local_frame(&self) -> Option<&LocalFrame> {
        self.outside.as_ref().map_or_else(|| Some(self.world.local_frame()), Outside::frame)
    }

    fn truth_view(&self) -> Option<TruthView> {
        match &self.outside {
            Some(outside) => outside.truth_view(self.firmware.control().motors.0),
            None => Some(self.world_truth_view()),
        }
    }

    fn world_truth_view(&self) -> TruthView {
        let truth = self.world.truth();
        let (lat_deg, lon_deg, _) = self.world.local_frame().to_geodetic(truth.pos_enu);
        TruthView {
            lat_deg,
            lon_deg,
            n: truth.pos_enu.y,
            e: truth.pos_enu.x,
            alt: truth.pos_enu.z - self.world.airframe().standing_height_m(),
            vn: truth.vel_enu.y,
            ve: truth.vel_enu.x,
            vu: truth.vel_enu.z,
            roll_deg: truth.roll_deg(),
            pitch_deg: truth.pitch_deg(),
            heading_deg: truth.heading_deg(),
            motors: truth.motor_command,
            wind_n: truth.wind_enu.y,
            wind_e: truth.wind_enu.x,
            on_ground: truth.on_ground,
            crashed: truth.crashed,
            diverged: truth.diverged,
        }
    }

    fn estimate_view(&self) -> EstimateView {
        let mut view = self.firmware.estimate_view();
        if let (Some(n), Some(e)) = (view.n, view.e) {
            let ne = self.count_from_boot_place(Vector2::new(n, e));
            (view.n, view.e) = (Some(ne.x), Some(ne.y));
        }
        view
    }

    fn world_view(&self) -> WorldView {
        let status = self.world.status();
        let view =
            |&(fault, left_s): &(Fault, _)| FaultView { kind: fault.kind(), value: fault.value(), left_s };
        let faults = status.faults.iter().map(view).collect();
        if self.outside.is_some() {
            let airframe = EXTERNAL.to_owned();
            return WorldView { airframe, turbulence: "none", faults, ..WorldView::default() };
        }
        WorldView {
            airframe: self.world.airframe().name.clone(),
            wind_mps: status.wind.speed_mps,
            wind_from_deg: status.wind.from_deg,
            gust_mps: status.gust_mps,
            turbulence: status.turbulence.into(),
            noise: status.noise == Noise::Real,
            faults,
        }
    }
}
