//! The track of a log as a flight of a comparison.

use std::io;

use nalgebra::Vector2;

use super::{Landing, Track};
use crate::blackbox::decode::LogSource;
use crate::flight_log::{LogFlight, LogMarkKind};
use crate::report::route::TrackSample;
use crate::signals::SimTime;
use crate::telemetry::{Mode, ModeBox};

/// The interval between two samples, µs.
const INTERVAL_US: u64 = 50_000;

/// Returns the time at which the comparison of a log begins: that of its first AUTOPILOT, or of its first frame if the
/// autopilot never flew.
pub fn begin_of_log(flight: &LogFlight) -> SimTime {
    let autopilot = ModeBox::from(Mode::Autopilot);
    let engaged = flight.marks().iter().find(|mark| match mark.kind {
        LogMarkKind::Boxes { old, new } => new.has(autopilot) && !old.has(autopilot),
        _ => false,
    });
    engaged.map_or(flight.first(), |mark| mark.time)
}

impl Track {
    /// Returns the track of a log by its GPS and its altitude, from [`begin_of_log`] on. Altitudes count from the first one of
    /// the log. A touchdown is where the craft was disarmed. `seed` is that of the flight to compare it with.
    ///
    /// # Errors
    ///
    /// Returns the error of the source.
    pub fn from_log<S: LogSource>(flight: &LogFlight, source: S, seed: u64) -> io::Result<Self> {
        let mut track = Self { seed, result: "logged".to_owned(), ..Self::default() };
        let begin = begin_of_log(flight);
        let Some(mut cursor) = flight.cursor(source, flight.first())? else { return Ok(track) };
        let standing_m = cursor.sample().alt.unwrap_or_default();
        let mut due_us = begin.0;
        loop {
            let sample = cursor.latest();
            if let (Some(n), Some(e), Some(alt)) = (sample.n, sample.e, sample.alt)
                && sample.time.0 >= due_us
            {
                let (time_s, ne) = (sample.time.seconds_since(begin), Vector2::new(n, e));
                track.samples.push(TrackSample { time_s, ne, alt_m: alt - standing_m, attitude: None });
                due_us = sample.time.0 + INTERVAL_US;
            }
            if !cursor.advance()? {
                break;
            }
        }
        track.flown_s = Some(flight.last().seconds_since(begin));
        let disarmed = flight.marks().iter().rev().find_map(|mark| match mark.kind {
            LogMarkKind::Disarmed(reason) => Some((mark.time, reason)),
            _ => None,
        });
        if let Some((time, reason)) = disarmed {
            track.reason = format!("disarmed: {reason}");
            let last = track.samples.last().map(|last| last.ne);
            track.touchdown = last.map(|ne| Landing::from_disarming(time.seconds_since(begin), ne));
        }
        Ok(track)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flight_log::Indexer;

    /// The fields of the logs: the time, the barometer, and a GPS frame without predictions.
    const HEADER: &str = "H Product:Blackbox flight data recorder by Nicholas Sherlock\nH Data version:2\n\
        H Field I name:loopIteration,time,baroAlt\nH Field I signed:0,0,1\nH Field I predictor:0,0,0\n\
        H Field I encoding:1,1,0\nH Field P predictor:0,0,0\nH Field P encoding:1,1,0\n\
        H Field S name:flightModeFlags\nH Field S signed:0\nH Field S predictor:0\nH Field S encoding:1\n\
        H Field H name:GPS_home[0],GPS_home[1]\nH Field H signed:1,1\nH Field H predictor:0,0\n\
        H Field H encoding:0,0\nH Field G name:time,GPS_numSat,GPS_coord[0],GPS_coord[1]\n\
        H Field G signed:0,0,1,1\nH Field G predictor:0,0,0,0\nH Field G encoding:1,1,0,0\n\
        H Firmware revision:Betaflight 2026.6.0 (1) SITL\nH Firmware type:Betaflight\nH I interval:1\n";

    /// The flags of the boxes in the order of this version.
    const ARMED: u32 = 1;
    const AUTOPILOT: u32 = 1 << 11;

    fn unsigned(bytes: &mut Vec<u8>, mut value: u32) {
        while value >= 0x80 {
            bytes.push(value as u8 | 0x80);
            value >>= 7;
        }
        bytes.push(value as u8);
    }

    fn signed(bytes: &mut Vec<u8>, value: i32) {
        unsigned(bytes, (value << 1) as u32 ^ (value >> 31) as u32);
    }

    /// Returns a log of 400 frames, 10 ms apart, of a craft that flies north from 47° N 8° E and climbs from 3 m of its
    /// barometer. From `engaged` on, AUTOPILOT is on. The log ends with a disarming.
    fn log(engaged: Option<u32>) -> Vec<u8> {
        let mut bytes = HEADER.as_bytes().to_vec();
        bytes.push(b'H');
        signed(&mut bytes, 470_000_000);
        signed(&mut bytes, 80_000_000);
        for at in 0..400 {
            let time_us = 5_000_000 + at * 10_000;
            if at == 0 || Some(at) == engaged {
                bytes.push(b'S');
                unsigned(&mut bytes, if at == 0 { ARMED } else { ARMED | AUTOPILOT });
            }
            if at % 10 == 0 {
                bytes.push(b'G');
                unsigned(&mut bytes, time_us);
                unsigned(&mut bytes, 12);
                signed(&mut bytes, 470_000_000 + at as i32);
                signed(&mut bytes, 80_000_000);
            }
            bytes.push(b'I');
            unsigned(&mut bytes, at);
            unsigned(&mut bytes, time_us);
            signed(&mut bytes, 300 + at as i32);
        }
        bytes.extend(b"E\x0f\x04E\xffEnd of log\0");
        bytes
    }

    fn only(bytes: &[u8]) -> LogFlight {
        Indexer::new(bytes).run().unwrap().flights.remove(0)
    }

    #[test]
    fn the_track_begins_with_the_autopilot_and_its_altitudes_count_from_the_ground() {
        let bytes = log(Some(100));
        let flight = only(&bytes);
        // The modes of a slow frame count from the main frame before it.
        assert_eq!(begin_of_log(&flight), SimTime(5_990_000));
        let track = Track::from_log(&flight, &bytes[..], 7).unwrap();
        assert_eq!((track.seed, track.result.as_str()), (7, "logged"));
        assert_eq!(track.samples.len(), 61, "twenty samples a second");
        let (first, last) = (track.samples[0], *track.samples.last().unwrap());
        assert!(first.time_s.abs() < 1e-9 && (first.alt_m - 0.99).abs() < 1e-9, "{first:?}");
        assert!((last.time_s - 3.0).abs() < 1e-9 && (last.alt_m - 3.99).abs() < 1e-9, "{last:?}");
        assert!((last.ne.x - 4.3).abs() < 0.1 && last.ne.y.abs() < 0.01, "{last:?}");
        assert!((track.flown_s.unwrap() - 3.0).abs() < 1e-9);
    }

    #[test]
    fn the_touchdown_is_where_the_craft_was_disarmed() {
        let bytes = log(Some(100));
        let track = Track::from_log(&only(&bytes), &bytes[..], 1).unwrap();
        let Landing { time_s, ne, .. } = track.touchdown.unwrap();
        assert!((time_s - 3.0).abs() < 0.011 && (ne.x - 4.3).abs() < 0.1, "{time_s} {ne:?}");
        assert!(track.reason.starts_with("disarmed: "), "{}", track.reason);
        // Without its end nobody knows where the craft landed.
        let cut = &bytes[..bytes.len() - 15];
        assert_eq!(Track::from_log(&only(cut), cut, 1).unwrap().touchdown, None);
    }

    #[test]
    fn a_log_without_autopilot_is_compared_from_its_first_frame_on() {
        let bytes = log(None);
        let flight = only(&bytes);
        assert_eq!(begin_of_log(&flight), SimTime(5_000_000));
        assert_eq!(Track::from_log(&flight, &bytes[..], 1).unwrap().samples.len(), 80);
    }
}
