//! The advice for a craft that does not arm.

use crate::telemetry::{ArmingFlag, ArmingFlags};

use crate::ui::model::action::Action;
use crate::ui::shared::Shared;

/// Returns the arming disable flag that helps the user most. Flags that only repeat a cause come last.
pub(in crate::ui) fn most_useful_flag(flags: ArmingFlags) -> Option<ArmingFlag> {
    let rank = |flag: &ArmingFlag| match flag {
        ArmingFlag::Cli => 0,
        ArmingFlag::RxLoss => 1,
        ArmingFlag::BootGrace => 2,
        ArmingFlag::Calibrating => 3,
        ArmingFlag::Throttle => 4,
        ArmingFlag::Failsafe => 5,
        ArmingFlag::Gps => 6,
        ArmingFlag::Angle => 7,
        ArmingFlag::AutopilotSwitch => 8,
        ArmingFlag::ArmSwitch | ArmingFlag::NotDisarmed => 10,
        _ => 9,
    };
    flags.iter().min_by_key(rank)
}

/// Returns the advice for an arming disable flag, with the key for it.
pub(in crate::ui) fn arming_hint(state: &Shared, flag: ArmingFlag) -> String {
    let (action, does) = match flag {
        ArmingFlag::RxLoss if state.view.rc_cut => (Action::CutRc, "restores the link"),
        ArmingFlag::NotDisarmed | ArmingFlag::ArmSwitch => (Action::Arm, "moves the switch"),
        ArmingFlag::Throttle => (Action::Throttle, "does it"),
        ArmingFlag::AltHoldSwitch | ArmingFlag::PosHoldSwitch => (Action::Throttle, "up and down does it"),
        ArmingFlag::AutopilotSwitch => (Action::Autopilot, "switches it off"),
        _ => return flag.hint().to_owned(),
    };
    format!("{}; `{}` {does}", flag.hint(), state.key(action))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_cause_comes_before_the_latch() {
        use ArmingFlag::{ArmSwitch, Cli, NotDisarmed, Paralyze, Throttle};
        let first = |flags: &[ArmingFlag]| most_useful_flag(flags.iter().copied().collect());
        assert_eq!(first(&[NotDisarmed, Throttle, Cli, ArmSwitch]), Some(Cli));
        assert_eq!(first(&[ArmSwitch, Paralyze]), Some(Paralyze));
        assert_eq!(first(&[ArmSwitch]), Some(ArmSwitch));
        assert_eq!(first(&[]), None);
    }
}
