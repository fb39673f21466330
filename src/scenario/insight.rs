//! The knowledge that is needed to judge a flight. Truth is always known; a remote flight controller reports only a
//! part.

use super::case::{Case, Expectation, Expected, Measured, StateStep, Window};
use super::expression::{Anchor, Bound, Comparison, Condition, Instant, Number, Place};
use super::happening::{EventName, Pattern};
use super::input::Action;
use crate::scenario::flag::Flag;
use crate::sim::{Fault, ScheduledFault, Switches};
use crate::telemetry::signal::Signal;
use crate::telemetry::{DisarmReason, PlanSource};
use crate::vehicle::{CommandKind, VehicleCommand};

/// The required knowledge of a flight controller, the least first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default, strum::Display)]
#[strum(serialize_all = "lowercase")]
pub enum Insight {
    /// Nothing: the simulated world is enough.
    #[default]
    Truth,
    /// Reports of every flight controller: modes, arming, fix, estimated position.
    Telemetry,
    /// Reports of a flight controller that has a command for the progress of its mission: state and waypoint.
    Mission,
    /// Knowledge that only the embedded flight controller gives: guards, setpoints, estimates, reasons.
    Inner,
}

impl Insight {
    /// Returns the missing knowledge as the end of a sentence.
    pub fn missing(self) -> &'static str {
        match self {
            Self::Truth | Self::Telemetry => "this flight controller reports nothing",
            Self::Mission => "this firmware does not report the progress of its mission",
            Self::Inner => "only the embedded firmware shows it",
        }
    }
}

impl Signal {
    /// Returns the knowledge that the signal needs.
    pub fn insight(self) -> Insight {
        match self {
            Self::Time
            | Self::BootTime
            | Self::North
            | Self::East
            | Self::Altitude
            | Self::Speed
            | Self::SpeedNorth
            | Self::SpeedEast
            | Self::Climb
            | Self::Roll
            | Self::Pitch
            | Self::Heading
            | Self::Course
            | Self::Tilt
            | Self::Force
            | Self::Motor1
            | Self::Motor2
            | Self::Motor3
            | Self::Motor4
            | Self::Battery
            | Self::Current
            | Self::Charge
            | Self::BatteryUsed
            | Self::Wind
            | Self::WindNorth
            | Self::WindEast => Insight::Truth,
            Self::EstNorth
            | Self::EstEast
            | Self::EstAltitude
            | Self::EstSpeed
            | Self::EstClimb
            | Self::EstRoll
            | Self::EstPitch
            | Self::EstHeading
            | Self::ReportedBattery
            | Self::ReportedCurrent
            | Self::ReportedCharge
            | Self::Satellites
            | Self::Cell => Insight::Telemetry,
            Self::Waypoint | Self::WpDistance => Insight::Mission,
            Self::CrossTrack
            | Self::TargetAltitude
            | Self::SpeedSetpoint
            | Self::HomeDistance
            | Self::FenceMargin
            | Self::HoldRemaining
            | Self::TouchdownHeld
            | Self::Hover
            | Self::RollDemand
            | Self::PitchDemand
            | Self::RollSetpoint
            | Self::PitchSetpoint
            | Self::Bearing
            | Self::TargetNorth
            | Self::TargetEast
            | Self::Throttle => Insight::Inner,
        }
    }
}

impl Flag {
    /// Returns the knowledge that the flag needs.
    pub fn insight(self) -> Insight {
        match self {
            Self::OnGround | Self::Crashed => Insight::Truth,
            Self::Armed | Self::Fix | Self::RxLink => Insight::Telemetry,
            Self::Engaged => Insight::Mission,
            Self::Climbing | Self::StickOverride | Self::CannotHold => Insight::Inner,
        }
    }
}

impl EventName {
    /// Returns the knowledge that is needed to see the event.
    pub fn insight(self) -> Insight {
        match self {
            Self::Fault
            | Self::Contact
            | Self::Touchdown
            | Self::Crash
            | Self::BatteryEmpty
            | Self::Input => Insight::Truth,
            Self::Armed
            | Self::Disarmed
            | Self::Mode
            | Self::RxLoss
            | Self::RxRecovered
            | Self::GpsFix
            | Self::GpsLost => Insight::Telemetry,
            Self::Engaged | Self::End => Insight::Mission,
            Self::Plan
            | Self::Refused
            | Self::Geofence
            | Self::Failsafe
            | Self::Battery
            | Self::CannotHold
            | Self::HeadingDoubt
            | Self::TiltDoubt
            | Self::Limited
            | Self::Climbing
            | Self::Notice
            | Self::Reply
            | Self::Refusal => Insight::Inner,
        }
    }
}

/// The knowledge that the parts of a case need.
#[derive(Debug)]
pub(super) struct Needs<'a> {
    /// The needs of the measures, in such an order that a measure comes after those it uses; parameters need nothing.
    measures: Vec<(&'a str, Insight)>,
}

impl<'a> Needs<'a> {
    pub(super) fn of(case: &'a Case) -> Self {
        let mut needs = Self { measures: Vec::new() };
        for measure in &case.measures {
            let insight = needs.measured(&measure.measured);
            needs.measures.push((&measure.name, insight));
        }
        needs
    }

    /// Returns the knowledge that is needed to carry out the inputs of a case and to end its flight in time. Without
    /// them a flight does not show the intended behaviour.
    pub(super) fn flight(&self, case: &Case) -> Insight {
        let switches = &case.setup.world.switches;
        let inputs =
            case.inputs.iter().map(|input| self.instant(&input.at).max(action(&input.action, switches)));
        let end = case.ends.as_ref().map_or(Insight::Truth, |end| self.instant(end));
        let is_idle = |scheduled: &ScheduledFault| !scheduled.fault.acts_on_remote_controller(switches);
        let faults = case.setup.world.faults.iter().any(is_idle);
        inputs.fold(if faults { Insight::Inner } else { end }, Insight::max)
    }

    pub(super) fn measure(&self, name: &str) -> Insight {
        let found = self.measures.iter().find(|(known, _)| *known == name);
        found.map_or(Insight::Truth, |&(_, insight)| insight)
    }

    pub(super) fn expectation(&self, expectation: &Expectation) -> Insight {
        let expected = match &expectation.expected {
            Expected::States(steps) if steps.iter().any(is_of_another_plan) => Insight::Inner,
            Expected::Result(_) | Expected::States(_) => Insight::Mission,
            Expected::Event { pattern, within, with, .. } => {
                let instant = within.as_ref().map_or(Insight::Truth, |(_, _, instant)| self.instant(instant));
                let with = with.as_ref().map_or(Insight::Truth, |with| self.condition(with));
                happening(pattern).max(instant).max(with)
            }
            Expected::NoEvent(pattern) => happening(pattern),
            Expected::Always(condition, _)
            | Expected::Eventually(condition)
            | Expected::Mostly(condition, _)
            | Expected::That(condition) => self.condition(condition),
            Expected::Statistic(_, comparison) => self.comparison(comparison),
            Expected::At(instant, condition) => self.instant(instant).max(self.condition(condition)),
        };
        expected.max(self.window(&expectation.window))
    }

    fn measured(&self, measured: &Measured) -> Insight {
        match measured {
            Measured::Over(window, _, number) => self.window(window).max(self.number(number)),
            Measured::At(instant, number) => self.instant(instant).max(self.number(number)),
            Measured::Time(from, to) => self.instant(from).max(self.instant(to)),
            Measured::Of(number) => self.number(number),
        }
    }

    fn window(&self, window: &Window) -> Insight {
        let ends = window.from.iter().chain(&window.until);
        ends.map(|instant| self.instant(instant)).fold(Insight::Truth, Insight::max)
    }

    fn instant(&self, instant: &Instant) -> Insight {
        let anchor = match &instant.anchor {
            Anchor::Boot | Anchor::Last => Insight::Truth,
            Anchor::Happening(pattern) => happening(pattern),
            Anchor::When(condition) => self.condition(condition),
        };
        anchor.max(instant.after.as_deref().map_or(Insight::Truth, |after| self.instant(after)))
    }

    fn condition(&self, condition: &Condition) -> Insight {
        match condition {
            Condition::Compare(comparison) => self.comparison(comparison),
            Condition::Flag(flag) => flag.insight(),
            Condition::State(..) => Insight::Mission,
            Condition::Mode(_) => Insight::Telemetry,
            Condition::Flying(_) => Insight::Inner,
            Condition::Not(inner) => self.condition(inner),
            Condition::All(parts) | Condition::Any(parts) => {
                parts.iter().map(|part| self.condition(part)).fold(Insight::Truth, Insight::max)
            }
        }
    }

    fn comparison(&self, comparison: &Comparison) -> Insight {
        let bound = match &comparison.bound {
            Bound::AtMost(number, _) | Bound::AtLeast(number, _) | Bound::Equal(number) => {
                self.number(number)
            }
            Bound::Between(first, second) | Bound::Around(first, second) => {
                self.number(first).max(self.number(second))
            }
        };
        self.number(&comparison.left).max(bound)
    }

    fn number(&self, number: &Number) -> Insight {
        match number {
            // The happening with this number was reported.
            Number::Literal(..) | Number::Field(_) => Insight::Truth,
            Number::Signal(signal) => signal.insight(),
            Number::Name(name) => self.measure(name),
            Number::Negative(inner) | Number::Rate(inner) => self.number(inner),
            Number::Join(_, left, right) => self.number(left).max(self.number(right)),
            Number::Call(_, arguments) => {
                arguments.iter().map(|argument| self.number(argument)).fold(Insight::Truth, Insight::max)
            }
            Number::Distance(place) | Number::Bearing(place) => self.place(place),
            Number::Apart(from, to)
            | Number::Along(from, to)
            | Number::Across(from, to)
            | Number::Past(from, to) => self.place(from).max(self.place(to)),
            Number::Since(instant) => self.instant(instant),
            Number::At(inner, instant) => self.number(inner).max(self.instant(instant)),
        }
    }

    fn place(&self, place: &Place) -> Insight {
        match place {
            Place::Home | Place::Offset(..) | Place::Waypoint(_, PlanSource::Stored) => Insight::Truth,
            Place::Waypoint(..) | Place::Target => Insight::Inner,
            Place::CraftAt(instant) => self.instant(instant),
        }
    }
}

/// Returns the knowledge that is needed to see such a happening.
fn happening(pattern: &Pattern) -> Insight {
    /// Reasons that a remote flight controller can report.
    const SEEN: [DisarmReason; 3] = [DisarmReason::Landing, DisarmReason::Switch, DisarmReason::Failsafe];
    match pattern {
        Pattern::State { source: None | Some(PlanSource::Stored), reason: None, .. } => Insight::Mission,
        Pattern::State { .. } => Insight::Inner,
        Pattern::Event { name: EventName::Disarmed, words, .. } if !words.is_empty() => {
            let is_seen =
                |word: &String| SEEN.iter().any(|reason| reason.to_string().eq_ignore_ascii_case(word));
            if words.iter().all(is_seen) { Insight::Mission } else { Insight::Inner }
        }
        Pattern::Event { name, .. } => name.insight(),
    }
}

/// Returns `true` for a state in a plan that a remote flight controller does not report.
fn is_of_another_plan(step: &StateStep) -> bool {
    matches!(step, StateStep::Enter { source: Some(source), .. } if *source != PlanSource::Stored)
}

/// Returns the knowledge that an action needs. The world and the transmitter belong to betadeck. Some faults have no
/// effect on a remote firmware, and only the embedded firmware takes orders.
fn action(action: &Action, switches: &Switches) -> Insight {
    let is_idle = |fault: &Fault| !fault.acts_on_remote_controller(switches);
    match action {
        Action::Vehicle(VehicleCommand::World(command)) if command.fault().is_some_and(is_idle) => {
            Insight::Inner
        }
        Action::Vehicle(command) => match command.kind() {
            CommandKind::World | CommandKind::Reset | CommandKind::Rc | CommandKind::Pilot => Insight::Truth,
            CommandKind::Return | CommandKind::Order | CommandKind::Session | CommandKind::Configuration => {
                Insight::Inner
            }
        },
        Action::Stick { .. } | Action::Switch(..) | Action::CutRc(_) | Action::RestoreRc => Insight::Truth,
    }
}
