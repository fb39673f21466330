//! The frames beside the main frames: modes and states, home, and solutions of the GPS.

use strum::IntoEnumIterator as _;

use crate::blackbox::Predictor::{HomeCoordinate, LastMainFrameTime, Zero};
use crate::blackbox::encode::Coding::{SignedVb, Tag2_3S32, UnsignedVb};
use crate::blackbox::encode::{FieldGroup, Rule};
use crate::firmware::Firmware;
use crate::firmware::modes::BoxSet;
use crate::firmware::msp::UtcTime;
use crate::geo::LatLon;
use crate::math;
use crate::signals::{GpsSample, SIMULATED_BOOT_UNIX_S, SimTime};
use crate::telemetry::ModeBox;

/// The boxes that fit the 32 bits of a log.
const LOGGED_BOXES: usize = 32;

/// The time of boot in the GPS week: a Thursday, and 18 leap seconds, ms.
const BOOT_WEEK_MS: u64 = (4 * 86_400 + 18) * 1000;
const WEEK_MS: u64 = 7 * 86_400 * 1000;

#[rustfmt::skip]
pub(super) const SLOW: [FieldGroup; 2] = [
    FieldGroup::side(&["flightModeFlags", "stateFlags"], false, Rule(Zero, UnsignedVb)),
    FieldGroup::side(&["failsafePhase", "rxSignalReceived", "rxFlightChannelsValid"], false, Rule(Zero, Tag2_3S32)),
];

#[rustfmt::skip]
pub(super) const HOME: [FieldGroup; 2] = [
    FieldGroup::side(&["GPS_home[0]", "GPS_home[1]", "GPS_home[2]"], true, Rule(Zero, SignedVb)),
    FieldGroup::side(&["GPS_home_epoch"], false, Rule(Zero, UnsignedVb)),
];

#[rustfmt::skip]
pub(super) const GPS: [FieldGroup; 7] = [
    FieldGroup::side(&["time"], false, Rule(LastMainFrameTime, UnsignedVb)),
    FieldGroup::side(&["GPS_numSat"], false, Rule(Zero, UnsignedVb)),
    FieldGroup::side(&["GPS_coord[0]", "GPS_coord[1]"], true, Rule(HomeCoordinate, SignedVb)),
    FieldGroup::side(&["GPS_altitude"], true, Rule(Zero, SignedVb)),
    FieldGroup::side(&["GPS_speed", "GPS_ground_course"], false, Rule(Zero, UnsignedVb)),
    FieldGroup::side(&["GPS_velned[0]", "GPS_velned[1]", "GPS_velned[2]"], true, Rule(Zero, SignedVb)),
    FieldGroup::side(&["GPS_time"], false, Rule(Zero, UnsignedVb)),
];

/// The phases of the failsafe in a log.
const RX_LOSS_DETECTED: i32 = 1;
const LANDING: i32 = 2;
const RX_LOSS_MONITORING: i32 = 4;
const RESCUE: i32 = 6;

/// Returns the boxes as bits by their index in the order of protocols.
pub(super) fn box_mask(boxes: BoxSet) -> u32 {
    let on = |(bit, entry): (u32, ModeBox)| u32::from(boxes.has(entry as u8)) << bit;
    (0..).zip(ModeBox::iter()).take(LOGGED_BOXES).map(on).fold(0, |mask, bit| mask | bit)
}

/// Returns the date and time of an instant.
pub(super) fn utc(time: SimTime) -> UtcTime {
    let unix_s = SIMULATED_BOOT_UNIX_S + time.0 / 1_000_000;
    UtcTime { unix_s: unix_s as u32, millis: (time.0 / 1000 % 1000) as u16 }
}

/// The values of an `S`, an `H` and a `G` frame.
pub type SlowValues = [i32; 5];
pub type HomeValues = [i32; 4];
pub type GpsValues = [i32; 11];

/// Returns the present modes and states. `boxes` are the switched boxes as bits.
// Inlined, because the result would otherwise be compared through memory in every loop with a frame.
#[inline(always)]
pub(super) fn slow_values(firmware: &Firmware, boxes: u32) -> SlowValues {
    let (failsafe, receiver) = (&firmware.navigation.failsafe, firmware.receiver());
    let phase = if failsafe.auto_landing() {
        LANDING
    } else if failsafe.landed() {
        RX_LOSS_MONITORING
    } else if failsafe.mission().is_some() {
        RESCUE
    } else if failsafe.stage() == 1 {
        RX_LOSS_DETECTED
    } else {
        0
    };
    let states = i32::from(firmware.home().is_some()) | i32::from(firmware.gps_fix()) << 1;
    let (signal, channels) = (receiver.signal().into(), receiver.has_valid_channels().into());
    [boxes.cast_signed(), states, phase, signal, channels]
}

/// The home of a log.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct LoggedHome {
    place: LatLon,
    alt_amsl_cm: i32,
    /// The time at which it was first seen.
    since: SimTime,
}

impl LoggedHome {
    /// Returns the present home; `known` if it has not changed. Without a home the place is zero.
    pub(super) fn of(firmware: &Firmware, known: Self) -> Self {
        let place = firmware.home().unwrap_or_default();
        let alt_amsl_cm = firmware.safety.home_alt_amsl_cm.unwrap_or_default();
        let is_known = (place, alt_amsl_cm) == (known.place, known.alt_amsl_cm);
        if is_known { known } else { Self { place, alt_amsl_cm, since: firmware.now } }
    }

    /// Returns the values of an `H` frame.
    pub(super) fn values(&self) -> HomeValues {
        let since = utc(self.since).unix_s.cast_signed();
        [self.place.lat_e7, self.place.lon_e7, self.alt_amsl_cm / 10, since]
    }
}

/// Returns the values of a `G` frame of this solution.
pub(super) fn gps_values(firmware: &Firmware, solution: &GpsSample) -> GpsValues {
    let (east, north, up) = (solution.vel_enu.x, solution.vel_enu.y, solution.vel_enu.z);
    let course_deg = math::atan2(east, north).to_degrees().rem_euclid(360.0);
    let week_ms = (BOOT_WEEK_MS + firmware.now.0 / 1000) % WEEK_MS;
    let whole = |value: f64| value.round() as i32;
    [
        firmware.now.0 as i32,
        firmware.estimate().gps.sats.into(),
        solution.position.lat_e7,
        solution.position.lon_e7,
        solution.alt_amsl_cm / 10,
        whole(100.0 * math::hypot(east, north)),
        whole(10.0 * course_deg) % 3600,
        whole(100.0 * north),
        whole(100.0 * east),
        whole(-100.0 * up),
        week_ms as i32,
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::firmware::modes::boxes;

    #[test]
    fn boxes_have_the_bits_of_their_place_in_the_list() {
        let mut set = BoxSet::NONE;
        set.set(boxes::ARM, true);
        assert_eq!(box_mask(set), 1);
        set.set(boxes::ANGLE, true);
        set.set(boxes::AUTOPILOT, true);
        assert_eq!(box_mask(set), 1 | 1 << 1 | 1 << 11);
        set.set(ModeBox::WpCapture as u8, true);
        assert_eq!(box_mask(set), 1 | 1 << 1 | 1 << 11, "beyond the 32 bits");
    }
}
