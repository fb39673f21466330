//! The RC source in charge: three sources of RC frames with a fixed priority, judged by age.

use crate::signals::{RcFrame, RcSource, SimTime};

/// The time without a frame after which a source gives way to the next, s.
pub const SOURCE_TIMEOUT_S: f64 = 0.3;

/// The number of frames over which a source's rate is measured.
const RATE_WINDOW_FRAMES: u32 = 25;

/// The newest frame of one source.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Seat {
    frame: RcFrame,
    received: SimTime,
    window_start: SimTime,
    window_frames: u32,
    rate_hz: f64,
}

impl Seat {
    fn new(frame: RcFrame, now: SimTime) -> Self {
        Self { frame, received: now, window_start: now, window_frames: 0, rate_hz: 0.0 }
    }

    fn receive(&mut self, frame: RcFrame, now: SimTime) {
        if now.seconds_since(self.received) > SOURCE_TIMEOUT_S {
            *self = Self::new(frame, now);
            return;
        }
        self.frame = frame;
        self.received = now;
        self.window_frames += 1;
        if self.window_frames >= RATE_WINDOW_FRAMES {
            let span = now.seconds_since(self.window_start);
            self.rate_hz = if span > 0.0 { f64::from(self.window_frames) / span } else { 0.0 };
            self.window_start = now;
            self.window_frames = 0;
        }
    }

    fn is_fresh(&self, now: SimTime) -> bool {
        now.seconds_since(self.received) < SOURCE_TIMEOUT_S
    }
}

/// Selects the source in charge: UDP, then MSP, then the virtual sticks, each while it is fresh. An explicit take-over
/// puts the virtual sticks first.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Sources {
    udp: Option<Seat>,
    msp: Option<Seat>,
    sticks: Option<Seat>,
    sticks_first: bool,
    in_charge: Option<RcSource>,
}

impl Sources {
    /// Takes a frame. Returns it if its source is the one in charge.
    pub fn receive(&mut self, frame: RcFrame, source: RcSource, now: SimTime) -> Option<RcFrame> {
        match self.seat_mut(source) {
            Some(seat) => seat.receive(frame, now),
            empty => *empty = Some(Seat::new(frame, now)),
        }
        let order = if self.sticks_first {
            [RcSource::Sticks, RcSource::Udp, RcSource::Msp]
        } else {
            [RcSource::Udp, RcSource::Msp, RcSource::Sticks]
        };
        self.in_charge =
            order.into_iter().find(|&candidate| self.seat(candidate).is_some_and(|s| s.is_fresh(now)));
        (self.in_charge == Some(source)).then_some(frame)
    }

    /// Gives the virtual sticks priority over the other sources, or ends that.
    pub fn take_over(&mut self, sticks_first: bool) {
        self.sticks_first = sticks_first;
    }

    /// Returns `true` while the virtual sticks have priority over the other sources.
    pub fn taken_over(&self) -> bool {
        self.sticks_first
    }

    /// Returns the source whose frames are used; `None` before the first frame.
    pub fn in_charge(&self) -> Option<RcSource> {
        self.in_charge
    }

    /// Returns the frames a second of the source in charge; 0 until it is measured.
    pub fn rate_hz(&self) -> f64 {
        self.in_charge.and_then(|source| self.seat(source)).map_or(0.0, |seat| seat.rate_hz)
    }

    fn seat(&self, source: RcSource) -> Option<&Seat> {
        match source {
            RcSource::Udp => self.udp.as_ref(),
            RcSource::Msp => self.msp.as_ref(),
            RcSource::Sticks => self.sticks.as_ref(),
        }
    }

    fn seat_mut(&mut self, source: RcSource) -> &mut Option<Seat> {
        match source {
            RcSource::Udp => &mut self.udp,
            RcSource::Msp => &mut self.msp,
            RcSource::Sticks => &mut self.sticks,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(ms: u64) -> SimTime {
        SimTime(ms * 1000)
    }

    #[test]
    fn priority_is_udp_then_msp_then_sticks() {
        let mut sources = Sources::default();
        assert!(sources.receive(RcFrame::SAFE, RcSource::Sticks, at(0)).is_some());
        assert!(sources.receive(RcFrame::SAFE, RcSource::Msp, at(10)).is_some());
        assert!(sources.receive(RcFrame::SAFE, RcSource::Sticks, at(20)).is_none());
        assert!(sources.receive(RcFrame::SAFE, RcSource::Udp, at(30)).is_some());
        assert!(sources.receive(RcFrame::SAFE, RcSource::Msp, at(40)).is_none());
        assert_eq!(sources.in_charge(), Some(RcSource::Udp));
    }

    #[test]
    fn a_silent_source_gives_way_after_300_ms() {
        let mut sources = Sources::default();
        sources.receive(RcFrame::SAFE, RcSource::Udp, at(0));
        assert!(sources.receive(RcFrame::SAFE, RcSource::Sticks, at(299)).is_none());
        assert!(sources.receive(RcFrame::SAFE, RcSource::Sticks, at(300)).is_some());
    }

    #[test]
    fn take_over_puts_the_sticks_first() {
        let mut sources = Sources::default();
        sources.receive(RcFrame::SAFE, RcSource::Udp, at(0));
        sources.take_over(true);
        assert!(sources.receive(RcFrame::SAFE, RcSource::Sticks, at(1)).is_some());
        assert!(sources.receive(RcFrame::SAFE, RcSource::Udp, at(2)).is_none());
    }

    #[test]
    fn rate_is_measured_over_frames() {
        let mut sources = Sources::default();
        for frame in 0..60 {
            sources.receive(RcFrame::SAFE, RcSource::Udp, at(frame * 20));
        }
        assert!((sources.rate_hz() - 50.0).abs() < 1e-9);
    }
}
