//! The items of MAVLink missions as plain data, and both ways between items and waypoints.
//!
//! `to_plan` gives items their meaning as a `mapping`, `jump` unrolls their jumps, `of_plan` makes items of a plan, and `command` is
//! the table of the commands without a place in a plan. The readers and writers of the files are the users.

mod command;
mod jump;
mod mapping;
mod of_plan;
#[cfg(test)]
pub(super) mod tests;
mod to_plan;

pub(super) use mapping::Mapping;
pub(super) use of_plan::{Sent, send};
pub(super) use to_plan::Mission;

use super::bounds::Reference;
use super::loss::Place;
use super::{HomePosition, ReadOptions};
use crate::geo::LatLon;
use crate::plan::Altitude;

/// The numbers of the commands that are also written.
const WAYPOINT: u16 = 16;
const LOITER_UNLIMITED: u16 = 17;
const LOITER_TURNS: u16 = 18;
const LOITER_TIME: u16 = 19;
const LAND: u16 = 21;
const TAKEOFF: u16 = 22;
const CHANGE_SPEED: u16 = 178;
const YAW_SPEED: u16 = 213;

/// The frame of a position with an altitude above sea level.
pub(super) const ABOVE_SEA: u16 = 0;
/// The frame of a command without a position.
pub(super) const NO_PLACE: u16 = 2;
/// The frame of a position with an altitude above home.
pub(super) const ABOVE_HOME: u16 = 3;

/// An item of a mission.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct MissionItem {
    /// The number by which the file counts the item, the target of a jump.
    pub(super) number: usize,
    pub(super) command: u16,
    pub(super) frame: u16,
    /// The parameters 1 to 4; `None` = not given, which is NaN on the link.
    pub(super) params: [Option<f64>; 4],
    /// Degrees; of a command without a position, parameter 5.
    pub(super) lat_deg: Option<f64>,
    /// Degrees; of a command without a position, parameter 6.
    pub(super) lon_deg: Option<f64>,
    /// Metres in the reference of the frame; of a command without a position, parameter 7.
    pub(super) altitude_m: Option<f64>,
    pub(super) autocontinue: bool,
    pub(super) place: Option<Place>,
}

impl MissionItem {
    /// Returns a parameter, from 1 to 4; 0 if it is not given.
    fn param(&self, number: usize) -> f64 {
        self.params.get(number.wrapping_sub(1)).copied().flatten().unwrap_or(0.0)
    }

    /// Returns the position as it is given. A position of exactly 0,0 is not given.
    fn degrees(&self) -> Option<(f64, f64)> {
        let (lat, lon) = (self.lat_deg?, self.lon_deg?);
        (lat != 0.0 || lon != 0.0).then_some((lat, lon))
    }

    /// Returns the reference of the altitude.
    ///
    /// # Errors
    ///
    /// Returns the reason if the frame is local, or the item has no position.
    fn reference(&self) -> Result<Reference, String> {
        match self.frame {
            0 | 5 => Ok(Reference::SeaLevel),
            3 | 6 => Ok(Reference::Home),
            10 | 11 => Ok(Reference::Ground),
            2 => Err("frame 2 has no position".to_owned()),
            frame => Err(format!("frame {frame} is not one of a plan, allowed: 0, 3, 5, 6, 10, 11")),
        }
    }

    /// Returns `true` if the item is a part of a fence or a rally point.
    pub(super) fn is_fence(&self) -> bool {
        (5000..=5004).contains(&self.command)
    }

    /// Returns `true` if the item is a rally point.
    pub(super) fn is_rally(&self) -> bool {
        self.command == 5100
    }

    /// Returns `true` if the item is the home with which Mission Planner, MAVProxy and QGroundControl begin a file.
    pub(super) fn is_home(&self) -> bool {
        self.command == WAYPOINT && self.frame == ABOVE_SEA
    }
}

/// Returns the home of a file, completed by that of the user. A home at exactly 0,0 is not given.
pub(super) fn home(of_file: Option<HomePosition>, options: &ReadOptions) -> Option<HomePosition> {
    match of_file.filter(|home| home.position != LatLon::default()) {
        Some(home) => {
            let amsl_m = home.amsl_m.or_else(|| options.home.and_then(|given| given.amsl_m));
            Some(HomePosition { amsl_m, ..home })
        }
        None => options.home,
    }
}

/// Returns a position that a file of MAVLink items can hold. The second value is `true` if it is moved by 1e-7° since
/// 0,0 would mean that there is none.
pub(super) fn written_position(position: LatLon) -> (LatLon, bool) {
    if position == LatLon::default() { (LatLon::new(1, 0), true) } else { (position, false) }
}

/// Returns a value to two decimals with its unit.
fn amount(value: f64, unit: &str) -> String {
    format!("{} {unit}", (value * 100.0).round() / 100.0)
}

/// Returns an altitude with its unit.
fn metres(altitude: Altitude) -> String {
    amount(altitude.above_home_m(), "m")
}
