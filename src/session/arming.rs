//! Reports why a script that holds the ARM switch on does not arm: the script cannot see the arming disable
//! flags.

use crate::signals::{RcSource, SimTime};
use crate::telemetry::{ArmingFlag, Mode, Snapshot};

/// The time for which the switch is on before the user gets a notice, s.
const REPORT_AFTER_S: f64 = 1.0;

/// Watches the ARM switch of RC that comes over a link.
#[derive(Debug, Default)]
pub(super) struct ArmingWatch {
    request: Option<ArmRequest>,
}

/// The ARM switch is on.
#[derive(Debug)]
struct ArmRequest {
    since: SimTime,
    /// `true` once the craft has armed or the reason was reported.
    done: bool,
}

impl ArmingWatch {
    /// Checks the craft. Returns a sentence for the user once each time the switch is moved without effect.
    pub(super) fn check(&mut self, vehicle: &Snapshot) -> Option<String> {
        let craft = &vehicle.craft;
        let from_outside = matches!(craft.rc_source, Some(RcSource::Udp | RcSource::Msp));
        if !from_outside || !craft.is_switched_on(Mode::Arm) {
            self.request = None;
            return None;
        }
        let request = self.request.get_or_insert(ArmRequest { since: vehicle.time, done: false });
        request.done |= craft.is_armed();
        if request.done || vehicle.time.seconds_since(request.since) < REPORT_AFTER_S {
            return None;
        }
        let with_hint = |flag: ArmingFlag| format!("{flag} ({})", flag.hint());
        let flags = craft.arming_flags();
        // A firmware without arm assist blocks a switch that it has never seen off, without any other cause.
        let causes = if flags.causes().is_empty() { flags } else { flags.causes() };
        let causes: Vec<String> = causes.iter().map(with_hint).collect();
        if causes.is_empty() {
            return None;
        }
        request.done = true;
        Some(format!("ARM is switched on by another program, but arming is blocked: {}.", causes.join(", ")))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::telemetry::snapshot::ModeRange;

    /// Returns a craft whose script holds the ARM switch on.
    fn vehicle(seconds: f64, flags: &[ArmingFlag]) -> Snapshot {
        let mut vehicle = Snapshot { time: SimTime::from_secs_f64(seconds), ..Snapshot::default() };
        let craft = &mut vehicle.craft;
        let arm = ModeRange { mode_box: Mode::Arm.into(), channel: 4, start_us: 1700, end_us: 2100 };
        craft.mode_ranges = Some(vec![arm]);
        craft.rc_source = Some(RcSource::Udp);
        craft.channels.get_or_insert_default()[4] = 2000;
        craft.arming_blocked_by = Some(flags.iter().copied().collect());
        vehicle
    }

    #[test]
    fn a_switch_that_is_on_in_vain_is_reported_once() {
        let mut watch = ArmingWatch::default();
        let blocked =
            |seconds| vehicle(seconds, &[ArmingFlag::Throttle, ArmingFlag::Cli, ArmingFlag::ArmSwitch]);
        assert_eq!(watch.check(&blocked(10.0)), None);
        assert_eq!(watch.check(&blocked(10.9)), None);
        let reported = watch.check(&blocked(11.0)).expect("a sentence");
        assert!(
            reported.contains("THROTTLE (lower the throttle), CLI (a CLI session was opened: "),
            "{reported}"
        );
        assert!(!reported.contains("ARM_SWITCH"), "{reported}");
        assert_eq!(watch.check(&blocked(20.0)), None);
        let mut off = blocked(21.0);
        off.craft.channels.get_or_insert_default()[4] = 1000;
        assert_eq!(watch.check(&off), None);
        assert_eq!(watch.check(&blocked(22.0)), None);
        assert!(watch.check(&blocked(23.0)).is_some());
    }

    #[test]
    fn a_switch_that_was_never_off_is_reported_although_nothing_else_blocks() {
        let mut watch = ArmingWatch::default();
        let blocked = |seconds| vehicle(seconds, &[ArmingFlag::NotDisarmed, ArmingFlag::ArmSwitch]);
        assert_eq!(watch.check(&blocked(10.0)), None);
        let reported = watch.check(&blocked(11.0)).expect("a sentence");
        assert!(reported.contains("NOT_DISARMED (switch ARM off, then on)"), "{reported}");
        assert_eq!(watch.check(&blocked(20.0)), None);
    }

    #[test]
    fn the_switch_that_stays_on_after_a_flight_is_no_news() {
        let mut watch = ArmingWatch::default();
        let mut flying = vehicle(10.0, &[]);
        flying.craft.armed = Some(true);
        assert_eq!(watch.check(&flying), None);
        assert_eq!(watch.check(&vehicle(99.0, &[ArmingFlag::Throttle, ArmingFlag::ArmSwitch])), None);
    }

    #[test]
    fn own_sticks_need_no_notice() {
        let mut watch = ArmingWatch::default();
        for seconds in [10.0, 20.0] {
            let mut own = vehicle(seconds, &[ArmingFlag::Throttle]);
            own.craft.rc_source = Some(RcSource::Sticks);
            assert_eq!(watch.check(&own), None);
        }
    }
}
