//! Mission items, and their two forms on the wire.

use super::message;
use super::value::{MissionResult, position_frame};

/// An item of a mission, a fence or a set of rally points, as raw as on the wire.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct MissionItem {
    /// The frame of the position: [`position_frame`].
    pub frame: u8,
    /// The command: [`command`](super::value::command).
    pub command: u16,
    /// Parameters 1 to 4. NaN is "not given".
    pub params: [f32; 4],
    /// Latitude, 1e-7°; parameter 5 in a frame without position.
    pub x: i32,
    /// Longitude, 1e-7°; parameter 6 in a frame without position.
    pub y: i32,
    /// Altitude in the frame, m; parameter 7 in a frame without position.
    pub z: f32,
    /// `true` for the item that is flown to next.
    pub is_current: bool,
    /// `true` if the next item follows on its own.
    pub autocontinue: bool,
}

/// Where an item goes, and its number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Address {
    pub(super) system: u8,
    pub(super) component: u8,
    pub(super) kind: u8,
    pub(super) seq: u16,
}

impl MissionItem {
    /// Returns the item of a message.
    pub(super) fn from_int(item: &message::MissionItemInt) -> Self {
        Self {
            frame: item.frame,
            command: item.command,
            params: [item.param1, item.param2, item.param3, item.param4],
            x: item.x,
            y: item.y,
            z: item.z,
            is_current: item.current == 1,
            autocontinue: item.autocontinue != 0,
        }
    }

    /// Returns the item of a message of the old kind.
    ///
    /// # Errors
    ///
    /// Fails for a position that is not finite or not on the globe.
    pub(super) fn from_float(item: &message::MissionItemFloat) -> Result<Self, MissionResult> {
        let whole = |value: f32, limit: f64, error| {
            let value = f64::from(value);
            if position_frame::is_global(item.frame) {
                let is_on_globe = value.abs() <= limit;
                if is_on_globe { Ok((value * 1e7).round() as i32) } else { Err(error) }
            } else if value.is_finite() {
                Ok((value * scale(item.frame)).round() as i32)
            } else {
                // A parameter that is not given.
                Ok(0)
            }
        };
        Ok(Self {
            frame: item.frame,
            command: item.command,
            params: [item.param1, item.param2, item.param3, item.param4],
            x: whole(item.x, 90.0, MissionResult::InvalidX)?,
            y: whole(item.y, 360.0, MissionResult::InvalidY)?,
            z: item.z,
            is_current: item.current == 1,
            autocontinue: item.autocontinue != 0,
        })
    }

    pub(super) fn to_int(self, to: Address) -> message::MissionItemInt {
        let [param1, param2, param3, param4] = self.params;
        message::MissionItemInt {
            param1,
            param2,
            param3,
            param4,
            x: self.x,
            y: self.y,
            z: self.z,
            seq: to.seq,
            command: self.command,
            target_system: to.system,
            target_component: to.component,
            frame: self.frame,
            current: u8::from(self.is_current),
            autocontinue: u8::from(self.autocontinue),
            mission_type: to.kind,
        }
    }

    pub(super) fn to_float(self, to: Address) -> message::MissionItemFloat {
        let [param1, param2, param3, param4] = self.params;
        let narrow = |value: i32| (f64::from(value) / scale(self.frame)) as f32;
        message::MissionItemFloat {
            param1,
            param2,
            param3,
            param4,
            x: narrow(self.x),
            y: narrow(self.y),
            z: self.z,
            seq: to.seq,
            command: self.command,
            target_system: to.system,
            target_component: to.component,
            frame: self.frame,
            current: u8::from(self.is_current),
            autocontinue: u8::from(self.autocontinue),
            mission_type: to.kind,
        }
    }
}

/// Returns the whole numbers for one unit of a position.
fn scale(frame: u8) -> f64 {
    match frame {
        position_frame::MISSION => 1.0,
        frame if position_frame::is_global(frame) => 1e7,
        // Metres in a local frame.
        _ => 1e4,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TO: Address = Address { system: 255, component: 190, kind: 1, seq: 7 };

    #[test]
    fn an_item_survives_both_forms() {
        for frame in [0, 1, 2, 3, 10] {
            let item = MissionItem {
                frame,
                command: 16,
                params: [1.0, 2.0, 3.0, 4.0],
                x: 40 * if frame == 2 { 1 } else { 10_000_000 },
                y: -80,
                z: 50.0,
                is_current: true,
                autocontinue: true,
            };
            assert_eq!(MissionItem::from_int(&item.to_int(TO)), item);
            assert_eq!(MissionItem::from_float(&item.to_float(TO)), Ok(item));
            assert_eq!((item.to_int(TO).seq, item.to_int(TO).mission_type), (7, 1));
        }
    }

    #[test]
    fn a_position_that_is_no_place_is_refused() {
        let item = |frame, x, y| {
            MissionItem::from_float(&message::MissionItemFloat { frame, x, y, ..Default::default() })
        };
        assert_eq!(item(3, f32::NAN, 0.0), Err(MissionResult::InvalidX));
        assert_eq!(item(3, 0.0, f32::INFINITY), Err(MissionResult::InvalidY));
        assert_eq!(item(3, 91.0, 0.0), Err(MissionResult::InvalidX));
        assert_eq!(item(2, f32::NAN, 1e30).unwrap().y, i32::MAX);
    }
}
