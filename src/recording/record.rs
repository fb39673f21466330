//! The kinds of lines of a recording.

use serde::{Deserialize, Serialize};

use super::event::Happened;
use super::input::Input;
use super::picture::{Scene, Shot};
use super::setup::Setup;
use crate::signals::SimTime;

/// The version of the format. A later version can still be read if it only adds lines or keys.
pub const FORMAT: u32 = 1;

/// The first line.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct Header {
    /// The version of the format.
    pub format: u32,
    /// The version of the program, with its revision.
    pub program: String,
    /// The date and time at which the recording began, UTC: `2026-05-09T07:29:33Z`.
    pub date: String,
    /// The name of the plan.
    pub plan: String,
}

/// The beginning of the flight that the recording is about. Inputs may be older, back to boot.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub(super) struct Begin {
    pub t: SimTime,
}

/// The last line.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct End {
    /// The time of the end, since boot.
    pub t: SimTime,
    /// The result in a word, such as `complete`.
    pub result: String,
    /// The reason, a sentence without its full stop.
    pub reason: String,
    /// The duration of the flight, s.
    pub flown_s: f64,
    /// The hash of the flight; `None` if it cannot be flown again.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub hash: Option<String>,
}

/// A line. Times are microseconds since boot.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum Record {
    Flight(Header),
    Setup(Box<Setup>),
    /// A command before the tick at this time.
    Input(SimTime, Input),
    Begin(Begin),
    Event(SimTime, Happened),
    /// The rarely changing part of the pictures that follow.
    Scene(Box<Scene>),
    Picture(Box<Shot>),
    /// The flight continued from this earlier instant, with this many inputs since boot. What was recorded after it is left.
    Branch {
        t: SimTime,
        inputs: usize,
    },
    /// The recording lacks inputs from here on, so it cannot be flown again. The text is the end of a sentence.
    Gap(String),
    End(End),
}
