//! A craft that an external simulator moves: its time, its measurements, and its reported place.

use nalgebra::Vector3;

use crate::geo::LocalFrame;
use crate::math;
use crate::signals::{PerMotor, Pose, SensorFrame};
use crate::sim::Clock;
use crate::telemetry::snapshot::TruthView;

/// A craft lower than this above its start (m) and slower than [`STANDING_MPS`] counts as on the ground, since a
/// simulator does not report contact.
const STANDING_M: f64 = 0.3;
/// The speed limit for [`STANDING_M`], m/s.
const STANDING_MPS: f64 = 0.3;

/// The known state of a craft that an external simulator moves.
#[derive(Debug, Clone)]
pub(in crate::vehicle) struct ExternalPhysics {
    /// Time, and faults of the links.
    clock: Clock,
    /// Measurements for the present step.
    sensors: SensorFrame,
    track: Track,
}

impl ExternalPhysics {
    pub(in crate::vehicle) fn new(clock: Clock) -> Self {
        Self { clock, sensors: SensorFrame::default(), track: Track::default() }
    }

    pub(super) fn clock(&self) -> &Clock {
        &self.clock
    }

    pub(in crate::vehicle) fn clock_mut(&mut self) -> &mut Clock {
        &mut self.clock
    }

    pub(super) fn sensors(&self) -> &SensorFrame {
        &self.sensors
    }

    pub(super) fn frame(&self) -> Option<&LocalFrame> {
        self.track.frame.as_ref()
    }

    pub(super) fn truth_view(&self, motors: PerMotor) -> Option<TruthView> {
        self.track.truth_view(motors)
    }

    /// Makes one step with the measurements of the simulator.
    pub(in crate::vehicle) fn measure(&mut self, sensors: &SensorFrame) {
        self.clock.pass();
        let gps = sensors.gps.filter(|_| !self.clock.gps_lost());
        self.sensors = SensorFrame { time: self.clock.time(), gps, ..*sensors };
    }

    /// Takes the place of the craft as reported by the simulator.
    pub(in crate::vehicle) fn see(&mut self, pose: Pose) {
        self.track.see(pose);
    }

    /// Sets the origin of positions, even without a report of the place of the craft.
    pub(in crate::vehicle) fn set_frame(&mut self, frame: LocalFrame) {
        self.track.frame = Some(frame);
    }

    /// Resets the track of a craft that is put somewhere else. It starts where it is seen next.
    pub(super) fn reset(&mut self) {
        self.track = Track::default();
        self.clock.wait_for_next_flight();
    }
}

/// The reported places of the craft.
#[derive(Debug, Clone, Default)]
struct Track {
    /// Frame with its origin at the first reported place.
    frame: Option<LocalFrame>,
    pose: Option<Pose>,
}

impl Track {
    /// Returns the motion of the craft as reported by the simulator.
    fn truth_view(&self, motors: PerMotor) -> Option<TruthView> {
        let (pose, frame) = (self.pose.as_ref()?, self.frame.as_ref()?);
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
            roll_deg: math::atan2(up.y, up.z).to_degrees(),
            pitch_deg: math::asin(nose.z.clamp(-1.0, 1.0)).to_degrees(),
            heading_deg: math::atan2(nose.x, nose.y).to_degrees().rem_euclid(360.0),
            motors,
            on_ground: enu.z < STANDING_M && pose.vel_enu.norm() < STANDING_MPS,
            wind_ne: None,
            wind_mps: None,
            force_mps2: None,
            battery: None,
            crashed: false,
            diverged: false,
        })
    }

    fn see(&mut self, pose: Pose) {
        if let (None, Some((lat_deg, lon_deg))) = (&self.frame, pose.place_deg) {
            self.frame = Some(LocalFrame::new(lat_deg, lon_deg, pose.alt_m));
        }
        self.pose = Some(pose);
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
        let mut track = Track::default();
        assert_eq!(track.truth_view([0.0; 4]), None, "nothing is made up");
        track.see(Pose { place_deg: None, ..pose(0.0, 0.0) });
        assert_eq!(track.truth_view([0.0; 4]), None);
        track.see(pose(40.0, 250.0));
        let start = track.truth_view([0.0; 4]).unwrap();
        assert!(start.n.abs() < 1e-9 && start.alt.abs() < 1e-9 && start.on_ground);

        let moved = Pose { attitude: attitude(200.0, -12.0, 7.0), ..pose(40.001, 260.0) };
        track.see(Pose { vel_enu: Vector3::new(1.0, 2.0, 3.0), ..moved });
        let truth = track.truth_view([0.5; 4]).unwrap();
        assert!((truth.n - 111.04).abs() < 0.1 && (truth.alt - 10.0).abs() < 1e-9 && !truth.on_ground);
        assert!((truth.heading_deg - 200.0).abs() < 1e-9 && (truth.pitch_deg + 12.0).abs() < 1e-9);
        assert!((truth.roll_deg - 7.0).abs() < 1e-9);
        assert_eq!((truth.ve, truth.vn, truth.vu, truth.motors), (1.0, 2.0, 3.0, [0.5; 4]));

        track.see(Pose { place_deg: None, ..moved });
        assert_eq!(track.truth_view([0.0; 4]), None, "an old place is not shown as the present one");
        track = Track::default();
        track.see(pose(41.0, 0.0));
        assert!(track.truth_view([0.0; 4]).unwrap().n.abs() < 1e-9);
    }
}
