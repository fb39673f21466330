//! From RC frames to sticks, switches and the state of the link.

use strum::{EnumCount as _, IntoEnumIterator as _};

use crate::firmware::failsafe::link::LinkChange;
use crate::firmware::failsafe::{Failsafe, LinkMonitor, SwitchMode};
use crate::firmware::modes::{self, BoxSet, boxes};
use crate::firmware::outbox::Outbox;
use crate::firmware::parameters::Parameters;
use crate::firmware::rx::{Receiver, RxConfig};
use crate::signals::{RcFrame, RcSource, SimTime};
use crate::telemetry::FirmwareEvent;

/// The receiver with the frames that wait for it, the link, and the boxes that its switches turn on.
#[derive(Debug, Clone)]
pub(in crate::firmware) struct RcInput {
    /// Frames that came since the last step; of one source only the newest counts.
    queued: [Option<RcFrame>; RcSource::COUNT],
    receiver: Receiver,
    link: LinkMonitor,
    /// The loss of the link was reported, its return not yet.
    loss_reported: bool,
    boxes: BoxSet,
    /// A frame came that the controller has not seen yet.
    new_frame: bool,
}

impl RcInput {
    /// A receiver that has heard nothing.
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

    /// The receiver after a restart: the frames that wait and the order of the sources stay.
    pub(in crate::firmware) fn restarted(&self, config: &RxConfig) -> Self {
        let mut fresh = Self { queued: self.queued, ..Self::new(config) };
        fresh.take_over(self.receiver.sources().taken_over());
        fresh
    }

    /// Keeps a frame for the next step, where its age begins.
    pub(in crate::firmware) fn queue(&mut self, frame: &RcFrame, source: RcSource) {
        self.queued[source as usize] = Some(*frame);
    }

    /// Drops the frames that came since the last step: they never arrived.
    pub(in crate::firmware) fn drop_queued(&mut self) {
        self.queued.fill(None);
    }

    /// Lets the virtual sticks win over the other sources, or ends that.
    pub(in crate::firmware) fn take_over(&mut self, sticks_first: bool) {
        self.receiver.take_over(sticks_first);
    }

    /// Hands the frames that came since the last step to the receiver.
    pub(in crate::firmware) fn receive_queued(&mut self, parameters: &Parameters, now: SimTime) {
        for source in RcSource::iter() {
            if let Some(frame) = self.queued[source as usize].take() {
                self.receiver.receive(&parameters.rx, frame, source, now);
            }
        }
    }

    /// Whether an update is due.
    pub(in crate::firmware) fn is_due(&self, now: SimTime) -> bool {
        self.receiver.is_due(now)
    }

    /// Judges channels, link and switches anew; tells whether a new frame came.
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

    /// Whether a frame came since the last call.
    pub(in crate::firmware) fn take_new_frame(&mut self) -> bool {
        std::mem::take(&mut self.new_frame)
    }

    pub(in crate::firmware) fn receiver(&self) -> &Receiver {
        &self.receiver
    }

    /// The boxes that are switched on.
    pub(in crate::firmware) fn boxes(&self) -> BoxSet {
        self.boxes
    }

    pub(in crate::firmware) fn link(&self) -> &LinkMonitor {
        &self.link
    }

    /// The throttle stick in use, %.
    pub(in crate::firmware) fn throttle_percent(&self) -> f64 {
        (self.receiver.sticks().throttle_us - 1000.0) / 10.0
    }
}
