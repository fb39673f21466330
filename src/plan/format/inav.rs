//! Missions of INAV: its mission items, and the two forms of their files.
//!
//! * [`mw_xml`] is MW-XML (`.mission`), as mwp, the INAV configurator and the older MultiWii tools write it.
//! * [`cli`] is the `wp` lines of INAV's CLI.
//! * `to_plan` and `from_plan` convert the items of both.

pub(super) mod cli;
mod from_plan;
pub(super) mod mw_xml;
mod private;
mod to_plan;
mod unroll;

use std::ops::Range;

use super::loss::Finding;
use super::{Problems, bounds};
use crate::geo::LatLon;

/// The action of an item. The discriminant is its code in the CLI.
#[derive(
    Debug,
    Clone,
    Copy,
    PartialEq,
    Eq,
    strum::Display,
    strum::EnumString,
    strum::EnumIter,
    strum::FromRepr,
    strum::IntoStaticStr,
)]
#[strum(serialize_all = "SCREAMING_SNAKE_CASE", ascii_case_insensitive)]
#[repr(u8)]
enum Action {
    Unassigned = 0,
    Waypoint = 1,
    PosholdUnlim = 2,
    PosholdTime = 3,
    Rth = 4,
    SetPoi = 5,
    Jump = 6,
    SetHead = 7,
    Land = 8,
}

impl Action {
    /// Returns `true` if the craft flies to the position of the item.
    const fn has_place(self) -> bool {
        matches!(self, Self::Waypoint | Self::PosholdUnlim | Self::PosholdTime | Self::Land)
    }
}

/// The flag of the last item of a mission.
const LAST: i32 = 165;
/// The flag of an item at the home of the flight.
const AT_HOME: i32 = 72;
/// The bit of `p3` of an altitude above sea level.
const SEA_LEVEL: i32 = 1;
/// The bits of `p3` of user actions.
const USER_ACTIONS: i32 = 0b1_1110;
/// The greatest leg speed that INAV ignores, cm/s.
const IGNORED_CMS: i32 = 50;

/// A mission item as INAV stores it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Item {
    action: Action,
    position: LatLon,
    alt_cm: i32,
    p1: i32,
    p2: i32,
    p3: i32,
    flag: i32,
}

impl Item {
    /// Returns `true` if the position of the item is the home of the flight.
    fn is_at_home(&self) -> bool {
        self.flag == AT_HOME || self.position == LatLon::default()
    }
}

/// The place nearest to 0,0, which INAV takes for the home of the flight.
const NEAR_ZERO: LatLon = LatLon::new(1, 0);

/// Returns the position that INAV takes for itself.
fn as_place(position: LatLon) -> LatLon {
    if position == LatLon::default() { NEAR_ZERO } else { position }
}

/// An item of a file.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Found {
    item: Item,
    /// The number of the item in its mission, as the format counts.
    number: usize,
    /// The number that the file gives it.
    label: usize,
    span: Range<usize>,
}

/// One mission of a file.
#[derive(Debug, Default)]
struct Mission {
    items: Vec<Found>,
    /// The home; INAV itself takes the place of arming.
    home: Option<LatLon>,
}

/// The contents of a file.
#[derive(Debug, Default)]
struct Contents {
    missions: Vec<Mission>,
    /// The findings about the parts that are no items.
    findings: Vec<Finding>,
    /// The text of the private data.
    private: Option<String>,
}

/// A form of files with INAV items.
#[derive(Debug, Clone, Copy)]
struct Form {
    /// The number of the first item.
    first: usize,
    /// Altitudes are whole metres.
    whole_metres: bool,
    /// The file has the home.
    has_home: bool,
}

/// The altitude of an item in metres as centimetres.
///
/// # Errors
///
/// Returns the reason: the value is out of range.
fn altitude_cm(metres: f64) -> Result<i32, String> {
    bounds::altitude_m(metres).map(|metres| (metres * 100.0).round() as i32)
}

/// Reads a parameter or a flag.
fn whole(what: &str, text: &str, span: Range<usize>, problems: &mut Problems<'_>) -> Option<i32> {
    let text = text.trim();
    match text.parse::<i16>() {
        Ok(value) => Some(value.into()),
        Err(_) => {
            let fault = if text.parse::<i64>().is_ok() { "out of range" } else { "not a whole number" };
            let hint = format!("allowed: {} to {}", i16::MIN, i16::MAX);
            problems.add(span, format!("{what} {text} is {fault}"), hint);
            None
        }
    }
}

#[cfg(test)]
mod tests;
