//! The waiting and active faults, and the time at which the next one begins or ends.

use arrayvec::ArrayVec;

use crate::signals::SimTime;

use super::{Effects, Fault, FaultStart, ScheduledFault};

/// The maximum number of waiting and active faults together.
pub const MAX_FAULTS: usize = 64;

/// An active fault with its end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::sim) struct ActiveFault {
    pub fault: Fault,
    /// Time of its end; `None` if it does not end.
    pub until: Option<SimTime>,
}

/// A fault that begins now, with its end, or ends now.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::sim) enum FaultChange {
    Begin(ActiveFault),
    End(Fault),
}

/// The waiting and the active faults.
#[derive(Debug, Clone)]
pub(in crate::sim) struct FaultSchedule {
    waiting: Vec<ScheduledFault>,
    active: ArrayVec<ActiveFault, MAX_FAULTS>,
    engaged: Option<SimTime>,
    /// Faults that the engagement has begun. The next flight begins them again.
    spent: ArrayVec<ScheduledFault, MAX_FAULTS>,
    /// Time at which the next one begins or ends, µs; `u64::MAX` if none will.
    next_us: u64,
}

impl FaultSchedule {
    pub(crate) fn new(waiting: Vec<ScheduledFault>) -> Self {
        let mut schedule =
            Self { waiting, active: ArrayVec::new(), engaged: None, spent: ArrayVec::new(), next_us: 0 };
        schedule.look_ahead();
        schedule
    }

    /// Returns `true` if a fault begins or ends at or before `now`.
    pub(crate) fn is_due(&self, now: SimTime) -> bool {
        now.0 >= self.next_us
    }

    /// Takes one fault that ends or begins at or before `now`: ends first, then beginnings in the order of their
    /// times.
    pub(crate) fn take_due(&mut self, now: SimTime) -> Option<FaultChange> {
        let change = self.take_ended(now).or_else(|| self.take_begun(now));
        self.look_ahead();
        change
    }

    fn take_ended(&mut self, now: SimTime) -> Option<FaultChange> {
        let ended = self.active.iter().position(|active| active.until.is_some_and(|until| until <= now))?;
        Some(FaultChange::End(self.active.remove(ended).fault))
    }

    fn take_begun(&mut self, now: SimTime) -> Option<FaultChange> {
        let (due, index) = (0..self.waiting.len())
            .filter_map(|i| Some((self.due(&self.waiting[i])?, i)))
            .filter(|&(due, _)| due <= now)
            .min()?;
        let scheduled = self.waiting.remove(index);
        if matches!(scheduled.start, FaultStart::Engagement(_)) {
            // There is room, since these and the waiting faults are at most MAX_FAULTS together.
            let _ = self.spent.try_push(scheduled);
        }
        let ScheduledFault { fault, for_s, .. } = scheduled;
        let until = for_s.map(|seconds| SimTime(due.0.saturating_add(SimTime::from_secs_f64(seconds).0)));
        Some(FaultChange::Begin(self.insert(fault, until)))
    }

    /// Activates a fault now. It replaces an active one with the same key.
    pub(crate) fn insert(&mut self, fault: Fault, until: Option<SimTime>) -> ActiveFault {
        let begun = ActiveFault { fault, until };
        if !fault.is_instant() {
            self.active.retain(|active| fault.key() != active.fault.key());
            // There is room, since waiting and active faults together are at most MAX_FAULTS.
            let _ = self.active.try_push(begun);
        }
        self.look_ahead();
        begun
    }

    /// Returns `true` if another fault can be activated or scheduled.
    pub(crate) fn has_room(&self) -> bool {
        self.active.len() + self.waiting.len() + self.spent.len() < MAX_FAULTS
    }

    /// Changes the end of an active fault.
    pub(crate) fn set_end(&mut self, fault: &Fault, until: SimTime) {
        for active in self.active.iter_mut().filter(|active| active.fault == *fault) {
            active.until = Some(until);
        }
        self.look_ahead();
    }

    /// Ends the first active fault for which `ends` returns `true`.
    pub(crate) fn end_first(&mut self, ends: impl Fn(&Fault) -> bool) -> Option<Fault> {
        let index = self.active.iter().position(|active| ends(&active.fault))?;
        let fault = self.active.remove(index).fault;
        self.look_ahead();
        Some(fault)
    }

    /// Ends the first active fault of the link that lasts until `time` or less.
    pub(crate) fn end_link_fault(&mut self, time: SimTime) -> Option<Fault> {
        let over = |active: &ActiveFault| {
            active.fault.needs_link() && active.until.is_some_and(|until| until <= time)
        };
        let index = self.active.iter().position(over)?;
        let fault = self.active.remove(index).fault;
        self.look_ahead();
        Some(fault)
    }

    /// Forgets the faults that wait.
    pub(crate) fn forget_waiting(&mut self) {
        self.waiting.clear();
        self.spent.clear();
        self.look_ahead();
    }

    /// Adds a fault that will begin.
    pub(crate) fn add(&mut self, fault: ScheduledFault) {
        self.waiting.push(fault);
        self.look_ahead();
    }

    /// Ends the flight. Faults without `boot+` wait for the next engagement, including those that this engagement has
    /// begun. Returns one fault that was active and ends now. Call this until it returns `None`.
    pub(crate) fn wait_for_next_flight(&mut self) -> Option<Fault> {
        self.engaged = None;
        let mut ended = None;
        while ended.is_none()
            && let Some(scheduled) = self.spent.pop()
        {
            self.waiting.push(scheduled);
            ended = self.end_first(|fault| *fault == scheduled.fault);
        }
        self.look_ahead();
        ended
    }

    /// Sets the time from which faults without `boot+` count. Only the first call in a flight has an effect.
    pub(crate) fn set_engaged(&mut self, time: SimTime) {
        if self.engaged.is_none() {
            self.engaged = Some(time);
            self.look_ahead();
        }
    }

    pub(crate) fn active(&self) -> &[ActiveFault] {
        &self.active
    }

    pub(crate) fn waiting(&self) -> &[ScheduledFault] {
        &self.waiting
    }

    /// Returns the combined effects of the active faults.
    pub(crate) fn effects(&self) -> Effects {
        let mut effects = Effects::NONE;
        for active in &self.active {
            effects.add(&active.fault);
        }
        effects
    }

    fn due(&self, fault: &ScheduledFault) -> Option<SimTime> {
        match fault.start {
            FaultStart::Boot(seconds) => Some(SimTime::from_secs_f64(seconds)),
            FaultStart::Engagement(seconds) => self
                .engaged
                .map(|engaged| SimTime(engaged.0.saturating_add(SimTime::from_secs_f64(seconds).0))),
        }
    }

    fn look_ahead(&mut self) {
        let begins = self.waiting.iter().filter_map(|fault| self.due(fault));
        let ends = self.active.iter().filter_map(|active| active.until);
        self.next_us = begins.chain(ends).map(|time| time.0).min().unwrap_or(u64::MAX);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn changes(schedule: &mut FaultSchedule, now_s: f64) -> Vec<(&'static str, bool)> {
        let now = SimTime::from_secs_f64(now_s);
        let mut seen = Vec::new();
        while schedule.is_due(now) {
            let Some(change) = schedule.take_due(now) else { break };
            seen.push(match change {
                FaultChange::Begin(begun) => (begun.fault.name(), true),
                FaultChange::End(fault) => (fault.name(), false),
            });
        }
        seen
    }

    fn schedule(faults: &[&str]) -> FaultSchedule {
        FaultSchedule::new(faults.iter().map(|text| text.parse().unwrap()).collect())
    }

    #[test]
    fn faults_begin_in_order_and_end_after_their_time() {
        let mut schedule = schedule(&["mag-off@boot+2", "gps-loss@boot+1,2"]);
        assert_eq!(changes(&mut schedule, 0.999), []);
        assert_eq!(changes(&mut schedule, 1.0), [("gps-loss", true)]);
        assert_eq!(changes(&mut schedule, 2.5), [("mag-off", true)]);
        assert_eq!(changes(&mut schedule, 3.0), [("gps-loss", false)]);
        assert_eq!(changes(&mut schedule, 1e6), []);
        assert_eq!(schedule.active().len(), 1);
    }

    #[test]
    fn faults_wait_for_the_first_engagement() {
        let mut schedule = schedule(&["gps-loss@1"]);
        assert_eq!(changes(&mut schedule, 100.0), []);
        schedule.set_engaged(SimTime::from_secs_f64(100.0));
        schedule.set_engaged(SimTime::from_secs_f64(200.0));
        assert_eq!(changes(&mut schedule, 100.5), []);
        assert_eq!(changes(&mut schedule, 101.0), [("gps-loss", true)]);
    }

    #[test]
    fn after_a_reset_the_faults_of_the_flight_wait_for_the_next_one() {
        let mut schedule = schedule(&["gps-loss@1", "mag-off@5", "rx-loss@boot+1"]);
        schedule.set_engaged(SimTime::from_secs_f64(100.0));
        assert_eq!(changes(&mut schedule, 101.0), [("rx-loss", true), ("gps-loss", true)]);
        assert_eq!(schedule.wait_for_next_flight().map(|fault| fault.name()), Some("gps-loss"));
        assert_eq!(schedule.wait_for_next_flight(), None);
        assert_eq!(changes(&mut schedule, 300.0), [], "nothing is engaged");
        schedule.set_engaged(SimTime::from_secs_f64(300.0));
        assert_eq!(changes(&mut schedule, 301.0), [("gps-loss", true)]);
        assert_eq!(changes(&mut schedule, 305.0), [("mag-off", true)]);
        assert_eq!(schedule.active().len(), 3, "what counts from boot stays on");
    }

    #[test]
    fn a_fault_of_the_same_kind_takes_the_place_of_the_first() {
        let mut schedule = schedule(&[]);
        for text in ["motor@0,,2:0.5", "motor@0,,3:0.5", "motor@0,,2:0"] {
            schedule.insert(text.parse::<ScheduledFault>().unwrap().fault, None);
        }
        assert_eq!(schedule.effects().efficiency, [1.0, 0.0, 0.5, 1.0]);
        assert_eq!(
            schedule.end_first(|fault| fault.name() == "motor").map(|f| f.to_string()),
            Some("3:0.5".into())
        );
    }
}
