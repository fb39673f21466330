//! The commands that are no part of a plan.

use crate::plan::format::loss::Severity;

/// The meaning of a command for a plan that has no place for it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct LeftOut {
    pub(super) severity: Severity,
    pub(super) field: &'static str,
    pub(super) why: &'static str,
}

const fn row(severity: Severity, field: &'static str, why: &'static str) -> Option<LeftOut> {
    Some(LeftOut { severity, field, why })
}

/// Returns the row of a command that is left out; `None` if the command is flown or unknown.
pub(super) const fn left_out(command: u16) -> Option<LeftOut> {
    match command {
        80 | 195..=197 | 201 => {
            row(Severity::Lost, "nose direction", "a region of interest: ap_yaw_mode decides")
        }
        114 | 115 => row(Severity::Lost, "nose direction", "a plan has no heading: ap_yaw_mode decides"),
        112 => row(Severity::Info, "condition", "it delays commands that a plan does not have"),
        181..=184 => row(Severity::Lost, "servo or relay", "the autopilot switches no outputs"),
        211 => row(Severity::Lost, "gripper", "the autopilot moves no gripper"),
        189 => row(Severity::Info, "landing start", "it marks a place in the list"),
        202 | 203 | 206 | 214 | 530..=534 | 2000..=2004 | 2500..=2505 => {
            row(Severity::Info, "camera", "the autopilot does not use a camera")
        }
        204 | 205 | 1000 | 1001 => row(Severity::Info, "gimbal", "the autopilot does not move a gimbal"),
        5000..=5004 => row(Severity::Lost, "fence", "this craft will not keep to it"),
        5100 => row(Severity::Lost, "rally point", "this craft returns to its home"),
        _ => None,
    }
}
