//! A craft that a simulator outside moves: its time, and where that simulator says it is.

use nalgebra::Vector3;

use super::Vehicle;
use crate::geo::LocalFrame;
use crate::signals::{MotorCommand, Pose, SensorFrame};
use crate::telemetry::snapshot::TruthView;

/// Lower than this above its start (m) and slower than [`STANDING_MPS`], the craft counts as standing: a simulator does
/// not tell of contact.
const STANDING_M: f64 = 0.3;
/// See [`STANDING_M`], m/s.
const STANDING_MPS: f64 = 0.3;

/// What is known of a craft that a simulator outside moves.
#[derive(Debug, Clone, Default)]
pub(super) struct Outside {
    /// The newest pose and the frame at the first one.
    seen: Option<(Pose, LocalFrame)>,
}

impl Outside {
    /// The frame whose origin is the place where the craft was seen first.
    pub(super) fn frame(&self) -> Option<&LocalFrame> {
        self.seen.as_ref().map(|(_, frame)| frame)
    }

    /// The craft's motion as the simulator tells it.
    pub(super) fn truth_view(&self, motors: [f64; 4]) -> Option<TruthView> {
        let (pose, frame) = self.seen.as_ref()?;
        let (lat_deg, lon_deg) = pose.place_deg?;
        let enu = frame.to_enu(lat_deg, lon_deg, pose.alt_m);
        let nose = pose.attitude * Vector3::x();
        let up = pose.attitude.inverse_transform_vector(&Vector3::z());
        Some(TruthView {
            lat_deg,
            lon_deg,
            n: enu.y,
            e: enu.x,
            alt: enu.z,
            vn: pose.vel_enu.y,
            ve: pose.vel_enu.x,
            vu: pose.vel_enu.z,
            roll_deg: up.y.atan2(up.z).to_degrees(),
            pitch_deg: nose.z.clamp(-1.0, 1.0).asin().to_degrees(),
            heading_deg: nose.x.atan2(nose.y).to_degrees().rem_euclid(360.0),
            motors,
            on_ground: enu.z < STANDING_M && pose.vel_enu.norm() < STANDING_MPS,
            ..TruthView::default()
        })
    }

    fn see(&mut self, pose: Pose) {
        let frame = match (&self.seen, pose.place_deg) {
            (Some((_, frame)), _) => *frame,
            (None, Some((lat_deg, lon_deg))) => LocalFrame::new(lat_deg, lon_deg, pose.alt_m),
            (None, None) => return,
        };
        self.seen = Some((pose, frame));
    }

    /// The craft is put somewhere else: what was seen of it means nothing.
    pub(super) fn forget(&mut self) {
        self.seen = None;
    }
}

impl Vehicle {
    /// One step on what a simulator outside measured; the motors' answer is the simulator's to carry out.
    ///
    /// Only for a vehicle of [`Vehicle::moved_from_outside`]; the world of another would not follow.
    pub fn tick_on(&mut self, sensors: &SensorFrame) -> MotorCommand {
        if self.outside.is_none() {
            return MotorCommand::default();
        }
        self.send_due_rc();
        self.lose_rc();
        self.world.pass();
        let gps = sensors.gps.filter(|_| !self.world.gps_lost());
        let motors = self.firmware.step(&SensorFrame { time: self.world.time(), gps, ..*sensors });
        self.collect_events();
        motors
    }

    /// Ends faults of the link whose time is over after a silence of this length, µs: meanwhile the vehicle's time stands
    /// still. Says whether there were any.
    pub fn end_link_faults(&mut self, silence_us: u64) -> bool {
        let before = self.events.len();
        self.world.end_link_faults(silence_us);
        self.collect_events();
        self.events.len() != before
    }

    /// Takes in where the simulator outside says the craft is.
    pub fn see(&mut self, pose: Pose) {
        if let Some(outside) = &mut self.outside {
            outside.see(pose);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sim::{attitude, level_attitude};

    fn pose(lat_deg: f64, alt_m: f64) -> Pose {
        Pose {
            place_deg: Some((lat_deg, -79.5)),
            alt_m,
            vel_enu: Vector3::zeros(),
            attitude: level_attitude(0.0),
        }
    }

    #[test]
    fn positions_count_from_where_the_craft_was_seen_first() {
        let mut outside = Outside::default();
        assert_eq!(outside.truth_view([0.0; 4]), None, "nothing is made up");
        outside.see(Pose { place_deg: None, ..pose(0.0, 0.0) });
        assert_eq!(outside.truth_view([0.0; 4]), None);
        outside.see(pose(40.0, 250.0));
        let start = outside.truth_view([0.0; 4]).unwrap();
        assert!(start.n.abs() < 1e-9 && start.alt.abs() < 1e-9 && start.on_ground);

        let moved = Pose { attitude: attitude(200.0, -12.0, 7.0), ..pose(40.001, 260.0) };
        outside.see(Pose { vel_enu: Vector3::new(1.0, 2.0, 3.0), ..moved });
        let truth = outside.truth_view([0.5; 4]).unwrap();
        assert!((truth.n - 111.04).abs() < 0.1 && (truth.alt - 10.0).abs() < 1e-9 && !truth.on_ground);
        assert!((truth.heading_deg - 200.0).abs() < 1e-9 && (truth.pitch_deg + 12.0).abs() < 1e-9);
        assert!((truth.roll_deg - 7.0).abs() < 1e-9);
        assert_eq!((truth.ve, truth.vn, truth.vu, truth.motors), (1.0, 2.0, 3.0, [0.5; 4]));

        outside.see(Pose { place_deg: None, ..moved });
        assert_eq!(outside.truth_view([0.0; 4]), None, "an old place is not shown as the present one");
        outside.forget();
        outside.see(pose(41.0, 0.0));
        assert!(outside.truth_view([0.0; 4]).unwrap().n.abs() < 1e-9);
    }
}
