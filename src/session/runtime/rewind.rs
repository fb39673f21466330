//! Shows earlier instants of the flight, and continues the flight from them.

use std::time::{Duration, Instant};

use super::interface::output;
use super::requests::FreshRc;
use super::{SLICE, Session};
use crate::events::Event;
use crate::fc::{CraftSettings, RemoteLink};
use crate::flight::forecast;
use crate::lookahead::{FlownAgain, FlyAgain, FlyingAgain, VehicleCopy};
use crate::runner::SPEED_RANGE;
use crate::runner::{Runner, Subscriber, tick};
use crate::session::ReplyTo;
use crate::session::arming::ArmingWatch;
use crate::session::command::{BEGINNING_LOST, CliOutput, Seek};
use crate::session::flight_feed::{FlightFeed, FlightPart};
use crate::session::policy::{NOT_FLOWN_AGAIN, NOT_RECORDED};
use crate::session::seek::{Target, target};
use crate::signals::SimTime;
use crate::timeline::{RecordedFlight, Shown, Timeline, TimelineView};
use crate::vehicle::{Answer, Reply, Vehicle, VehicleCommand};

/// The longest time that the flight continues until an event, µs.
const RUN_ON_US: u64 = 600_000_000;

/// The amount of input that may arrive while time is paused before it is recorded, bytes.
const FLOOD_BYTES: usize = 1 << 20;

/// The advice for a line while a picture is shown.
const PICTURE_RUNS_NO_LINE: &str =
    "An earlier instant of a remote firmware is shown, which runs no line: `e` goes back to the end.";

/// The reason why a flight over a remote firmware is not written as a scenario.
const INPUTS_NOT_KEPT: &str = "The flight of a remote firmware is recorded as pictures, without its inputs.";

/// The refusal of a recording without a recorder.
const NO_RECORDER: &str = "The flights of this program are not recorded.";

/// The notice if the newest instant is shown.
const NOTHING_EARLIER: &str = "The newest instant is shown: `,` and `<` go back to one to fly on from.";

/// The condition until which the flight continues as fast as possible.
#[derive(Debug, Clone, Copy)]
pub(super) struct RunOn {
    states_only: bool,
    since: SimTime,
}

impl Session {
    /// Returns the vehicle that is shown: that of the earlier instant, or the one that flies.
    pub(super) fn shown_vehicle(&self) -> &Vehicle {
        self.timeline.as_ref().and_then(Timeline::shown).unwrap_or(&self.vehicle)
    }

    /// Returns a copy of the vehicle that is shown, for other flights.
    pub(super) fn copy_of_shown(&self) -> Vehicle {
        let mut copy = self.shown_vehicle().clone();
        copy.keep_inputs(false);
        copy
    }

    /// Returns `true` while an earlier instant is shown.
    pub(super) fn is_rewound(&self) -> bool {
        self.timeline.as_ref().is_some_and(|timeline| timeline.shown().is_some())
    }

    /// Returns `true` while the flight continues until an event.
    pub(super) fn is_running_on(&self) -> bool {
        self.run_on.is_some()
    }

    /// Begins with a flight that was flown before: sends its events, and shows one of its instants.
    pub(super) fn begin_with(&mut self, events: &[Event], show: SimTime) {
        self.events.send_all(events);
        self.runner.pacer.set_paused(true, Duration::ZERO);
        if show < self.vehicle.time() {
            self.show(show, Duration::ZERO);
        }
    }

    /// Returns the recording of the flight to which the shown instant belongs.
    pub(super) fn recorded_flight(&mut self) -> Result<Box<RecordedFlight>, String> {
        let (shown, head) = (self.shown_vehicle().time(), self.vehicle.time());
        let timeline = self.timeline.as_mut().ok_or(NOT_RECORDED)?;
        if timeline.is_pictures() {
            return Err(INPUTS_NOT_KEPT.to_owned());
        }
        timeline.record(&mut self.vehicle);
        let is_rewound = timeline.shown().is_some();
        let until = if is_rewound { timeline.flight_ends(shown).unwrap_or(head) } else { head };
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
            is_pictures: timeline.is_pictures(),
            cannot_continue: timeline.is_pictures() && !self.can_fly_again(),
            flying_again: self.flying_again.as_ref().map(FlyingAgain::progress),
            branch: timeline.branch(),
            branched_at: timeline.branched_at(),
            folds: timeline.folds(&marks),
            marks,
        })
    }

    /// Returns the wanted multiple of real time.
    pub(super) fn wanted_speed(&self) -> f64 {
        if self.run_on.is_some() { *SPEED_RANGE.end() } else { self.runner.pacer.speed() }
    }

    /// Runs a read-only line on a copy of the vehicle that is shown.
    pub(super) fn read_shown(&self, line: &str) -> CliOutput {
        let mut copy = self.copy_of_shown();
        let time_s = copy.time().as_secs_f64();
        match copy.apply(&VehicleCommand::single_line(line)) {
            Answer::Now(Reply::Line(mut answer)) => {
                self.interface.host.add_to(&mut answer);
                let mut output = output(line, answer, false);
                output
                    .advice
                    .get_or_insert_with(|| format!("As it was at the shown instant, {time_s:.1} s."));
                output
            }
            // A picture of a remote flight controller cannot run a line.
            _ => CliOutput {
                text: "###ERROR: REWOUND###".to_owned(),
                advice: Some(PICTURE_RUNS_NO_LINE.to_owned()),
                restarted: false,
            },
        }
    }

    /// Returns all settings of the vehicle that is shown.
    pub(super) fn settings_of_shown(&self) -> Result<Box<CraftSettings>, String> {
        let configuration = self.shown_vehicle().controller().configuration();
        let settings = configuration.map(|shown| CraftSettings::from_configuration(shown, None));
        settings.map(Box::new).ok_or_else(|| PICTURE_RUNS_NO_LINE.to_owned())
    }

    /// Advances time by the due ticks and returns the ticks flown.
    pub(super) fn advance(&mut self, due: u64, now: Duration) -> u64 {
        if let Some(timeline) = &mut self.timeline
            && timeline.shown().is_some()
        {
            if due > 0 && timeline.play(due, self.vehicle.time()) == Shown::Newest {
                self.runner.pacer.set_paused(true, now);
                self.changed = true;
            }
            return due;
        }
        if let Some(run_on) = self.run_on {
            return self.run_on(run_on);
        }
        for flown in 1..=due {
            if !self.tick_in_step() {
                return flown;
            }
        }
        due
    }

    /// Runs and records one tick, and lets an executable in simulated time compute its step. Returns `false` if no other tick
    /// may follow now.
    fn tick_in_step(&mut self) -> bool {
        self.tick();
        if !self.is_in_steps() {
            return true;
        }
        self.exchange_with_remote(None);
        !self.quit && !self.is_link_busy()
    }

    /// Returns `true` while an executable in simulated time is at its step.
    fn is_link_busy(&self) -> bool {
        self.runner.link.as_ref().is_some_and(RemoteLink::is_busy)
    }

    /// Runs and records one tick of the vehicle that flies.
    fn tick(&mut self) {
        let speed = self.wanted_speed();
        let rc = self.endpoints.as_ref().map(|endpoints| FreshRc { handler: &endpoints.handler, speed });
        let recorders = Recorders { timeline: &mut self.timeline, feed: &mut self.feed };
        let recorders = (recorders, self.persistence.logs());
        let subscribers = &mut (rc, (recorders, &mut self.events));
        let _no_end = tick(&mut self.vehicle, subscribers);
    }

    /// Passes the blackbox logs on to the system, and reports their files and errors.
    pub(super) fn tend_logs(&mut self, now: Instant) {
        let logs = self.persistence.logs();
        logs.flush_if_due(now);
        let notices = logs.take_notices();
        self.notices(notices);
    }

    /// Records the input that arrives while time is paused, if there is much of it.
    pub(super) fn record_flood(&mut self) {
        if let Some(timeline) = &mut self.timeline
            && self.vehicle.input_bytes() > FLOOD_BYTES
        {
            timeline.record(&mut self.vehicle);
            if let Some(feed) = &mut self.feed {
                feed.take_inputs(timeline);
            }
        }
    }

    /// Records the ticks of an external simulator.
    pub(super) fn record_flown(&mut self, ticks: u64) {
        if let Some(feed) = self.feed.as_mut().filter(|_| ticks > 0) {
            feed.look(&self.vehicle);
        }
    }

    /// Asks the recorder for the recording of the flight so far.
    pub(super) fn copy_recording(&mut self, reply: ReplyTo<Result<Vec<u8>, String>>) {
        let Some(feed) = &mut self.feed else { return reply.send(Err(NO_RECORDER.to_owned())) };
        if let Some(timeline) = &mut self.timeline {
            timeline.record(&mut self.vehicle);
            feed.take_inputs(timeline);
        }
        feed.sender().send(FlightPart::Copy(reply));
    }

    /// Continues the flight for one slice, or until an event.
    fn run_on(&mut self, run_on: RunOn) -> u64 {
        if self.is_link_busy() {
            return 0;
        }
        for flown in 1..=SLICE {
            let goes_on = self.tick_in_step();
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
            if !goes_on {
                return flown;
            }
        }
        SLICE
    }

    /// Steps forwards. While an earlier instant is shown, steps in the recording.
    pub(super) fn step(&mut self, ticks: u32, now: Duration) {
        match &mut self.timeline {
            Some(timeline) if timeline.shown().is_some() => {
                self.runner.pacer.set_paused(true, now);
                timeline.play(u64::from(ticks), self.vehicle.time());
            }
            _ => {
                for _ in 0..ticks {
                    if self.is_link_busy() || !self.tick_in_step() {
                        break;
                    }
                }
            }
        }
    }

    pub(super) fn seek(&mut self, seek: Seek, now: Duration) {
        self.flush_events();
        let shown = |session: &Self| {
            let timeline = session.timeline.as_ref()?;
            Some((timeline.shown()?.time(), timeline.shown_at()?))
        };
        let before = shown(self);
        let mut last = before;
        self.seek_once(seek, now);
        // A picture may show several events, and one step back is a step to another picture.
        while let (Seek::Back { .. }, Some((picture, at))) = (seek, shown(self))
            && before.is_some_and(|(before, _)| before == picture)
            && last.is_some_and(|(_, last)| at < last)
        {
            last = Some((picture, at));
            self.seek_once(seek, now);
        }
    }

    fn seek_once(&mut self, seek: Seek, now: Duration) {
        let (head, marks) = (self.vehicle.time(), self.events.marks());
        let at = self.timeline.as_ref().and_then(Timeline::shown_at);
        let shown = at.filter(|_| matches!(seek, Seek::Back { .. })).unwrap_or(self.shown_vehicle().time());
        match (target(seek, shown, head, marks), seek) {
            (Target::Newest, _) => self.show_newest(now),
            (Target::Nowhere(sentence), _) => self.notice(sentence),
            (Target::At(time), Seek::Forward { states_only }) if time >= head && !self.is_rewound() => {
                self.runner.pacer.set_paused(true, now);
                self.run_on = Some(RunOn { states_only, since: head.max(time) });
            }
            (Target::At(time), _) if time >= head && !self.is_rewound() => {
                self.notice("This is the newest instant: nothing is recorded after it.");
            }
            (Target::At(time), _) => self.show(time, now),
        }
    }

    fn show(&mut self, time: SimTime, now: Duration) {
        let rewound = self.is_rewound();
        let Some(timeline) = &mut self.timeline else { return };
        if !rewound {
            self.refused_while_rewound = false;
            self.was_paused = self.runner.pacer.is_paused();
        }
        self.run_on = None;
        self.runner.pacer.set_paused(true, now);
        let first = timeline.first();
        timeline.show(time, self.vehicle.time());
        if let Some(first) = first.filter(|first| time < *first) {
            self.notice(format!("The recording begins here, {:.1} s after boot.", first.as_secs_f64()));
        }
    }

    /// Returns to the vehicle that flies. Time continues if it did before.
    fn show_newest(&mut self, now: Duration) {
        if let Some(timeline) = &mut self.timeline
            && timeline.shown().is_some()
        {
            timeline.leave();
            self.runner.pacer.set_paused(self.was_paused, now);
        } else {
            self.notice("This is the newest instant already.");
        }
    }

    /// Returns `true` if a remote firmware can fly again to an earlier instant.
    pub(super) fn can_fly_again(&self) -> bool {
        self.again.is_some() || self.runner.link.as_ref().is_some_and(RemoteLink::keeps_past)
    }

    /// Returns the flight of a remote firmware since its boot, to fly it again.
    fn again(&mut self) -> Option<FlyAgain> {
        let past = self.runner.link.as_mut().and_then(RemoteLink::past).map(FlyAgain::of);
        past.or_else(|| self.again.clone())
    }

    /// Returns a copy of the vehicle that is shown, for a forecast. Of an executable it may be a tenth of a second older.
    ///
    /// # Errors
    /// Returns the reason as a sentence if it cannot be flown ahead.
    pub(super) fn copy_for_forecast(&mut self) -> Result<VehicleCopy, String> {
        let takeoff_m = self.takeoff_m;
        let head = self.vehicle.time();
        if let Some(picture) = self.timeline.as_ref().and_then(|timeline| timeline.picture(head)) {
            let again = Some(self.again().ok_or(NOT_FLOWN_AGAIN)?);
            return Ok(VehicleCopy { vehicle: Box::new(picture), takeoff_m, again });
        }
        forecast::check_possible(&self.vehicle)?;
        Ok(VehicleCopy { vehicle: Box::new(self.copy_of_shown()), takeoff_m, again: None })
    }

    /// Begins to fly the flight of a remote firmware again, up to the instant that is shown.
    fn fly_again(&mut self) {
        if self.flying_again.take().is_some() {
            self.changed = true;
            self.notice("Stopped: the flight is not flown again.");
            return;
        }
        let Some(until) = self.timeline.as_ref().and_then(Timeline::shown).map(Vehicle::time) else {
            self.notice(NOTHING_EARLIER);
            return;
        };
        let Some(again) = self.again() else {
            self.notice(NOT_FLOWN_AGAIN);
            return;
        };
        match again.start(until) {
            Ok(flying) => {
                self.flying_again = Some(flying);
                let until_s = until.as_secs_f64();
                self.notice(format!(
                    "The firmware boots, and flies the same inputs again up to {until_s:.1} s."
                ));
            }
            Err(error) => self.notice(format!("The flight cannot be flown again: {error}.")),
        }
    }

    /// Continues from the end of a flight that was flown again, once it is there.
    pub(super) fn take_flown_again(&mut self, now: Duration) {
        let Some((until, result)) = self.flying_again.as_mut().and_then(FlyingAgain::result) else {
            self.changed |= self.flying_again.is_some();
            return;
        };
        self.flying_again = None;
        self.changed = true;
        // Dropped in reverse order: the link before the folder of its firmware.
        let FlownAgain { keeps, link } = match result {
            Ok(flown) => flown,
            Err(sentence) => return self.notice(sentence),
        };
        let left = self.vehicle.time();
        // Another instant may be shown meanwhile.
        let branch_at = |timeline: &mut Timeline| {
            timeline.shown()?;
            timeline.show(until, left);
            timeline.shown().filter(|picture| picture.time() == until)?;
            Some((timeline.continue_pictures()?, timeline.branch()))
        };
        let Some((mut vehicle, branch)) = self.timeline.as_mut().and_then(branch_at) else {
            return self.notice("The recording was left meanwhile: go back to an instant to fly on from.");
        };
        // The events were reported when they happened.
        vehicle.drain_events(drop);
        let speed = self.runner.pacer.speed();
        self.runner = Runner::new(vehicle.step_us(), speed, Some(link)).with_slice(SLICE);
        self.again = None;
        self.keeps = Some(keeps);
        self.vehicle = vehicle;
        self.continue_on(branch, left, now);
        self.notice("Another process of the firmware flies on. What it saves from now on is lost at the end of betadeck.");
    }

    /// Continues the flight from the earlier instant that is shown. The clients of the links are
    /// disconnected, as by a restart, because their data about the craft is no longer true.
    pub(super) fn fly_on(&mut self, now: Duration) {
        self.flush_events();
        if self.timeline.as_ref().is_some_and(Timeline::is_pictures) {
            return self.fly_again();
        }
        let left = self.vehicle.time();
        let Some((vehicle, branch)) =
            self.timeline.as_mut().and_then(|timeline| Some((timeline.fly_on()?, timeline.branch())))
        else {
            self.notice(NOTHING_EARLIER);
            return;
        };
        self.vehicle = vehicle;
        // The log under way has what is discarded now.
        self.vehicle.begin_new_log();
        self.continue_on(branch, left, now);
    }

    /// Continues with the vehicle of a new branch. `left` is the instant at which the flight was left.
    fn continue_on(&mut self, branch: u32, left: SimTime, now: Duration) {
        self.persistence.report_facts(&mut self.vehicle);
        self.vehicle.apply(&VehicleCommand::EndAllCli);
        self.arming = ArmingWatch::default();
        if let (Some(feed), Some(timeline)) = (&mut self.feed, &self.timeline) {
            feed.branch(self.vehicle.time(), timeline);
        }
        self.events.branch(&mut self.vehicle, branch, left);
        if let Some(endpoints) = &mut self.endpoints {
            endpoints.handler.after_restart(true, &mut self.vehicle);
        }
        self.runner.pacer.set_paused(false, now);
    }
}

/// The recording for replays, and the way to the recorder of flights, which gets the same inputs.
struct Recorders<'s> {
    timeline: &'s mut Option<Timeline>,
    feed: &'s mut Option<FlightFeed>,
}

impl Subscriber<Vehicle> for Recorders<'_> {
    fn before_tick(&mut self, vehicle: &mut Vehicle) {
        if let Some(timeline) = self.timeline {
            timeline.record(vehicle);
            if let Some(feed) = self.feed {
                feed.take_inputs(timeline);
            }
        }
    }

    fn after_tick(&mut self, vehicle: &Vehicle) {
        if let Some(feed) = self.feed {
            feed.look(vehicle);
        }
    }
}
