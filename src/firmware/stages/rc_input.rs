//! Converts RC frames to sticks, switches and the state of the link.

use strum::{EnumCount as _, IntoEnumIterator as _};

use crate::firmware::failsafe::link::LinkChange;
use crate::firmware::failsafe::{Failsafe, LinkMonitor, SwitchMode};
use crate::firmware::modes::{self, BoxSet, boxes};
use crate::firmware::outbox::Outbox;
use crate::firmware::parameters::Parameters;
use crate::firmware::rx::{Receiver, RxConfig};
use crate::signals::{RcFrame, RcSource, SimTime};
use crate::telemetry::FirmwareEvent;

/// The receiver with its queued frames, the link, and the boxes that its switches turn on.
#[derive(Debug, Clone)]
pub(in crate::firmware) struct RcInput {
    /// The frames that came since the last step. Only the newest frame of each source counts.
    queued: [Option<RcFrame>; RcSource::COUNT],
    pub receiver: Receiver,
    pub link: LinkMonitor,
    /// `true` if the loss of the link was reported, but not its return yet.
    loss_reported: bool,
    pub boxes: BoxSet,
    /// `true` if a frame came that the controller has not used yet.
    new_frame: bool,
}

impl RcInput {
    /// Creates a receiver that has not received anything yet.
    pub(in crate::firmware) fn new(config: &RxConfig) -> Self {
        Self {
            queued: [None; RcSource::COUNT],
            receiver: Receiver::new(config),
            link: LinkMonitor::default(),
            loss_reported: false,
            boxes: BoxSet::NONE,
            new_frame: false,
        }
    }

    /// Returns the receiver after a restart. The queued frames and the order of the sources stay.
    pub(in crate::firmware) fn restarted(&self, config: &RxConfig) -> Self {
        let mut fresh = Self { queued: self.queued, ..Self::new(config) };
        fresh.receiver.take_over(self.receiver.sources().taken_over());
        fresh
    }

    /// Keeps a frame for the next step, at which its age begins.
    pub(in crate::firmware) fn queue(&mut self, frame: &RcFrame, source: RcSource) {
        self.queued[source as usize] = Some(*frame);
    }

    /// Drops the frames that came since the last step. The receiver does not get them.
    pub(in crate::firmware) fn drop_queued(&mut self) {
        self.queued.fill(None);
    }

    /// Passes the frames that came since the last step to the receiver.
    pub(in crate::firmware) fn receive_queued(&mut self, parameters: &Parameters, now: SimTime) {
        for source in RcSource::iter() {
            if let Some(frame) = self.queued[source as usize].take() {
                self.receiver.receive(&parameters.rx, frame, source, now);
            }
        }
    }

    /// Judges channels, link and switches again. Returns `true` if a new frame came.
    pub(in crate::firmware) fn update(
        &mut self,
        parameters: &Parameters,
        now: SimTime,
        failsafe: &Failsafe,
        outbox: &mut Outbox,
    ) -> bool {
        let failsafe_switch = self.boxes.has(boxes::FAILSAFE);
        let switched_off = failsafe_switch && parameters.failsafe.switch_mode == SwitchMode::Stage1;
        let new_frame = self.receiver.update(&parameters.rx, now, switched_off, failsafe.active());
        let at_once = failsafe.by_switch() && !failsafe_switch;
        let receiver = &self.receiver;
        match self.link.update(&parameters.link, now, receiver.signal(), receiver.last_frame(), at_once) {
            Some(LinkChange::Lost) => {
                self.loss_reported = true;
                outbox.push(FirmwareEvent::RxLoss);
            }
            Some(LinkChange::Recovered) if std::mem::take(&mut self.loss_reported) => {
                outbox.push(FirmwareEvent::RxRecovered);
            }
            Some(LinkChange::Recovered) | None => {}
        }
        self.boxes = match self.receiver.has_heard() {
            true => modes::evaluate(&parameters.modes, self.receiver.aux(&parameters.rx)),
            false => BoxSet::NONE,
        };
        self.new_frame |= new_frame;
        new_frame
    }

    /// Returns `true` if a frame came since the last call.
    pub(in crate::firmware) fn take_new_frame(&mut self) -> bool {
        std::mem::take(&mut self.new_frame)
    }

    /// Returns the throttle stick in use, %.
    pub(in crate::firmware) fn throttle_percent(&self) -> f64 {
        (self.receiver.sticks().throttle_us - 1000.0) / 10.0
    }
}
