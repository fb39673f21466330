//! The inputs of a case, carried out at their instants.

use crate::firmware::cli::RefusedLine;
use crate::pilot::StickInput;
use crate::scenario::expression::{Evaluator, Lookups, Search};
use crate::scenario::happening::{EventName, Happening};
use crate::scenario::input::{Action, TimedInput};
use crate::scenario::trace::Trace;
use crate::signals::SimTime;
use crate::telemetry::Mode;
use crate::telemetry::switch::Switch;
use crate::vehicle::{Answer, Reply, Vehicle, VehicleCommand};

/// The remaining inputs.
#[derive(Debug)]
pub(super) struct Inputs<'a> {
    waiting: Vec<Waiting<'a>>,
    /// The time at which the transmitter is restored.
    restore_at: Option<SimTime>,
}

/// An input that waits for its instant.
#[derive(Debug)]
struct Waiting<'a> {
    input: &'a TimedInput,
    search: Search<'a>,
    due_us: Option<i64>,
}

impl<'a> Inputs<'a> {
    pub(super) fn new(inputs: &'a [TimedInput]) -> Self {
        let waiting = inputs
            .iter()
            .map(|input| Waiting { input, search: Search::new(&input.at), due_us: None })
            .collect();
        Self { waiting, restore_at: None }
    }

    /// Checks which instants have come.
    pub(super) fn look(&mut self, evaluator: &Evaluator<'_>) {
        for waiting in self.waiting.iter_mut().filter(|waiting| waiting.due_us.is_none()) {
            waiting.due_us = waiting.search.advance(evaluator);
        }
    }

    /// Returns `true` if an action is due before the tick at this time.
    pub(super) fn is_due(&self, now: SimTime) -> bool {
        self.restore_at.is_some_and(|at| now >= at)
            || self.waiting.iter().any(|waiting| waiting.is_due(now))
            // Instants that wait for nothing are checked before the first tick.
            || now == SimTime::ZERO
    }

    /// Carries out the due actions, in the order of the file.
    pub(super) fn carry_out(
        &mut self,
        vehicle: &mut Vehicle,
        trace: &mut Trace,
        (names, lookups): (&[(String, f64)], &Lookups),
    ) {
        let now = vehicle.time();
        if now == SimTime::ZERO {
            self.look(&Evaluator::in_flight(trace, names, lookups));
        }
        if self.restore_at.is_some_and(|at| now >= at) {
            self.restore_at = None;
            apply(vehicle, &VehicleCommand::CutRc(false));
        }
        let mut due: Vec<(i64, &TimedInput)> = Vec::new();
        self.waiting.retain_mut(|waiting| {
            let (true, Some(us)) = (waiting.is_due(now), waiting.due_us) else { return true };
            due.push((us, waiting.input));
            if waiting.input.each {
                waiting.due_us = None;
                waiting.search.go_on();
            }
            waiting.input.each
        });
        due.sort_by_key(|&(us, _)| us);
        for (_, input) in due {
            trace
                .happenings
                .push(Happening::event(now, EventName::Input, &[&input.name]).saying(&input.text));
            let said = self.act(&input.action, vehicle);
            trace
                .happenings
                .extend(said.into_iter().map(|(name, text)| Happening::event(now, name, &[]).saying(text)));
        }
    }

    /// Carries out an action and returns the replies.
    fn act(&mut self, action: &Action, vehicle: &mut Vehicle) -> Vec<(EventName, String)> {
        match action {
            Action::Vehicle(command) => apply(vehicle, command),
            Action::Stick { channel, value_us, for_s } => hold_channel(vehicle, *channel, *value_us, *for_s),
            Action::Switch(mode, on) => match switch_value(vehicle, *mode, *on) {
                Some((channel, value_us)) => {
                    apply(vehicle, &VehicleCommand::ReleaseChannel(channel));
                    hold_channel(vehicle, channel, value_us, None)
                }
                None => vec![(EventName::Refusal, format!("no channel switches {mode}"))],
            },
            Action::CutRc(for_s) => {
                self.restore_at = for_s.map(|for_s| SimTime(vehicle.time().0 + (for_s * 1e6).round() as u64));
                apply(vehicle, &VehicleCommand::CutRc(true))
            }
            Action::RestoreRc => {
                self.restore_at = None;
                apply(vehicle, &VehicleCommand::CutRc(false))
            }
        }
    }
}

impl Waiting<'_> {
    fn is_due(&self, now: SimTime) -> bool {
        self.due_us.is_some_and(|us| now.0 as i64 >= us)
    }
}

/// Carries out a command and returns the replies.
fn apply(vehicle: &mut Vehicle, command: &VehicleCommand) -> Vec<(EventName, String)> {
    match (command, vehicle.apply(command)) {
        (_, Answer::Now(Reply::Refused(refusal))) => vec![(EventName::Refusal, refusal.to_string())],
        (_, Answer::Now(Reply::Uploaded(replies))) => {
            replies.into_iter().map(|reply| (EventName::Reply, reply)).collect()
        }
        (VehicleCommand::Line(line), Answer::Now(Reply::Line(answer))) => {
            let reply = answer.text.trim().to_owned();
            let mut said = vec![(EventName::Reply, reply.clone())];
            if answer.failed {
                let refused = RefusedLine { line: line.line.clone(), reply };
                said.push((EventName::Refusal, refused.to_string()));
            }
            said
        }
        _ => Vec::new(),
    }
}

fn hold_channel(
    vehicle: &mut Vehicle,
    channel: u8,
    value_us: u16,
    for_s: Option<f64>,
) -> Vec<(EventName, String)> {
    let at_s = vehicle.time().as_secs_f64();
    let input = StickInput { channel, value_us, at_s, for_s, from_boot: true };
    apply(vehicle, &VehicleCommand::HoldChannel(input))
}

/// Returns the channel that switches a mode, and its value for on or off.
fn switch_value(vehicle: &Vehicle, mode: Mode, on: bool) -> Option<(u8, u16)> {
    let switch = Switch::of(mode, &vehicle.controller().mode_ranges())?;
    let value = if on { switch.on_us } else { switch.off_us };
    Some((u8::try_from(switch.channel).ok()?, value))
}
