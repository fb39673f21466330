//! Feeds a SITL executable with the simulated craft: states and RC out, motors in.

use std::time::{Duration, Instant};

use super::RemoteNotice;
use super::self_check::SelfCheck;
use crate::link::SitlPeer;
use crate::link::proto::sitl_feed::FeedState;
use crate::signals::MotorCommand;
use crate::vehicle::{FrameOut, RemoteController, Vehicle};

/// The simulated time between two exchanges at real time, µs.
const EXCHANGE_US: f64 = 1000.0;

/// The feed of one executable.
#[derive(Debug)]
pub(super) struct Feed {
    pub(super) peer: SitlPeer,
    motors: FeedState,
    self_check: SelfCheck,
}

impl Feed {
    pub(super) fn new(peer: SitlPeer) -> Self {
        Self { peer, motors: FeedState::Waiting, self_check: SelfCheck::default() }
    }

    /// Returns `true` if motors have arrived.
    pub(super) fn has_motors(&self) -> bool {
        self.motors != FeedState::Waiting
    }

    /// Records that the executable is identified and configured. Its values are checked again.
    pub(super) fn became_ready(&mut self) {
        self.self_check = SelfCheck::default();
    }

    /// Returns the maximum number of steps of `step_us` at `speed` times real time that may be flown before
    /// the next exchange. If only the machine was held up, the motor command must not stay the same for many
    /// steps.
    pub(super) fn most_steps(&self, step_us: u64, speed: f64, now: Instant) -> u64 {
        if self.peer.waits(now) { 0 } else { ((EXCHANGE_US / step_us as f64 * speed).ceil() as u64).max(1) }
    }

    /// Sends sensor and RC frames, and receives motors. Returns a notice for the user.
    pub(super) fn exchange(&mut self, mailbox: &mut RemoteController, now: Instant) -> Option<RemoteNotice> {
        let peer = &mut self.peer;
        if let Some(motors) = peer.take_motors(now) {
            mailbox.deliver_motors(motors);
        }
        let mut state = None;
        while let Some(frame) = mailbox.take_frame() {
            match frame {
                FrameOut::Rc(frame, _) => peer.send_rc(&frame, now),
                FrameOut::Sensors(frame) => {
                    // After a delay of several steps, only the newest state is sent.
                    if let Some(older) = state.replace(frame) {
                        peer.pass_over(&older);
                    }
                }
            }
        }
        if let Some(frame) = state {
            peer.send_state(&frame, now);
        }
        peer.repeat_rc(now);
        let before = std::mem::replace(&mut self.motors, peer.state(now));
        match (before, self.motors) {
            (FeedState::Answering, FeedState::Silent) => {
                mailbox.deliver_motors(MotorCommand::default());
                let sentence =
                    "The firmware has sent no motors for a second: they are stopped until it does.";
                Some(RemoteNotice::Lost(sentence.to_owned()))
            }
            (FeedState::Silent, FeedState::Answering) => {
                Some(RemoteNotice::Reported("The firmware sends motors again.".to_owned()))
            }
            _ => None,
        }
    }

    /// Checks once, some time after the first answer, that the executable shows the craft at rest correctly.
    pub(super) fn check_at_rest(
        &mut self,
        vehicle: &Vehicle,
        is_ready: bool,
        trusts_mag: bool,
        now: Duration,
    ) -> Option<RemoteNotice> {
        let answers = is_ready && self.motors == FeedState::Answering;
        self.self_check.look(self.peer.dialect(), vehicle, answers, trusts_mag, now)
    }
}
