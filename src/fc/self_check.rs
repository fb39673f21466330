//! Checks with a craft at rest that a SITL executable interprets its packets correctly.

use std::time::Duration;

use nalgebra::Vector3;

use super::RemoteNotice;
use crate::geo::{LatLon, distance_bearing};
use crate::link::conventions::Dialect;
use crate::link::proto::fdm::{Gravity, State};
use crate::math;
use crate::telemetry::snapshot::{EstimateView, TruthView};
use crate::vehicle::Vehicle;

/// The greatest error of roll and pitch, degrees.
const TILT_DEG: f64 = 2.0;
/// The greatest error of the heading, degrees. The magnetic field that an executable computes points 2° east
/// of north.
const HEADING_DEG: f64 = 5.0;
/// The greatest difference from the heading of another dialect at which that dialect is named, degrees.
const NEAR_DEG: f64 = 15.0;
/// The greatest distance between the true position and that of its GPS, m.
const PLACE_M: f64 = 50.0;

/// The time for which it must answer before its values have settled.
const SETTLED: Duration = Duration::from_secs(8);

/// The time of the check.
#[derive(Debug, Clone, Copy, Default)]
pub(super) enum SelfCheck {
    /// It does not answer yet.
    #[default]
    Waiting,
    /// It answers. The check is due at this time.
    At(Duration),
    Done,
}

impl SelfCheck {
    /// Checks once, some time after the executable begins to answer, that it reports the attitude and the position of
    /// a craft at rest correctly. Returns a notice if it does not.
    pub(super) fn look(
        &mut self,
        sent: Dialect,
        vehicle: &Vehicle,
        answers: bool,
        trusts_mag: bool,
        now: Duration,
    ) -> Option<RemoteNotice> {
        if !self.is_due(answers, now) {
            return None;
        }
        let snapshot = vehicle.snapshot();
        let truth = snapshot.truth.filter(|truth| truth.on_ground && !truth.crashed)?;
        if snapshot.craft.armed != Some(false) {
            return None;
        }
        let at_rest = AtRest {
            sent,
            truth,
            reported: snapshot.estimate,
            trusts_mag,
            place: snapshot.craft.gps.map(|gps| gps.position),
        };
        finding(&at_rest).map(RemoteNotice::Lost)
    }

    /// Returns `true` once, when the check is due.
    fn is_due(&mut self, answers: bool, now: Duration) -> bool {
        match *self {
            Self::Waiting if answers => *self = Self::At(now + SETTLED),
            Self::At(_) if !answers => *self = Self::Waiting,
            Self::At(due) if now >= due => {
                *self = Self::Done;
                return true;
            }
            Self::Waiting | Self::At(_) | Self::Done => {}
        }
        false
    }
}

/// The values that an executable reports for a craft at rest.
#[derive(Debug, Clone, Copy)]
struct AtRest {
    /// The dialect of the packets.
    sent: Dialect,
    /// The true state of the craft.
    truth: TruthView,
    /// The executable's estimate of the craft.
    reported: EstimateView,
    /// `true` if its heading comes from the magnetometer and is therefore known at rest.
    trusts_mag: bool,
    /// The position reported by its GPS.
    place: Option<LatLon>,
}

/// Returns the error as a sentence; `None` if everything is correct.
fn finding(at_rest: &AtRest) -> Option<String> {
    let AtRest { sent, truth, reported, trusts_mag, place } = *at_rest;
    let (Some(roll), Some(pitch), Some(heading)) =
        (reported.roll_deg, reported.pitch_deg, reported.heading_deg)
    else {
        return None;
    };
    let tilts = (roll - truth.roll_deg).abs() > TILT_DEG || (pitch - truth.pitch_deg).abs() > TILT_DEG;
    let turned = trusts_mag && off_by(heading, truth.heading_deg) > HEADING_DEG;
    if tilts || turned {
        let way_out = match fitting_dialect(sent, &truth, heading).filter(|_| trusts_mag) {
            Some(fits) => format!("--fdm-dialect {fits} would fit"),
            None => "another --fdm-dialect may fit".to_owned(),
        };
        return Some(format!(
            "The firmware does not understand packets sent as {sent}: the craft is at roll {:.0}, pitch {:.0}, heading \
             {:.0} degrees, and the firmware shows {roll:.0}, {pitch:.0}, {heading:.0}; {way_out}.",
            truth.roll_deg, truth.pitch_deg, truth.heading_deg
        ));
    }
    let (distance_m, _) = distance_bearing(LatLon::from_degrees(truth.lat_deg, truth.lon_deg), place?);
    (distance_m > PLACE_M).then(|| {
        format!(
            "The firmware shows the craft {distance_m:.0} m from its place: another program fed it before, and it \
             mirrors positions about the first that it received; restart it."
        )
    })
}

/// Returns the dialect in which a packet of `sent` shows this heading.
fn fitting_dialect(sent: Dialect, truth: &TruthView, heading_deg: f64) -> Option<Dialect> {
    let yaw = (90.0 - truth.heading_deg).to_radians();
    let state = State {
        stamp_s: 1.0,
        rate_flu: Vector3::zeros(),
        specific_force_flu: Vector3::zeros(),
        attitude: nalgebra::UnitQuaternion::from_axis_angle(&Vector3::z_axis(), yaw),
        vel_enu: Vector3::zeros(),
        lon_deg: truth.lon_deg,
        lat_deg: truth.lat_deg,
        alt_m: 0.0,
        pressure_pa: 101_325.0,
    };
    // An executable that reads the dialect `read` shows this heading. With packets in that dialect it would
    // show the true one.
    [Dialect::SitlGz, Dialect::GzPlugin, Dialect::Legacy].into_iter().filter(|read| *read != sent).find(
        |read| {
            let seen = read.decode(&sent.encode(&state), Gravity::Included).attitude * Vector3::x();
            off_by(heading_deg, math::atan2(seen.x, seen.y).to_degrees()) < NEAR_DEG
        },
    )
}

/// Returns the angle between two headings, degrees.
fn off_by(a_deg: f64, b_deg: f64) -> f64 {
    let off = (a_deg - b_deg).rem_euclid(360.0);
    off.min(360.0 - off)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at_rest(heading_deg: f64, roll_deg: f64, reported_heading_deg: f64) -> AtRest {
        let truth = TruthView { lat_deg: 40.0, lon_deg: -80.0, heading_deg, ..TruthView::default() };
        let reported = EstimateView {
            roll_deg: Some(roll_deg),
            pitch_deg: Some(0.3),
            heading_deg: Some(reported_heading_deg),
            ..EstimateView::default()
        };
        let place = Some(LatLon::from_degrees(40.0, -80.0));
        AtRest { sent: Dialect::SitlGz, truth, reported, trusts_mag: true, place }
    }

    #[test]
    fn a_firmware_that_understands_is_content_with_two_degrees_of_declination() {
        assert_eq!(finding(&at_rest(0.0, 0.4, 358.0)), None);
        let unreported = EstimateView::default();
        assert_eq!(finding(&AtRest { reported: unreported, ..at_rest(0.0, 0.0, 0.0) }), None);
    }

    #[test]
    fn the_dialect_that_would_fit_is_named() {
        // Builds without the bridge take the quaternion for that of a world that is rotated by 180°.
        let sentence = finding(&at_rest(0.0, 0.0, 180.0)).unwrap();
        assert!(sentence.contains("as sitl-gz") && sentence.contains("--fdm-dialect"), "{sentence}");
        let east = finding(&at_rest(90.0, 0.0, 270.0)).unwrap();
        assert!(east.contains(" would fit."), "{east}");
    }

    #[test]
    fn without_a_trusted_magnetometer_the_heading_is_no_evidence_but_a_tilt_is() {
        let unknown_heading = AtRest { trusts_mag: false, ..at_rest(0.0, 0.0, 90.0) };
        assert_eq!(finding(&unknown_heading), None);
        let sentence = finding(&AtRest { trusts_mag: false, ..at_rest(0.0, 9.0, 0.0) }).unwrap();
        assert!(sentence.contains("another --fdm-dialect may fit"), "{sentence}");
    }

    #[test]
    fn a_firmware_that_something_else_fed_before_is_found_by_its_place() {
        let place = Some(LatLon::from_degrees(40.01, -80.0));
        let sentence = finding(&AtRest { place, ..at_rest(0.0, 0.0, 0.0) }).unwrap();
        assert!(sentence.contains("1113 m") && sentence.contains("restart it"), "{sentence}");
    }
}
