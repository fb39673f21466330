//! A sample of a log as a snapshot of its craft. What the log does not have is unknown.

use crate::flight_log::{FailsafePhase, LogHome, LogSample};
use crate::signals::RC_CHANNELS;
use crate::telemetry::snapshot::{CraftView, EstimateView, GpsView};
use crate::telemetry::{ModeBox, Snapshot};

/// The middle of a stick, µs.
const MIDDLE_US: f64 = 1500.0;
/// The pulse of no throttle, µs.
const ZERO_US: f64 = 1050.0;

/// Returns the craft of a sample. Places count from home.
pub(super) fn of(sample: &LogSample, home: Option<LogHome>, drawn_mah: Option<f64>) -> Snapshot {
    Snapshot {
        time: sample.time,
        origin: home.map(|home| home.position),
        estimate: estimate(sample),
        craft: craft(sample, home, drawn_mah),
        ..Snapshot::default()
    }
}

fn estimate(sample: &LogSample) -> EstimateView {
    EstimateView {
        n: sample.n,
        e: sample.e,
        alt: sample.alt,
        ground_speed_mps: sample.ground_speed_mps,
        climb_mps: sample.climb_mps,
        roll_deg: sample.attitude.map(|attitude| attitude.roll_deg),
        pitch_deg: sample.attitude.map(|attitude| attitude.pitch_deg),
        heading_deg: sample.attitude.map(|attitude| attitude.heading_deg),
        ..EstimateView::default()
    }
}

fn craft(sample: &LogSample, home: Option<LogHome>, drawn_mah: Option<f64>) -> CraftView {
    let gps = sample.position.map(|position| GpsView {
        position,
        alt_amsl_m: sample.alt_amsl_m.unwrap_or_default(),
        ground_speed_mps: sample.ground_speed_mps.unwrap_or_default(),
    });
    CraftView {
        armed: sample.boxes.map(|boxes| boxes.has(ModeBox::Arm)),
        modes: sample.boxes.map(|boxes| boxes.modes()),
        gps_fix: sample.gps_fix,
        gps,
        sats: sample.sats,
        home: home.map(|home| home.position),
        battery_v: sample.battery_v,
        battery_a: sample.battery_a,
        battery_mah: drawn_mah,
        throttle_us: sample.setpoint_throttle.map(mixer_us).or(sample.rc_throttle_us),
        motors: sample.motors.first_chunk().copied(),
        channels: channels(sample),
        rc_link: sample.rx_signal,
        failsafe_stage: sample.failsafe_phase.map(stage),
        ..CraftView::default()
    }
}

/// Returns the pulse of a throttle setpoint, µs. Logs lack the pulse of no throttle, so it is the default of `min_check`.
fn mixer_us(setpoint: f64) -> f64 {
    ZERO_US + setpoint * (2000.0 - ZERO_US)
}

/// Returns the channels of the sticks. The switches are not in a log; they are zero.
fn channels(sample: &LogSample) -> Option<[u16; RC_CHANNELS]> {
    let [roll, pitch, left] = sample.rc_command?;
    let mut channels = [0; RC_CHANNELS];
    // A float becomes the nearest pulse width that there is.
    let sticks =
        [MIDDLE_US + roll, MIDDLE_US + pitch, sample.rc_throttle_us.unwrap_or(0.0), MIDDLE_US - left];
    for (channel, us) in channels.iter_mut().zip(sticks) {
        *channel = us.round() as u16;
    }
    Some(channels)
}

/// Returns the stage of the failsafe: 0 none, 1 guard time, 2 procedure.
fn stage(phase: FailsafePhase) -> u8 {
    match phase {
        FailsafePhase::Idle => 0,
        FailsafePhase::RxLossDetected => 1,
        FailsafePhase::Landing
        | FailsafePhase::Landed
        | FailsafePhase::RxLossMonitoring
        | FailsafePhase::RxLossRecovered
        | FailsafePhase::GpsRescue => 2,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flight_log::{BoxFlags, BoxOrder, LogAttitude};
    use crate::geo::LatLon;
    use crate::signals::SimTime;
    use crate::telemetry::Mode;

    #[test]
    fn a_sample_of_an_empty_log_is_unknown() {
        let snapshot = of(&LogSample::default(), None, None);
        assert_eq!(snapshot, Snapshot::default());
    }

    #[test]
    fn a_sample_shows_its_craft() {
        let position = LatLon::new(470_000_000, 80_000_000);
        let home = Some(LogHome { position, alt_amsl_m: Some(400.0) });
        let sample = LogSample {
            time: SimTime(7_000_000),
            attitude: Some(LogAttitude { roll_deg: 3.0, pitch_deg: -4.0, heading_deg: 270.0 }),
            n: Some(12.0),
            rc_command: Some([100.0, -50.0, 20.0]),
            rc_throttle_us: Some(1400.0),
            setpoint_throttle: Some(0.4),
            motors: [0.1, 0.2, 0.3, 0.4].into_iter().collect(),
            boxes: Some(BoxFlags { bits: 0b11, order: BoxOrder::from_betaflight((4, 5, 0)) }),
            failsafe_phase: Some(FailsafePhase::Landing),
            ..LogSample::default()
        };
        let Snapshot { time, origin, estimate, craft, truth, nav, .. } = of(&sample, home, Some(250.0));
        assert_eq!((time, origin, truth), (SimTime(7_000_000), Some(position), None));
        assert_eq!((estimate.n, estimate.pitch_deg, estimate.alt), (Some(12.0), Some(-4.0), None));
        let channels = craft.channels.unwrap();
        assert_eq!(channels[..5], [1600, 1450, 1400, 1480, 0], "yaw to the left is a smaller pulse");
        assert_eq!(craft.throttle_us, Some(1430.0), "that of the mixer, not of the stick");
        assert_eq!((craft.armed, craft.motors), (Some(true), Some([0.1, 0.2, 0.3, 0.4])));
        assert!(craft.is_active(Mode::Angle) && !craft.is_active(Mode::Horizon));
        assert_eq!((craft.failsafe_stage, craft.battery_mah, nav), (Some(2), Some(250.0), None));
    }

    #[test]
    fn a_craft_with_other_than_four_motors_shows_the_first_four_or_none() {
        let motors = |count| {
            let sample = LogSample { motors: (0..count).map(f64::from).collect(), ..LogSample::default() };
            of(&sample, None, None).craft.motors
        };
        assert_eq!((motors(3), motors(6)), (None, Some([0.0, 1.0, 2.0, 3.0])));
    }
}
