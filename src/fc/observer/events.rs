//! Events of a remote flight controller, detected by comparing each report with the previous one.

use crate::geo::LatLon;
use crate::plan::FlightPlan;
use crate::telemetry::snapshot::CraftView;
use crate::telemetry::{
    DisarmReason, FirmwareEvent, Mode, ModeFlags, NavEvent, NavState, NavTelemetry, PlanSource,
    TransitionReason,
};

/// The values of the last report.
#[derive(Debug, Clone, Default)]
pub(in crate::fc) struct EventObserver {
    fix: bool,
    armed: bool,
    modes: ModeFlags,
    rc_link: Option<bool>,
    state: NavState,
    wp: u8,
    /// `true` once a landing has completed the mission.
    landed: bool,
    last_disarm: Option<DisarmReason>,
    /// `true` while GPS RESCUE flies, and after its landing.
    rescues: bool,
}

impl EventObserver {
    /// Returns the events since the previous report.
    pub(in crate::fc) fn follow(
        &mut self,
        craft: &CraftView,
        nav: Option<&NavTelemetry>,
        plan: Option<&FlightPlan>,
    ) -> Vec<FirmwareEvent> {
        let mut events = Vec::new();
        if let Some(fix) = craft.gps_fix
            && std::mem::replace(&mut self.fix, fix) != fix
        {
            let sats = craft.sats.unwrap_or_default();
            events.push(if fix { FirmwareEvent::GpsFix { sats } } else { FirmwareEvent::GpsLost { sats } });
        }
        if let Some(armed) = craft.armed
            && std::mem::replace(&mut self.armed, armed) != armed
        {
            if armed {
                self.last_disarm = None;
                self.landed = false;
                events.push(FirmwareEvent::Armed);
            } else {
                self.disarm(craft, plan, &mut events);
            }
        }
        if let Some(modes) = craft.modes
            && std::mem::replace(&mut self.modes, modes) != modes
        {
            events.push(FirmwareEvent::Mode(modes));
        }
        if self.armed {
            // A firmware whose autopilot flies the rescue may not report the mode.
            self.rescues = self.modes.has(Mode::GpsRescue) || craft.commanded == Some(true);
        }
        if let Some(link) = craft.rc_link {
            match self.rc_link.replace(link) {
                Some(true) if !link => events.push(FirmwareEvent::RxLoss),
                Some(false) if link => events.push(FirmwareEvent::RxRecovered),
                _ => {}
            }
        }
        if let Some(nav) = nav.filter(|_| self.armed) {
            self.navigate(craft, nav, plan, &mut events);
        }
        events
    }

    /// Returns the reason for the last disarming, as far as it is known.
    pub(in crate::fc) fn last_disarm(&self) -> Option<DisarmReason> {
        self.last_disarm
    }

    /// Completes a report of the navigator. A rescue is a return home, not the stored plan. The mission of a disarmed flight
    /// controller is over: complete if it ended by its landing. The report may be older than the disarming.
    pub(super) fn completed(&self, nav: NavTelemetry, armed: Option<bool>) -> NavTelemetry {
        let source = if self.rescues { PlanSource::Rth } else { nav.source };
        match (armed, self.state) {
            (Some(false), NavState::Complete) => NavTelemetry {
                state: NavState::Complete,
                wp: self.wp,
                next_wp: self.wp,
                source,
                ..at_rest(&nav)
            },
            (Some(false), _) => at_rest(&nav),
            _ => NavTelemetry { source, ..nav },
        }
    }

    fn disarm(&mut self, craft: &CraftView, plan: Option<&FlightPlan>, events: &mut Vec<FirmwareEvent>) {
        let in_failsafe = craft.is_active(Mode::Failsafe) || self.modes.has(Mode::Failsafe);
        let tells_switch = craft.channels.is_some() && craft.mode_ranges.is_some();
        let by_other = if in_failsafe {
            Some(DisarmReason::Failsafe)
        } else if tells_switch && !craft.is_switched_on(Mode::Arm) {
            Some(DisarmReason::Switch)
        } else {
            None
        };
        // Under CONTINUE a mission lands while the failsafe is on. Any other failsafe ends AUTOPILOT first.
        let goes_on = self.modes.has(Mode::Failsafe) && self.modes.has(Mode::Autopilot);
        let reason = match (self.state, by_other) {
            // Its own touchdown disarms it. That is the end of the mission.
            (NavState::Landing, by_other) if by_other.is_none() || goes_on => {
                self.enter(NavState::Complete, self.wp, TransitionReason::Touchdown, plan, events);
                DisarmReason::Landing
            }
            (NavState::Complete, _) if self.landed => DisarmReason::Landing,
            (state, by_other) => {
                if !matches!(state, NavState::Idle | NavState::Complete) {
                    self.enter(NavState::Idle, self.wp, TransitionReason::Disarm, plan, events);
                }
                by_other.unwrap_or(DisarmReason::Unknown)
            }
        };
        self.last_disarm = Some(reason);
        events.push(FirmwareEvent::Disarmed(reason));
    }

    fn navigate(
        &mut self,
        craft: &CraftView,
        nav: &NavTelemetry,
        plan: Option<&FlightPlan>,
        events: &mut Vec<FirmwareEvent>,
    ) {
        let (from, wp) = (self.state, self.wp);
        // A rescue is a mission of its own, whose waypoints are not reported.
        let plan = plan.filter(|_| !craft.modes.is_some_and(|modes| modes.has(Mode::GpsRescue)));
        if (nav.state, nav.wp) == (from, wp) {
            return;
        }
        // The mission is polled between two polls of the modes. At the touchdown it may end before the modes
        // show that.
        let may_have_landed = from == NavState::Landing && self.modes.has(Mode::Autopilot);
        if may_have_landed && nav.state == NavState::Idle && nav.reason.is_none() {
            return;
        }
        let starts = matches!(from, NavState::Idle | NavState::Complete) && nav.state != NavState::Idle;
        // The same applies to the engagement: a mission begins with its mode.
        if starts && craft.modes.is_some_and(|modes| !modes.has(Mode::Autopilot)) {
            return;
        }
        if starts {
            if let Some(plan) = plan {
                let plan = Box::new(plan.clone());
                events.push(FirmwareEvent::Nav(NavEvent::Plan { source: PlanSource::Stored, plan }));
            }
            self.enter(NavState::Approaching, nav.wp, TransitionReason::Reset, plan, events);
        }
        // Some firmware does not report the arrival. An approach ends with it.
        let approaches = (self.state, self.wp) == (nav.state, nav.wp);
        if self.state == NavState::Approaching
            && !approaches
            && !matches!(nav.state, NavState::Idle | NavState::Arrived)
        {
            self.enter(NavState::Arrived, self.wp, TransitionReason::Arrival, plan, events);
        }
        if nav.wp != self.wp && nav.state != NavState::Idle {
            self.enter(NavState::Approaching, nav.wp, TransitionReason::Advance, plan, events);
        }
        if nav.state != self.state {
            let reason = match nav.state {
                NavState::Complete if self.state == NavState::Landing => TransitionReason::Touchdown,
                NavState::Idle => nav.reason.unwrap_or(TransitionReason::Disengage),
                NavState::Approaching | NavState::Complete => TransitionReason::Advance,
                NavState::Arrived => TransitionReason::Arrival,
                NavState::Holding => TransitionReason::Hold,
                NavState::Orbiting | NavState::Figure8 => TransitionReason::Pattern,
                NavState::Landing => TransitionReason::Land,
            };
            self.enter(nav.state, nav.wp, reason, plan, events);
        }
    }

    fn enter(
        &mut self,
        to: NavState,
        wp: u8,
        reason: TransitionReason,
        plan: Option<&FlightPlan>,
        events: &mut Vec<FirmwareEvent>,
    ) {
        let waypoint = plan.and_then(|plan| plan.waypoints.get(usize::from(wp)));
        events.push(FirmwareEvent::Nav(NavEvent::State {
            from: self.state,
            to,
            wp,
            kind: waypoint.map(|waypoint| waypoint.kind),
            reason,
            guard: None,
            target: waypoint.map_or_else(LatLon::default, |waypoint| waypoint.position),
            target_alt_m: waypoint.map_or(0.0, |waypoint| waypoint.altitude.above_home_m()),
        }));
        self.landed = self.state == NavState::Landing && to == NavState::Complete;
        (self.state, self.wp) = (to, wp);
    }
}

/// Returns a report without a mission.
fn at_rest(nav: &NavTelemetry) -> NavTelemetry {
    let &NavTelemetry { reason, count, home_distance_m, .. } = nav;
    NavTelemetry { reason, count, home_distance_m, ..NavTelemetry::default() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::builtin::BuiltinPlan;
    use crate::signals::RC_CHANNELS;
    use crate::telemetry::snapshot::ModeRange;

    /// Follows a flight given as telemetry steps (armed, state, waypoint). Returns the events in words.
    fn reported(steps: &[(bool, NavState, u8)]) -> (Vec<String>, EventObserver) {
        let plan = BuiltinPlan::find("square").unwrap().read().unwrap().plan;
        let mut observer = EventObserver::default();
        let mut words = Vec::new();
        for &(armed, state, wp) in steps {
            let craft = CraftView { armed: Some(armed), ..CraftView::default() };
            let nav = NavTelemetry { state, wp, ..NavTelemetry::default() };
            for event in observer.follow(&craft, Some(&nav), Some(&plan)) {
                words.push(match event {
                    FirmwareEvent::Nav(NavEvent::State { from, to, wp, reason, target_alt_m, .. }) => {
                        assert!(target_alt_m > 0.0 || to == NavState::Landing || to == NavState::Complete);
                        format!("{from} {to} {wp} {reason}")
                    }
                    FirmwareEvent::Nav(NavEvent::Plan { .. }) => "plan".to_owned(),
                    FirmwareEvent::Armed => "armed".to_owned(),
                    FirmwareEvent::Disarmed(reason) => format!("disarmed {reason}"),
                    other => format!("{other:?}"),
                });
            }
        }
        (words, observer)
    }

    #[test]
    fn a_mission_is_followed_from_waypoint_to_waypoint() {
        use NavState::{Approaching, Complete, Idle};
        let (words, _) = reported(&[
            (true, Idle, 0),
            (true, Approaching, 0),
            (true, Approaching, 0),
            (true, Approaching, 1),
            (true, Complete, 1),
            (true, Idle, 0),
        ]);
        let expected = [
            "armed",
            "plan",
            "IDLE APPROACHING 0 reset",
            "APPROACHING ARRIVED 0 arrival",
            "ARRIVED APPROACHING 1 advance",
            "APPROACHING ARRIVED 1 arrival",
            "ARRIVED COMPLETE 1 advance",
            "COMPLETE IDLE 0 disengage",
        ];
        assert_eq!(words, expected);
    }

    #[test]
    fn a_rescue_is_a_return_home_until_its_landing_is_over() {
        let mut observer = EventObserver::default();
        let mut source = |armed: bool, rescue: bool, state| {
            let mut modes = ModeFlags::default();
            modes.set(Mode::Autopilot, armed);
            let (armed, modes, commanded) = (Some(armed), Some(modes), Some(rescue));
            let craft = CraftView { armed, modes, commanded, ..CraftView::default() };
            let nav = NavTelemetry { state, ..NavTelemetry::default() };
            observer.follow(&craft, Some(&nav), None);
            let nav = observer.completed(nav, armed);
            (nav.state, nav.source)
        };
        assert_eq!(source(true, false, NavState::Landing), (NavState::Landing, PlanSource::Stored));
        assert_eq!(source(true, true, NavState::Landing), (NavState::Landing, PlanSource::Rth));
        assert_eq!(source(false, false, NavState::Idle), (NavState::Complete, PlanSource::Rth));
        assert_eq!(source(true, false, NavState::Approaching), (NavState::Approaching, PlanSource::Stored));
    }

    #[test]
    fn a_mission_begins_with_its_mode() {
        let mut observer = EventObserver::default();
        let mut words = Vec::new();
        for autopilot in [false, false, true, true] {
            let mut modes = ModeFlags::default();
            modes.set(Mode::Autopilot, autopilot);
            let craft = CraftView { armed: Some(true), modes: Some(modes), ..CraftView::default() };
            let nav = NavTelemetry { state: NavState::Approaching, ..NavTelemetry::default() };
            for event in observer.follow(&craft, Some(&nav), None) {
                match event {
                    FirmwareEvent::Nav(NavEvent::State { to, .. }) => words.push(to.to_string()),
                    FirmwareEvent::Mode(modes) if modes.has(Mode::Autopilot) => {
                        words.push("AUTOPILOT".to_owned());
                    }
                    _ => {}
                }
            }
        }
        assert_eq!(words, ["AUTOPILOT", "APPROACHING"]);
    }

    #[test]
    fn the_waypoints_of_a_rescue_are_not_those_of_the_plan() {
        let plan = BuiltinPlan::find("square").unwrap().read().unwrap().plan;
        let mut observer = EventObserver::default();
        let mut kinds = Vec::new();
        for (rescue, wp) in [(false, 0), (true, 1), (true, 2)] {
            let mut modes = ModeFlags::default();
            modes.set(Mode::Autopilot, true);
            modes.set(Mode::GpsRescue, rescue);
            let craft = CraftView { armed: Some(true), modes: Some(modes), ..CraftView::default() };
            let nav = NavTelemetry { state: NavState::Approaching, wp, ..NavTelemetry::default() };
            for event in observer.follow(&craft, Some(&nav), Some(&plan)) {
                if let FirmwareEvent::Nav(NavEvent::State { to: NavState::Approaching, kind, .. }) = event {
                    kinds.push(kind.is_some());
                }
            }
        }
        assert_eq!(kinds, [true, false, false]);
    }

    #[test]
    fn a_hold_and_a_landing_that_disarms_are_the_end_of_the_mission() {
        use NavState::{Approaching, Complete, Holding, Idle, Landing};
        let (words, observer) = reported(&[
            (true, Approaching, 2),
            (true, Holding, 2),
            (true, Approaching, 3),
            (true, Landing, 3),
            (false, Landing, 3),
            (false, Idle, 0),
        ]);
        let expected = [
            "armed",
            "plan",
            "IDLE APPROACHING 2 reset",
            "APPROACHING ARRIVED 2 arrival",
            "ARRIVED HOLDING 2 hold",
            "HOLDING APPROACHING 3 advance",
            "APPROACHING ARRIVED 3 arrival",
            "ARRIVED LANDING 3 land",
            "LANDING COMPLETE 3 touchdown",
            "disarmed LANDING",
        ];
        assert_eq!(words, expected);
        let nav = observer.completed(NavTelemetry::default(), Some(false));
        assert_eq!((nav.state, nav.wp), (Complete, 3));
        assert_eq!(observer.last_disarm(), Some(DisarmReason::Landing));
    }

    #[test]
    fn a_landing_that_the_pilot_or_the_failsafe_cuts_short_is_no_touchdown_and_one_under_continue_is() {
        use NavState::Landing;
        let arm = ModeRange { mode_box: Mode::Arm.into(), channel: 4, start_us: 1700, end_us: 2100 };
        let craft = |armed: bool, arm_us: u16, failsafe: bool| {
            let mut modes = ModeFlags::default();
            modes.set(Mode::Autopilot, armed);
            modes.set(Mode::Failsafe, failsafe);
            let mut channels = [1500; RC_CHANNELS];
            channels[4] = arm_us;
            CraftView {
                armed: Some(armed),
                modes: Some(modes),
                channels: Some(channels),
                mode_ranges: Some(vec![arm]),
                ..CraftView::default()
            }
        };
        for (before, at_the_end, reason, to) in [
            (craft(true, 1900, false), craft(false, 1900, false), DisarmReason::Landing, NavState::Complete),
            (craft(true, 1900, false), craft(false, 1000, false), DisarmReason::Switch, NavState::Idle),
            (craft(true, 1900, false), craft(false, 1900, true), DisarmReason::Failsafe, NavState::Idle),
            (craft(true, 1900, true), craft(false, 1900, false), DisarmReason::Landing, NavState::Complete),
            (craft(true, 1900, true), craft(false, 1000, true), DisarmReason::Landing, NavState::Complete),
        ] {
            let mut observer = EventObserver::default();
            let nav = NavTelemetry { state: Landing, wp: 3, ..NavTelemetry::default() };
            observer.follow(&before, Some(&nav), None);
            let events = observer.follow(&at_the_end, Some(&nav), None);
            let entered = events.iter().find_map(|event| match event {
                FirmwareEvent::Nav(NavEvent::State { to, .. }) => Some(*to),
                _ => None,
            });
            assert_eq!((observer.last_disarm(), entered), (Some(reason), Some(to)));
        }
    }

    #[test]
    fn a_firmware_that_tells_of_its_touchdown_before_it_disarms_has_landed_too() {
        use NavState::{Complete, Landing};
        let (words, observer) = reported(&[(true, Landing, 3), (true, Complete, 3), (false, Complete, 3)]);
        assert_eq!(words[words.len() - 2..], ["LANDING COMPLETE 3 touchdown", "disarmed LANDING"]);
        assert_eq!(observer.last_disarm(), Some(DisarmReason::Landing));
    }

    #[test]
    fn a_mission_that_is_over_before_the_craft_tells_that_it_has_disarmed_has_landed() {
        use NavState::{Idle, Landing};
        let mut observer = EventObserver::default();
        let mut words = Vec::new();
        let mut modes = ModeFlags::default();
        modes.set(Mode::Autopilot, true);
        for (armed, state, autopilot) in [(true, Landing, true), (true, Idle, true), (false, Idle, false)] {
            modes.set(Mode::Autopilot, autopilot);
            let craft = CraftView { armed: Some(armed), modes: Some(modes), ..CraftView::default() };
            let nav = NavTelemetry { state, wp: 3, next_wp: 3, ..NavTelemetry::default() };
            for event in observer.follow(&craft, Some(&nav), None) {
                match event {
                    FirmwareEvent::Nav(NavEvent::State { to, .. }) => words.push(to.to_string()),
                    FirmwareEvent::Disarmed(reason) => words.push(format!("disarmed {reason}")),
                    _ => {}
                }
            }
        }
        assert_eq!(words[words.len() - 2..], ["COMPLETE", "disarmed LANDING"], "{words:?}");
    }

    #[test]
    fn a_craft_that_disarms_in_flight_ends_its_mission_without_an_invented_reason() {
        let (words, _) = reported(&[(true, NavState::Approaching, 0), (false, NavState::Approaching, 0)]);
        assert_eq!(words[3..], ["APPROACHING IDLE 0 disarm", "disarmed UNKNOWN"]);
    }

    #[test]
    fn a_disarmed_craft_flies_no_mission_whatever_an_older_report_says() {
        let (_, observer) = reported(&[(true, NavState::Approaching, 1), (false, NavState::Approaching, 1)]);
        let report = NavTelemetry {
            state: NavState::Approaching,
            engaged: true,
            wp: 1,
            count: 4,
            distance_m: Some(50.0),
            eta_s: Some(9.0),
            ..NavTelemetry::default()
        };
        let shown = observer.completed(report.clone(), Some(false));
        assert_eq!(shown, NavTelemetry { count: 4, ..NavTelemetry::default() });
        assert_eq!(observer.completed(report.clone(), None), report, "arming is unknown");
    }
}
