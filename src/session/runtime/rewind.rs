//! Shows earlier instants of the flight, and flies on from them.

use std::time::Duration;

use super::limits::{impact_of_request, refuse};
use super::{SLICE, Session, console};
use crate::firmware::cli::Interpreter;
use crate::link::Request;
use crate::session::arming::ArmingWatch;
use crate::session::command::{
    BEGINNING_LOST, CliOutput, Command, NOT_RECORDED, REWOUND, REWOUND_FOR_CLIENTS, Seek,
};
use crate::session::pacer::SPEED_RANGE;
use crate::session::remote::Impact;
use crate::signals::SimTime;
use crate::telemetry;
use crate::timeline::{RecordedFlight, Shown, Timeline, TimelineView};
use crate::vehicle::{Answer, Vehicle};

/// How long the flight goes on at most until something happens, µs.
const RUN_ON_US: u64 = 600_000_000;

/// Time before the first alarm of a mishap that is shown, µs: a link is cut before its loss is noticed.
const MISHAP_LEAD_US: u64 = 2_000_000;

/// What may come from outside while time stands still before it is recorded, bytes.
const FLOOD_BYTES: usize = 1 << 20;

/// Until when the flight goes on as fast as it goes.
#[derive(Debug, Clone, Copy)]
pub(super) struct RunOn {
    states_only: bool,
    since: SimTime,
}

impl Session {
    /// The vehicle that is shown: at an earlier instant, or the one that flies.
    pub(super) fn shown_vehicle(&self) -> &Vehicle {
        self.timeline.as_ref().and_then(Timeline::shown).unwrap_or(&self.vehicle)
    }

    /// A copy of the vehicle that is shown, to fly it somewhere else.
    pub(super) fn copy_of_shown(&self) -> Vehicle {
        let mut copy = self.shown_vehicle().clone();
        copy.keep_inputs(false);
        copy
    }

    /// Whether an earlier instant is shown.
    pub(super) fn is_rewound(&self) -> bool {
        self.timeline.as_ref().is_some_and(|timeline| timeline.shown().is_some())
    }

    /// Whether the flight goes on until something happens.
    pub(super) fn is_running_on(&self) -> bool {
        self.run_on.is_some()
    }

    /// Begins with a flight that was flown before: tells what happened in it, and shows one of its instants.
    pub(super) fn begin_with(&mut self, events: Vec<telemetry::Event>, show: SimTime) {
        self.events.send_all(events);
        self.pacer.set_paused(true, Duration::ZERO);
        if show < self.vehicle.time() {
            self.show(show, Duration::ZERO);
        }
    }

    /// What was recorded of the flight up to the instant that is shown.
    pub(super) fn recorded_flight(&mut self) -> Result<Box<RecordedFlight>, String> {
        let (shown, head) = (self.shown_vehicle().time(), self.vehicle.time());
        let timeline = self.timeline.as_mut().ok_or(NOT_RECORDED)?;
        timeline.record(&mut self.vehicle);
        let until = timeline.flight_ends(shown).unwrap_or(head);
        timeline.recorded_flight(until).map(Box::new).ok_or_else(|| BEGINNING_LOST.to_owned())
    }

    pub(super) fn timeline_view(&self) -> Option<TimelineView> {
        let timeline = self.timeline.as_ref()?;
        let head = self.vehicle.time();
        let marks = self.events.marks().all();
        Some(TimelineView {
            first: timeline.first().unwrap_or(head),
            head,
            head_is_armed: self.vehicle.controller().is_armed(),
            rewound: timeline.shown().is_some(),
            branch: timeline.branch(),
            branched_at: timeline.branched_at(),
            folds: timeline.folds(&marks),
            marks,
        })
    }

    /// The speed that time is to have, times real time.
    pub(super) fn wanted_speed(&self) -> f64 {
        if self.run_on.is_some() { *SPEED_RANGE.end() } else { self.pacer.speed() }
    }

    /// Gives a command back that may be carried out; one that would steer while an earlier instant is shown is refused.
    pub(super) fn refuse_while_rewound(&mut self, command: Command) -> Option<Command> {
        if !self.is_rewound() {
            return Some(command);
        }
        match command {
            Command::Pause(_)
            | Command::Step(_)
            | Command::Seek(_)
            | Command::FlyOn
            | Command::Speed(_)
            | Command::CopyVehicle(_)
            | Command::RecordedFlight(_)
            | Command::PermitChanges(_)
            | Command::Quit => return Some(command),
            Command::Cli { line, reply } if Impact::of_line(&line) == Impact::Reads => {
                drop(reply.send(self.read_shown(&line)));
            }
            Command::Cli { reply, .. } => {
                let (text, advice) = ("###ERROR: REWOUND###".to_owned(), Some(REWOUND.to_owned()));
                drop(reply.send(CliOutput { text, advice, restarted: false }));
            }
            Command::Upload { reply, .. } => drop(reply.send(Err(REWOUND.to_owned()))),
            Command::World { reply, .. } | Command::Save { reply } => {
                drop(reply.send(Err(REWOUND.to_owned())));
            }
            Command::Download { reply } => drop(reply.send(Err(REWOUND.to_owned()))),
            Command::Sticks(_)
            | Command::CutRc(_)
            | Command::Pilot(_)
            | Command::ReturnHome
            | Command::InFlight(_)
            | Command::CancelReturn
            | Command::ResetCraft => self.notice(REWOUND),
        }
        None
    }

    /// Runs a line that changes nothing on a copy of the vehicle that is shown.
    fn read_shown(&self, line: &str) -> CliOutput {
        let mut copy = self.copy_of_shown();
        let time_s = copy.time().as_secs_f64();
        match copy.controller_mut().run_cli(&mut Interpreter::default(), line) {
            Answer::Now(answer) => {
                let mut output = console::output(line, answer, false);
                output
                    .advice
                    .get_or_insert_with(|| format!("As it was at the shown instant, {time_s:.1} s."));
                output
            }
            // What runs elsewhere is not recorded, so that no earlier instant of it is shown.
            Answer::Later(_) => CliOutput {
                text: "###ERROR: REWOUND###".to_owned(),
                advice: Some(REWOUND.to_owned()),
                restarted: false,
            },
        }
    }

    /// Time goes on by what is due; gives the ticks.
    pub(super) fn advance(&mut self, due: u64, now: Duration) -> u64 {
        if let Some(timeline) = &mut self.timeline
            && timeline.shown().is_some()
        {
            if due > 0 && timeline.play(due, self.vehicle.time()) == Shown::Newest {
                self.pacer.set_paused(true, now);
                self.changed = true;
            }
            return due;
        }
        if let Some(run_on) = self.run_on {
            return self.run_on(run_on);
        }
        for _ in 0..due {
            self.tick();
        }
        due
    }

    /// One tick of the vehicle that flies, recorded.
    fn tick(&mut self) {
        self.keep_rc_fresh();
        if let Some(timeline) = &mut self.timeline {
            timeline.record(&mut self.vehicle);
        }
        self.vehicle.tick();
    }

    /// Records what comes while time stands still, when it is much.
    pub(super) fn record_flood(&mut self) {
        if let Some(timeline) = &mut self.timeline
            && self.vehicle.input_bytes() > FLOOD_BYTES
        {
            timeline.record(&mut self.vehicle);
        }
    }

    /// Flies on until something happens, for a slice.
    fn run_on(&mut self, run_on: RunOn) -> u64 {
        for flown in 1..=SLICE {
            self.tick();
            self.flush_events();
            let happened = self.events.marks().after(run_on.since, run_on.states_only).is_some();
            let too_long = self.vehicle.time().0 > run_on.since.0 + RUN_ON_US;
            if happened || too_long {
                self.run_on = None;
                self.changed = true;
                if too_long {
                    self.notice("Nothing happened for ten minutes.");
                }
                return flown;
            }
        }
        SLICE
    }

    /// Steps forwards, in the recording while an earlier instant is shown.
    pub(super) fn step(&mut self, ticks: u32, now: Duration) {
        match &mut self.timeline {
            Some(timeline) if timeline.shown().is_some() => {
                self.pacer.set_paused(true, now);
                timeline.play(u64::from(ticks), self.vehicle.time());
            }
            _ => (0..ticks).for_each(|_| self.tick()),
        }
    }

    pub(super) fn seek(&mut self, seek: Seek, now: Duration) {
        if self.timeline.is_none() {
            self.notice(NOT_RECORDED);
            return;
        }
        self.flush_events();
        let (shown, head, marks) = (self.shown_vehicle().time(), self.vehicle.time(), self.events.marks());
        let before = |states_only| marks.before(shown, states_only).map(|mark| mark.time);
        let target = match seek {
            Seek::Time(time) => Some(time),
            Seek::Seconds(seconds) => {
                let us = (seconds * 1e6) as i64;
                Some(SimTime(shown.0.saturating_add_signed(us)))
            }
            Seek::Back { states_only } => before(states_only),
            Seek::BeforeMishap => {
                marks.mishap_before(shown).map(|mark| SimTime(mark.time.0.saturating_sub(MISHAP_LEAD_US)))
            }
            Seek::Forward { states_only } => {
                Some(marks.after(shown, states_only).map_or(head, |mark| mark.time))
            }
            Seek::Newest => {
                self.show_newest(now);
                return;
            }
        };
        match (target, seek) {
            (None, Seek::Back { states_only: true }) => {
                self.notice("The autopilot was in no other state before this instant.");
            }
            (None, _) => self.notice("Nothing happened before this instant."),
            (Some(time), Seek::Forward { states_only }) if time >= head && !self.is_rewound() => {
                self.pacer.set_paused(true, now);
                self.run_on = Some(RunOn { states_only, since: head.max(time) });
            }
            (Some(time), _) if time >= head && !self.is_rewound() => {
                self.notice("This is the newest instant: nothing is recorded after it.");
            }
            (Some(time), _) => self.show(time, now),
        }
    }

    fn show(&mut self, time: SimTime, now: Duration) {
        let rewound = self.is_rewound();
        let Some(timeline) = &mut self.timeline else { return };
        if !rewound {
            self.refused_while_rewound = false;
            self.was_paused = self.pacer.is_paused();
        }
        self.run_on = None;
        self.pacer.set_paused(true, now);
        let first = timeline.first();
        timeline.show(time, self.vehicle.time());
        if let Some(first) = first.filter(|first| time < *first) {
            self.notice(format!("The recording begins here, {:.1} s after boot.", first.as_secs_f64()));
        }
    }

    /// Back to the vehicle that flies; time goes on if it did before.
    fn show_newest(&mut self, now: Duration) {
        if let Some(timeline) = &mut self.timeline
            && timeline.shown().is_some()
        {
            timeline.leave();
            self.pacer.set_paused(self.was_paused, now);
        } else {
            self.notice("This is the newest instant already.");
        }
    }

    /// Flies on from the earlier instant that is shown. The clients of the links are disconnected, as by a restart: what
    /// they know of the craft has become untrue.
    pub(super) fn fly_on(&mut self, now: Duration) {
        self.flush_events();
        let left = self.vehicle.time();
        let Some((vehicle, branch)) =
            self.timeline.as_mut().and_then(|timeline| Some((timeline.fly_on()?, timeline.branch())))
        else {
            self.notice("The newest instant is shown: `,` and `<` go back to one to fly on from.");
            return;
        };
        self.vehicle = vehicle;
        self.persistence.tell(self.vehicle.controller_mut());
        self.console = Interpreter::default();
        self.arming = ArmingWatch::default();
        self.events.branch(&mut self.vehicle, branch, left);
        if let Some(endpoints) = &mut self.endpoints {
            endpoints.handler.after_restart(true, self.vehicle.controller_mut());
        }
        self.pacer.set_paused(false, now);
    }
}

/// Returns the request of a client, unless it would change the vehicle that waits while an earlier instant is shown: then it
/// is refused with the reason.
pub(super) fn refuse_changing_request(request: Request) -> Option<Request> {
    // Leaving the command line changes nothing.
    let leaves = matches!(&request, Request::Cli { line, .. } if is_exit_without_reboot(line));
    if leaves || impact_of_request(&request) == Impact::Reads {
        return Some(request);
    }
    refuse(request, REWOUND_FOR_CLIENTS);
    None
}

/// Whether a line leaves the command line and does nothing else.
fn is_exit_without_reboot(line: &str) -> bool {
    let mut words = line.split_ascii_whitespace();
    let mut next_is = |word: &str| words.next().is_some_and(|next| next.eq_ignore_ascii_case(word));
    next_is("exit") && next_is("noreboot") && words.next().is_none()
}
