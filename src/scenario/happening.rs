//! Happenings of a flight, in the words of expectations.

use strum::IntoEnumIterator as _;

use crate::signals::SimTime;
use crate::telemetry::quantity::Dimension;
use crate::telemetry::{DisarmReason, FaultKind, FenceAction, HoldLimit, Mode, NavState, PlanSource};

macro_rules! events {
    ($($variant:ident $name:literal [$($field:ident),*] $help:literal;)*) => {
        /// A kind of happening.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
        pub enum EventName {
            $(#[doc = $help] $variant,)*
        }

        /// All kinds, in the order of the reference.
        pub const EVENTS: &[EventInfo] = &[
            $(EventInfo { event: EventName::$variant, name: $name, fields: &[$(Field::$field),*], help: $help },)*
        ];
    };
}

/// A kind of happening with its name.
#[derive(Debug, Clone, Copy)]
pub struct EventInfo {
    /// The kind.
    pub event: EventName,
    /// The written name; words after it choose among its happenings.
    pub name: &'static str,
    /// The numbers of such a happening.
    pub fields: &'static [Field],
    /// A description for people.
    pub help: &'static str,
}

events! {
    Armed "armed" [] "the craft was armed";
    Disarmed "disarmed" [] "the craft was disarmed, with the reason";
    Engaged "engaged" [] "the autopilot began to fly a mission";
    Mode "mode" [] "a mode went on or off";
    Plan "plan" [Count] "another plan became the active one, with its source";
    Refused "engage_refused" [Wp, Distance, Limit] "the autopilot did not engage, with the reason";
    Geofence "geofence" [Distance, Limit] "the craft left the fence, with the reaction";
    RxLoss "rx_loss" [] "the receiver link was lost";
    RxRecovered "rx_recovered" [] "the receiver link came back";
    Failsafe "failsafe" [] "a failsafe stage began, with its number";
    GpsFix "gps_fix" [Sats] "the first fix, or the fix came back";
    GpsLost "gps_lost" [Sats] "the fix was lost";
    Fault "fault" [] "a fault began or ended";
    Contact "contact" [Impact] "a leg touched the ground";
    Touchdown "touchdown" [Impact, Peak] "the craft came to rest on the ground";
    Crash "crash" [] "the craft crashed";
    Battery "battery_low" [CellVoltage] "the firmware warned of the battery, with its level";
    BatteryEmpty "battery_empty" [CellVoltage] "all of the battery's charge was used";
    CannotHold "cannot_hold" [Distance, Vertical] "the navigator cannot hold its target, or can again, with the limit";
    HeadingDoubt "heading_doubt" [Error] "the magnetometer disagrees with the course, or agrees again";
    TiltDoubt "lean_doubt" [Error] "gyro and accelerometer disagree on the tilt, or agree again";
    Limited "limited" [TiltLimit] "the thrust was not enough for the commanded tilt";
    Climbing "climbing" [] "the climb before the first leg began or ended";
    Notice "notice" [] "the flight controller or the world reported something";
    Reply "reply" [] "the command line answered an input";
    Refusal "input_refused" [] "an input of the scenario was refused";
    Input "input" [] "an input of the scenario was carried out, by its name";
    End "end" [] "the flight ended, with its result";
}

macro_rules! fields {
    ($($variant:ident $name:literal $dimension:ident $help:literal;)*) => {
        /// A number that a happening has.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
        pub enum Field {
            $(#[doc = $help] $variant,)*
        }

        impl Field {
            /// Returns the name, the dimension and the meaning.
            pub fn info(self) -> (&'static str, Dimension, &'static str) {
                match self {
                    $(Self::$variant => ($name, Dimension::$dimension, $help),)*
                }
            }
        }
    };
}

fields! {
    Impact "impact" SPEED "sink rate at the contact";
    Peak "peak" ACCELERATION "maximum specific force since the contact";
    Distance "distance" LENGTH "horizontal distance";
    Vertical "vertical" LENGTH "vertical distance";
    Limit "limit" LENGTH "the fence";
    CellVoltage "cell_voltage" VOLTAGE "voltage of a cell";
    Error "error" ANGLE "heading or tilt error";
    TiltLimit "lean_limit" ANGLE "maximum tilt";
    Sats "sats" NONE "satellites in use";
    Count "count" NONE "waypoints in the plan";
    Wp "wp" NONE "index of the waypoint at fault";
}

impl EventName {
    /// Returns the name, the fields and the meaning.
    pub fn info(self) -> &'static EventInfo {
        &EVENTS[self as usize]
    }

    /// Returns the words that may follow the name.
    pub fn words(self) -> Vec<String> {
        let on_off = || ["on", "off"].map(str::to_owned);
        match self {
            Self::Disarmed => DisarmReason::iter().map(|reason| reason.to_string()).collect(),
            Self::Mode => Mode::iter().map(mode_word).chain(on_off()).collect(),
            Self::Plan => {
                [PlanSource::Stored, PlanSource::Rth, PlanSource::Emergency].map(|s| s.to_string()).to_vec()
            }
            Self::Refused => REFUSALS.map(str::to_owned).to_vec(),
            Self::Geofence => FenceAction::iter().map(|action| action.to_string()).collect(),
            Self::Failsafe => {
                ["1", "2", "DROP", "AUTO-LAND", "GPS-RESCUE", "CONTINUE", "LAND"].map(str::to_owned).to_vec()
            }
            Self::Fault => <FaultKind as strum::VariantNames>::VARIANTS
                .iter()
                .map(|&name| name.to_owned())
                .chain(on_off())
                .collect(),
            Self::Battery => ["WARNING", "CRITICAL", "EMPTY"].map(str::to_owned).to_vec(),
            Self::CannotHold => {
                let limits = [HoldLimit::Tilt, HoldLimit::Throttle, HoldLimit::Battery, HoldLimit::None];
                on_off().into_iter().chain(limits.map(|limit| limit.to_string())).collect()
            }
            Self::HeadingDoubt | Self::TiltDoubt | Self::Climbing => on_off().to_vec(),
            Self::End => RESULTS.map(str::to_owned).to_vec(),
            _ => Vec::new(),
        }
    }
}

/// The results of a flight; `stopped` is the result of a flight that its scenario ends.
pub const RESULTS: [&str; 10] = [
    "complete", "missed", "landed", "refused", "aborted", "disarmed", "crashed", "timeout", "diverged",
    "stopped",
];

/// The names of refusals (autopilot and abort).
pub(super) const REFUSALS: [&str; 16] = [
    "NOT_ARMED",
    "THROTTLE",
    "NO_FIX",
    "NO_ALTITUDE",
    "NO_HEADING",
    "NO_PLAN",
    "PLAN_CORRUPT",
    "BAD_WAYPOINT",
    "NO_HOME",
    "GEOFENCE",
    "THROTTLE_MIN",
    "FAILSAFE",
    "ABORTED",
    "STALLED",
    "FLYAWAY",
    "GPS_LOST",
];

/// Returns a mode as one word: `POS_HOLD`.
pub fn mode_word(mode: Mode) -> String {
    mode.to_string().replace(' ', "_")
}

/// A transition of the state machine.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Entered {
    /// The new state.
    pub state: NavState,
    /// Index of the current waypoint in the active plan.
    pub wp: u8,
    /// Origin of the active plan.
    pub source: PlanSource,
    /// The cause of the transition, as a word.
    pub reason: &'static str,
}

/// The kind of a happening.
#[derive(Debug, Clone, PartialEq)]
pub enum HappeningKind {
    /// The state machine entered a state.
    State(Entered),
    /// An event.
    Event {
        /// The kind of event.
        name: EventName,
        /// The words that tell this happening from others of its kind.
        words: Vec<String>,
        /// Its numbers, SI and degrees.
        fields: Vec<(Field, f64)>,
        /// A text for people; may be empty.
        text: String,
    },
}

/// A happening and its time.
#[derive(Debug, Clone, PartialEq)]
pub struct Happening {
    /// Simulated time since boot.
    pub time: SimTime,
    /// The kind.
    pub kind: HappeningKind,
}

impl Happening {
    /// Creates a happening that is not a state transition.
    pub fn event(time: SimTime, name: EventName, words: &[&str]) -> Self {
        let words = words.iter().map(|&word| word.to_owned()).collect();
        Self { time, kind: HappeningKind::Event { name, words, fields: Vec::new(), text: String::new() } }
    }

    /// Adds a number.
    pub fn with(mut self, field: Field, value: f64) -> Self {
        if let HappeningKind::Event { fields, .. } = &mut self.kind {
            fields.push((field, value));
        }
        self
    }

    /// Adds a text.
    pub fn saying(mut self, said: impl Into<String>) -> Self {
        if let HappeningKind::Event { text, .. } = &mut self.kind {
            *text = said.into();
        }
        self
    }

    /// Returns a number of the happening.
    pub fn field(&self, field: Field) -> Option<f64> {
        match &self.kind {
            HappeningKind::State(_) => None,
            HappeningKind::Event { fields, .. } => {
                fields.iter().find(|(known, _)| *known == field).map(|&(_, value)| value)
            }
        }
    }
}

/// A pattern of happenings, for an expectation or an instant.
#[derive(Debug, Clone, PartialEq)]
pub enum Pattern {
    /// The entry into a state.
    State {
        /// The state.
        state: NavState,
        /// Index of the waypoint; `None` = any.
        wp: Option<u8>,
        /// The origin of the plan; `None` = any.
        source: Option<PlanSource>,
        /// The cause of the transition, as a word; `None` = any.
        reason: Option<String>,
    },
    /// A happening of a kind that has all of these words and this text.
    Event {
        /// The kind of event.
        name: EventName,
        /// The words that the happening must have.
        words: Vec<String>,
        /// A part of the text; upper and lower case count as equal.
        text: Option<String>,
    },
}

impl Pattern {
    /// Returns `true` if the happening matches the pattern.
    pub fn matches(&self, happening: &Happening) -> bool {
        match (self, &happening.kind) {
            (Self::State { state, wp, source, reason }, HappeningKind::State(entered)) => {
                entered.state == *state
                    && wp.is_none_or(|wp| wp == entered.wp)
                    && source.is_none_or(|source| source == entered.source)
                    && reason.as_ref().is_none_or(|reason| reason.eq_ignore_ascii_case(entered.reason))
            }
            (
                Self::Event { name, words, text },
                HappeningKind::Event { name: happened, words: reported, text: said, .. },
            ) => {
                name == happened
                    && words
                        .iter()
                        .all(|word| reported.iter().any(|reported| reported.eq_ignore_ascii_case(word)))
                    && text.as_ref().is_none_or(|text| said.to_lowercase().contains(&text.to_lowercase()))
            }
            _ => false,
        }
    }

    /// Returns the numbers that a matching happening can have.
    pub fn fields(&self) -> &'static [Field] {
        match self {
            Self::State { .. } => &[],
            Self::Event { name, .. } => name.info().fields,
        }
    }
}

impl std::fmt::Display for Happening {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match &self.kind {
            HappeningKind::State(entered) => {
                write!(f, "{} {}", entered.state, entered.wp)?;
                if entered.source == PlanSource::Stored {
                    Ok(())
                } else {
                    write!(f, " of {}", entered.source)
                }
            }
            HappeningKind::Event { name, words, .. } => {
                f.write_str(name.info().name)?;
                words.iter().try_for_each(|word| write!(f, " {word}"))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_event_is_at_its_place() {
        for (index, info) in EVENTS.iter().enumerate() {
            assert_eq!(info.event as usize, index);
        }
    }

    #[test]
    fn a_pattern_asks_for_words_and_text_in_any_case() {
        let refused = Happening::event(SimTime::ZERO, EventName::Refused, &["GEOFENCE"])
            .saying("Waypoint 0 is 150 m from home, the fence is 100 m.");
        let pattern = |word: &str, text: &str| Pattern::Event {
            name: EventName::Refused,
            words: vec![word.to_owned()],
            text: Some(text.to_owned()),
        };
        assert!(pattern("geofence", "150 M").matches(&refused));
        assert!(!pattern("geofence", "151 m").matches(&refused));
        assert!(!pattern("NO_PLAN", "").matches(&refused));
    }
}
