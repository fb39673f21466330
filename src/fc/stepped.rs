//! A SITL executable in simulated time: each step of the craft is one step of the executable.

use std::collections::VecDeque;
use std::hash::{DefaultHasher, Hash as _, Hasher as _};
use std::time::{Duration, Instant};

use super::RemoteNotice;
use super::self_check::SelfCheck;
use crate::link::ChildEvent;
use crate::link::lockstep::{KeptRun, Lockstep, NoReport, StepInput};
use crate::link::proto::rc;
use crate::link::proto::sitl_feed::{FeedConfig, SitlFeed};
use crate::signals::MotorCommand;
use crate::vehicle::{FrameOut, RemoteController};

/// The wall time without a report after which the user is informed.
const NOTABLE_WAIT: Duration = Duration::from_secs(1);

/// An executable that computes one step for each step of the craft.
#[derive(Debug)]
pub(super) struct Stepped {
    /// `None` once it is given up.
    lockstep: Option<Lockstep>,
    feed: SitlFeed,
    pub(super) self_check: SelfCheck,
    step: Duration,
    /// The time of the steps so far, which is the time of the protocol.
    elapsed: Duration,
    is_connected: bool,
    /// `true` while it computes a step, or boots.
    is_busy: bool,
    /// `true` if the motors of its newest step have arrived.
    pub(super) sends_motors: bool,
    /// Covers its motor packets and their steps.
    motor_hash: DefaultHasher,
    /// The beginning of a wait for a report, and whether the user was informed.
    waits: Option<(Instant, bool)>,
    /// The inputs of the next step.
    next: Option<StepInput>,
    /// Events that were not passed on yet.
    events: VecDeque<StepEvent>,
}

/// Something that happened in a step.
#[derive(Debug)]
pub(super) enum StepEvent {
    Connected,
    Received(Vec<u8>),
    /// The process has ended in this way, as part of a sentence, and starts again.
    Ended {
        how: String,
        is_reboot: bool,
    },
    /// It cannot be started, for this reason.
    NotStarted(String),
    /// It cannot be used any more, for this reason, which follows its name.
    Unusable(&'static str),
    Notice(RemoteNotice),
}

impl Stepped {
    /// Takes over an executable that has booted.
    pub(super) fn new(lockstep: Lockstep, feed: FeedConfig) -> Self {
        Self {
            step: lockstep.step_length(),
            lockstep: Some(lockstep),
            feed: SitlFeed::new(feed),
            self_check: SelfCheck::default(),
            elapsed: Duration::ZERO,
            is_connected: false,
            is_busy: false,
            sends_motors: false,
            motor_hash: DefaultHasher::new(),
            waits: None,
            next: None,
            events: VecDeque::new(),
        }
    }

    /// Continues with an executable that has computed this time before, over its connection, if it has one. `newest` is the
    /// newest state packet that it got.
    pub(super) fn resumed(
        lockstep: Lockstep,
        feed: FeedConfig,
        elapsed: Duration,
        newest: Option<&[u8]>,
    ) -> Self {
        let is_connected = lockstep.is_connected();
        let mut steps = Self::new(lockstep, feed);
        (steps.elapsed, steps.is_connected, steps.sends_motors) = (elapsed, is_connected, true);
        newest.into_iter().for_each(|packet| steps.feed.resume(packet));
        steps
    }

    /// Returns the number of steps since the boot of the executable.
    pub(super) fn steps_of_run(&self) -> u64 {
        self.lockstep.as_ref().map_or(0, Lockstep::steps_of_run)
    }

    /// Returns `true` if the run of the executable is kept.
    pub(super) fn keeps_past(&self) -> bool {
        self.lockstep.as_ref().is_some_and(Lockstep::keeps_past)
    }

    /// Returns the run of the executable since its boot, if it is kept, with the settings of its feed.
    pub(super) fn past(&mut self) -> Option<(KeptRun, FeedConfig)> {
        Some((self.lockstep.as_mut()?.past()?, self.feed.config()))
    }

    /// Returns the simulated time since the link began.
    pub(super) fn elapsed(&self) -> Duration {
        self.elapsed
    }

    /// Returns `true` while the craft must wait for it.
    pub(super) fn is_busy(&self) -> bool {
        self.is_busy
    }

    /// Returns a hash over its motor packets so far and the times of their steps.
    pub(super) fn motor_hash(&self) -> u64 {
        self.motor_hash.finish()
    }

    /// Returns the feed, for its dialect.
    pub(super) fn feed(&self) -> &SitlFeed {
        &self.feed
    }

    /// Ends the process for good.
    pub(super) fn give_up(&mut self) {
        (self.lockstep, self.is_busy) = (None, false);
    }

    /// Takes the frames of the vehicle's newest step. Only the newest frame of each kind counts.
    pub(super) fn take_frames(&mut self, mailbox: &mut RemoteController) {
        let (mut fdm, mut rc) = (None, None);
        let now_us = self.elapsed.as_micros() as u64;
        while let Some(frame) = mailbox.take_frame() {
            match frame {
                FrameOut::Rc(frame, _) => rc = Some(rc::encode(self.elapsed.as_secs_f64(), &frame)),
                FrameOut::Sensors(frame) => {
                    self.feed.sense(&frame);
                    fdm = Some(self.feed.packet(now_us).to_bytes());
                }
            }
        }
        if let Some(fdm) = fdm {
            self.feed.sent(now_us);
            self.next = Some(StepInput { fdm, rc });
        }
    }

    /// Sends bytes over the serial port with the next step.
    pub(super) fn send(&mut self, bytes: &[u8]) {
        if let Some(lockstep) = &mut self.lockstep {
            lockstep.send(bytes);
        }
    }

    /// Lets the executable compute the next step, if its inputs are there, and waits for its report, for a short time at
    /// most.
    pub(super) fn run(&mut self, mailbox: Option<&mut RemoteController>, now: Instant) {
        let Some(lockstep) = &mut self.lockstep else { return };
        if !self.is_busy {
            let Some(input) = self.next.take() else { return self.connect() };
            lockstep.step(input);
            self.is_busy = true;
            self.elapsed += self.step;
        }
        let reported = lockstep.wait();
        if let Some(error) = lockstep.take_inputs_error() {
            let sentence = format!(
                "This flight cannot be flown on from an earlier instant, because its record in the temporary directory \
                 cannot be written: {error}."
            );
            self.events.push_back(StepEvent::Notice(RemoteNotice::Lost(sentence)));
        }
        match reported {
            Ok(motors) => {
                self.is_busy = false;
                if self.waits.take().is_some_and(|(_, is_reported)| is_reported) {
                    let sentence = "The firmware's process runs again.".to_owned();
                    self.events.push_back(StepEvent::Notice(RemoteNotice::Reported(sentence)));
                }
                let now_us = self.elapsed.as_micros() as u64;
                if let Some(packet) = motors {
                    (now_us, packet).hash(&mut self.motor_hash);
                }
                if let Some(motors) = motors.and_then(|packet| self.feed.answered(&packet, now_us)) {
                    self.sends_motors = true;
                    mailbox.into_iter().for_each(|mailbox| mailbox.deliver_motors(motors));
                }
                match lockstep.received() {
                    Some(bytes) if bytes.is_empty() => {}
                    Some(bytes) => self.events.push_back(StepEvent::Received(bytes)),
                    None => self.is_connected = false,
                }
                self.connect();
            }
            Err(NoReport::Stopped) => self.note_wait(now),
            Err(NoReport::Silent) => {
                self.become_unusable("has not ended its step for 10 s, although it is not stopped");
            }
            Err(NoReport::Faulty(why)) => self.become_unusable(why),
            Err(NoReport::Ended(end)) => self.restart(end.to_string(), end.is_reboot(), mailbox),
            Err(NoReport::Hung) => {
                let how = "because it computed for 2 s without an end of its step".to_owned();
                self.restart(how, false, mailbox);
            }
            Err(NoReport::Replaced) => {
                self.begin_run(String::new(), true, mailbox);
                // The new image of the process has booted already.
                self.is_busy = false;
                self.connect();
            }
        }
    }

    /// Returns the oldest event.
    pub(super) fn poll_event(&mut self) -> Option<StepEvent> {
        self.events.pop_front()
    }

    /// Returns the next event of the process's output.
    pub(super) fn take_output(&mut self) -> Option<ChildEvent> {
        self.lockstep.as_mut()?.take_event()
    }

    fn become_unusable(&mut self, why: &'static str) {
        self.events.push_back(StepEvent::Unusable(why));
        self.give_up();
    }

    fn connect(&mut self) {
        if !self.is_connected
            && let Some(lockstep) = &mut self.lockstep
            && lockstep.connect().unwrap_or(false)
        {
            self.is_connected = true;
            self.events.push_back(StepEvent::Connected);
        }
    }

    /// Informs the user once of a process that does not run.
    fn note_wait(&mut self, now: Instant) {
        let (since, is_reported) = self.waits.get_or_insert((now, false));
        if !*is_reported && now.saturating_duration_since(*since) >= NOTABLE_WAIT {
            *is_reported = true;
            let sentence = "The firmware's process does not run (stopped, at a breakpoint, or the machine is busy): the \
                            flight waits for it."
                .to_owned();
            self.events.push_back(StepEvent::Notice(RemoteNotice::Lost(sentence)));
        }
    }

    fn restart(&mut self, how: String, is_reboot: bool, mailbox: Option<&mut RemoteController>) {
        let Some(lockstep) = &mut self.lockstep else { return };
        let restarted = lockstep.restart();
        self.begin_run(how, is_reboot, mailbox);
        if let Err(error) = restarted {
            self.events.push_back(StepEvent::NotStarted(error.to_string()));
            self.give_up();
        }
    }

    /// Begins another run of the executable, which boots.
    fn begin_run(&mut self, how: String, is_reboot: bool, mailbox: Option<&mut RemoteController>) {
        self.events.push_back(StepEvent::Ended { how, is_reboot });
        self.feed.restart();
        self.self_check = SelfCheck::default();
        (self.is_connected, self.is_busy, self.next, self.waits) = (false, true, None, None);
        mailbox.into_iter().for_each(|mailbox| mailbox.deliver_motors(MotorCommand::default()));
    }
}
