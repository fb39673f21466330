//! Arming and disarming: the switch, the arming disable flags, and everything that stops the motors by itself.
//!
//! The flags are judged at every RC update while disarmed. A flag that is set while the ARM switch is on also sets
//! ARM_SWITCH, which stays until the switch goes off.

pub mod crash;
pub mod runaway;

use crate::signals::SimTime;

use super::modes::boxes::{self, BoxSet};
use super::rx::Sticks;
use crate::telemetry::{ArmingFlag, ArmingFlags, DisarmReason};

/// The number of RC updates with the ARM switch off that disarm the craft.
const SWITCH_OFF_UPDATES: u8 = 4;
/// The time for which a stick command must be held, s.
const STICK_COMMAND_S: f64 = 0.5;
/// The throttle below which it counts as low with arm assist, µs.
const ASSIST_LOW_THROTTLE_US: f64 = 1150.0;

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ArmingConfig {
    /// The throttle below which it counts as low, µs.
    pub min_check_us: f64,
    /// The largest tilt at which arming is allowed, rad; `None` = arming is refused only while the attitude is unknown.
    pub small_angle_rad: Option<f64>,
    /// The time after boot before which arming is refused, s.
    pub boot_grace_s: f64,
    /// Allows the PREARM switch to stay on for the next arming.
    pub prearm_allow_rearm: bool,
    /// `true` if a mode condition for ARM exists.
    pub has_arm_condition: bool,
    /// `true` if a mode condition for PREARM exists.
    pub has_prearm_condition: bool,
    /// `true` if GPS rescue is the failsafe procedure or has a mode condition.
    pub rescue_configured: bool,
    /// The number of satellites that rescue needs.
    pub rescue_min_sats: u8,
    /// Allows arming even if rescue cannot work.
    pub rescue_allow_without_fix: bool,
    /// The yaw stick deflection that counts as full right or full left, RC units.
    pub full_yaw: f64,
    /// Enables arming by stick command if no mode condition for ARM exists.
    pub stick_arming: bool,
    /// The time at low throttle after which a stick-armed craft with stopped motors is disarmed, s; `None` = never.
    pub auto_disarm_s: Option<f64>,
    /// The throttle from which it counts as raised, µs.
    pub raised_throttle_us: f64,
    /// Softens the rules for RC from UDP, so that a simple script can arm.
    pub assist: bool,
    /// Makes the first arming since boot calibrate the gyro and wait for it.
    pub calibrate_gyro_first: bool,
    /// `true` if the motor protocol was DISABLED at boot.
    pub motors_disabled: bool,
    /// `true` if the configuration in memory differs from the running one in something that needs a restart.
    pub reboot_required: bool,
}

/// The inputs of the arming logic.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ArmingFacts {
    pub now: SimTime,
    /// `true` if a new RC frame came with this update.
    pub new_frame: bool,
    pub boxes: BoxSet,
    /// The stick positions in use.
    pub sticks: Sticks,
    /// `true` while the RC signal is present.
    pub signal: bool,
    /// `true` once the RC signal has been present for the recovery delay.
    pub link_good: bool,
    /// `true` if RC comes from UDP.
    pub from_udp: bool,
    /// `true` if a failsafe landing ended the last flight and the link has not recovered yet.
    pub failsafe_landed: bool,
    /// The tilt from level, rad; `None` = attitude unknown.
    pub tilt_rad: Option<f64>,
    /// `true` while sensors are being calibrated.
    pub calibrating: bool,
    /// The number of satellites in the fix; `None` = no fix.
    pub fix_sats: Option<u8>,
}

/// The outcome of an update.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ArmingChange {
    /// The craft was armed.
    Armed {
        /// `true` if the strict rules would have refused, so arm assist was needed.
        assisted: bool,
    },
    /// Nothing blocks arming, but the gyro must be calibrated before the first arming. Arming continues after that.
    CalibrateGyro,
    Disarmed(DisarmReason),
}

/// The gyro calibration before the first arming, if the configuration requires one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
enum FirstCalibration {
    #[default]
    Missing,
    Running,
    Done,
}

#[derive(Debug, Clone, PartialEq, Default)]
pub struct Arming {
    armed: bool,
    raised: bool,
    flags: ArmingFlags,
    latched: ArmingFlags,
    ever_armed: bool,
    first_calibration: FirstCalibration,
    link_was_good: bool,
    prearm_used: bool,
    assist_used: bool,
    off_updates: u8,
    stick_command_since: Option<SimTime>,
    low_since: Option<SimTime>,
}

impl Arming {
    pub fn armed(&self) -> bool {
        self.armed
    }

    /// Returns `true` if the throttle has been raised since arming.
    pub fn raised(&self) -> bool {
        self.raised
    }

    /// Returns `true` if the craft has been armed since boot.
    pub fn ever_armed(&self) -> bool {
        self.ever_armed
    }

    /// Returns the flags that block arming, as judged at the last update while disarmed.
    pub fn flags(&self) -> ArmingFlags {
        self.flags
    }

    /// Records that a command line session was opened. This blocks arming until reboot.
    pub fn cli_opened(&mut self) {
        self.latch(ArmingFlag::Cli);
    }

    /// Requires the ARM switch to be turned off first. Called when the failsafe ends with the switch on.
    pub fn require_switch_off(&mut self) {
        self.latch(ArmingFlag::NotDisarmed);
    }

    /// Stops the motors. Returns `false` if they were already stopped.
    pub fn disarm(&mut self, reason: DisarmReason) -> bool {
        if !self.armed {
            return false;
        }
        self.armed = false;
        self.raised = false;
        self.low_since = None;
        self.stick_command_since = None;
        match reason {
            DisarmReason::Landing => self.latch(ArmingFlag::ArmSwitch),
            DisarmReason::RunawayTakeoff => self.latch(ArmingFlag::Runaway),
            DisarmReason::CrashProtection => self.latch(ArmingFlag::Crash),
            DisarmReason::ArmingDisabled
            | DisarmReason::Failsafe
            | DisarmReason::ThrottleTimeout
            | DisarmReason::Sticks
            | DisarmReason::Switch
            | DisarmReason::GpsRescue
            | DisarmReason::SerialCommand
            | DisarmReason::Crashflip
            | DisarmReason::Unknown
            | DisarmReason::System => {}
        }
        true
    }

    fn latch(&mut self, flag: ArmingFlag) {
        self.latched.set(flag, true);
        self.flags.set(flag, true);
    }

    pub fn update(&mut self, config: &ArmingConfig, facts: &ArmingFacts) -> Option<ArmingChange> {
        if self.armed { self.update_armed(config, facts) } else { self.update_disarmed(config, facts) }
    }

    fn update_armed(&mut self, config: &ArmingConfig, facts: &ArmingFacts) -> Option<ArmingChange> {
        self.link_was_good = facts.link_good;
        if facts.sticks.throttle_us >= config.raised_throttle_us {
            self.raised = true;
        }
        let reason = self.disarm_request(config, facts)?;
        self.disarm(reason);
        Some(ArmingChange::Disarmed(reason))
    }

    fn disarm_request(&mut self, config: &ArmingConfig, facts: &ArmingFacts) -> Option<DisarmReason> {
        let low = facts.sticks.throttle_us < config.min_check_us;
        if config.has_arm_condition {
            let trusted = facts.signal || facts.boxes.has(boxes::FAILSAFE);
            if facts.boxes.has(boxes::ARM) || !trusted {
                self.off_updates = 0;
            } else if facts.new_frame {
                self.off_updates += 1;
            }
            return (self.off_updates >= SWITCH_OFF_UPDATES).then_some(DisarmReason::Switch);
        }
        let shown = low && facts.sticks.yaw <= -config.full_yaw;
        let held = self.stick_command_held(shown && listens_to_sticks(config, facts), facts.now);
        if facts.signal && held {
            return Some(DisarmReason::Sticks);
        }
        let limit = config.auto_disarm_s?;
        if !low {
            self.low_since = None;
            return None;
        }
        let since = *self.low_since.get_or_insert(facts.now);
        (facts.now.seconds_since(since) >= limit).then_some(DisarmReason::ThrottleTimeout)
    }

    fn stick_command_held(&mut self, shown: bool, now: SimTime) -> bool {
        if !shown {
            self.stick_command_since = None;
            return false;
        }
        let since = *self.stick_command_since.get_or_insert(now);
        now.seconds_since(since) >= STICK_COMMAND_S
    }

    fn update_disarmed(&mut self, config: &ArmingConfig, facts: &ArmingFacts) -> Option<ArmingChange> {
        let switch = config.has_arm_condition && facts.boxes.has(boxes::ARM);
        let assist = config.assist && facts.from_udp;
        self.update_latches(switch, assist, facts);

        if self.first_calibration == FirstCalibration::Running && !facts.calibrating {
            self.first_calibration = FirstCalibration::Done;
        }

        let strict = self.judge(config, facts, config.min_check_us);
        let mut flags = match assist {
            true => self.judge(config, facts, config.min_check_us.max(ASSIST_LOW_THROTTLE_US)),
            false => strict,
        };
        // A calibration that this switch started does not latch, so the switch need not be cycled after it.
        let waits = self.first_calibration == FirstCalibration::Running;
        let latching = if waits { strict.without(ArmingFlag::Calibrating) } else { strict };
        let would_latch = switch && !latching.is_empty();
        if would_latch && !assist {
            self.latched.set(ArmingFlag::ArmSwitch, true);
        }
        self.assist_used = switch && assist && (self.assist_used || would_latch);
        flags.set(ArmingFlag::ArmSwitch, self.latched.has(ArmingFlag::ArmSwitch));
        self.flags = flags;

        let by_stick = !config.has_arm_condition && listens_to_sticks(config, facts) && {
            let low = facts.sticks.throttle_us < config.min_check_us;
            self.stick_command_held(low && facts.sticks.yaw >= config.full_yaw, facts.now)
        };
        if !(switch || by_stick) || !flags.is_empty() {
            return None;
        }
        if config.calibrate_gyro_first && self.first_calibration == FirstCalibration::Missing {
            self.first_calibration = FirstCalibration::Running;
            return Some(ArmingChange::CalibrateGyro);
        }
        self.armed = true;
        self.ever_armed = true;
        self.raised = false;
        self.prearm_used = true;
        self.off_updates = 0;
        self.stick_command_since = None;
        self.low_since = None;
        Some(ArmingChange::Armed { assisted: std::mem::take(&mut self.assist_used) })
    }

    fn update_latches(&mut self, switch: bool, assist: bool, facts: &ArmingFacts) {
        if !switch {
            for flag in
                [ArmingFlag::NotDisarmed, ArmingFlag::Runaway, ArmingFlag::Crash, ArmingFlag::ArmSwitch]
            {
                self.latched.set(flag, false);
            }
        }
        if facts.link_good && !self.link_was_good && switch && !assist {
            self.latched.set(ArmingFlag::NotDisarmed, true);
        }
        self.link_was_good = facts.link_good;
        if facts.boxes.has(boxes::PARALYZE) {
            self.latched.set(ArmingFlag::Paralyze, true);
        }
        if !facts.boxes.has(boxes::PREARM) {
            self.prearm_used = false;
        }
    }

    /// Returns the current flags, except ARM_SWITCH.
    fn judge(&self, config: &ArmingConfig, facts: &ArmingFacts, low_throttle_us: f64) -> ArmingFlags {
        let on = |id| facts.boxes.has(id);
        let mut flags = self.latched.without(ArmingFlag::ArmSwitch);
        let mut raise = |flag, set| {
            if set {
                flags.set(flag, true);
            }
        };
        raise(ArmingFlag::Failsafe, facts.failsafe_landed);
        raise(ArmingFlag::RxLoss, !facts.link_good);
        raise(ArmingFlag::BoxFailsafe, on(boxes::FAILSAFE));
        raise(ArmingFlag::Throttle, facts.sticks.throttle_us >= low_throttle_us);
        raise(
            ArmingFlag::Angle,
            facts.tilt_rad.is_none_or(|tilt| config.small_angle_rad.is_some_and(|limit| tilt > limit)),
        );
        raise(ArmingFlag::BootGrace, facts.now.as_secs_f64() < config.boot_grace_s);
        let prearmed = on(boxes::PREARM) && (!self.prearm_used || config.prearm_allow_rearm);
        raise(ArmingFlag::NoPrearm, config.has_prearm_condition && !prearmed);
        raise(ArmingFlag::Calibrating, facts.calibrating);
        let can_rescue = facts.fix_sats.is_some_and(|sats| sats >= config.rescue_min_sats);
        raise(
            ArmingFlag::Gps,
            config.rescue_configured && !can_rescue && !config.rescue_allow_without_fix && !self.ever_armed,
        );
        raise(ArmingFlag::RescueSwitch, config.rescue_configured && on(boxes::GPS_RESCUE));
        raise(ArmingFlag::RebootRequired, config.reboot_required);
        raise(ArmingFlag::MotorProtocol, config.motors_disabled);
        raise(ArmingFlag::FlipSwitch, on(boxes::CRASH_FLIP));
        raise(ArmingFlag::AltHoldSwitch, on(boxes::ALTHOLD));
        raise(ArmingFlag::PosHoldSwitch, on(boxes::POS_HOLD));
        raise(ArmingFlag::AutopilotSwitch, on(boxes::AUTOPILOT));
        flags
    }
}

/// Returns `true` if stick positions can arm and disarm.
fn listens_to_sticks(config: &ArmingConfig, facts: &ArmingFacts) -> bool {
    config.stick_arming && !facts.boxes.has(boxes::STICK_COMMANDS_DISABLE)
}

#[cfg(test)]
mod tests;
