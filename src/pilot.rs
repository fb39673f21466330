//! The scripted pilot: flies a whole mission by RC alone, fifty frames per simulated second.
//!
//! The pilot waits for the fix and until no arming disable flag is set, arms with the throttle low, raises it,
//! switches ANGLE, ALTHOLD and POS HOLD on, climbs, hovers, switches AUTOPILOT on, and then holds the sticks still.
//! Its mode switches stay on, so that a craft whose autopilot refuses continues to hover. If the heading is unknown,
//! the pilot holds the pitch stick forward for five seconds, so that the GPS shows the heading.
//!
//! The pilot sees only the OSD, as a real pilot does, and moves nothing but the sixteen channels.

mod stick_input;
mod transmitter;

pub use stick_input::{StickInput, channel_index, channel_name, pulse_us};
pub use transmitter::{FRAME_US, RcTransmitter};

use crate::signals::{RcFrame, SimTime};
use crate::telemetry::Mode;
use crate::telemetry::snapshot::ModeRange;
use crate::telemetry::switch::Switch;

/// The time of hover between the climb and the engagement, s.
const HOVER_S: f64 = 5.0;
/// The climb rate that the pilot aims at, m/s.
const CLIMB_MPS: f64 = 2.0;
/// The time for the throttle stick to go from low to hover, s.
const RAISE_S: f64 = 0.8;
/// The interval of RC frames, s.
const FRAME_S: f64 = 0.02;
/// The channel index of the throttle.
const THROTTLE: usize = 2;
/// The throttle stick at the bottom, µs.
const LOW_US: f64 = 1000.0;
/// The time for which the pitch stick is held forward to find an unknown heading, s.
const AHEAD_S: f64 = 5.0;
/// The minimum height above home for that, m.
const AHEAD_ALT_M: f64 = 5.0;
/// The channel index of pitch, and its stick in the middle, µs.
const PITCH: usize = 1;
const MID_US: u16 = 1500;
/// The height below the takeoff altitude at which the climb ends, m, and the response time, s, and deceleration,
/// m/s², of ALTHOLD that the pilot expects.
const TOP_M: f64 = 0.1;
const RESPONSE_S: f64 = 0.3;
const STOP_MPS2: f64 = 1.25;
/// A craft that is higher (m) or climbs faster (m/s) has left the ground.
const AIRBORNE_M: f64 = 0.3;
const AIRBORNE_MPS: f64 = 0.3;
/// On the ground the stick quickly goes up by this share of its travel, and then further at this rate, µs/s.
const GROUND_STICK_SHARE: f64 = 0.4;
const GROUND_STICK_US_PER_S: f64 = 20.0;
/// The highest stick position of the pilot in a climb, µs.
const CLIMB_STICK_MAX_US: f64 = 2000.0;

/// The facts that the pilot sees.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PilotFacts {
    /// Simulated time since boot.
    pub time: SimTime,
    /// `true` if there is a 3-D fix.
    pub fix: bool,
    /// `true` if an arming disable flag is set.
    pub arming_blocked: bool,
    /// `true` if the craft is armed.
    pub armed: bool,
    /// `true` if the autopilot is engaged.
    pub engaged: bool,
    /// `true` if the heading is known.
    pub heading_known: bool,
    /// Pitch stick that tilts the craft forward by 15° in ANGLE, µs.
    pub forward_stick_us: u16,
    /// Altitude above home, m.
    pub alt_m: f64,
    /// Climb rate, m/s.
    pub climb_mps: f64,
    /// Throttle stick that holds the altitude in ALTHOLD, µs.
    pub hover_stick_us: u16,
    /// Throttle stick from which the throttle counts as raised, µs.
    pub raised_stick_us: u16,
}

impl PilotFacts {
    /// Returns `true` if the craft has left the ground as far as the pilot sees.
    fn is_airborne(&self) -> bool {
        self.alt_m > AIRBORNE_M || self.climb_mps > AIRBORNE_MPS
    }
}

/// The phase of the scripted flight.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Phase {
    Waiting,
    Arming,
    Raising { since: SimTime },
    Climbing { stick_us: f64 },
    Hovering { since: SimTime },
    Engaging,
    FlyingAhead { since: SimTime },
    Engaged,
    Done,
}

/// The mode switches of the pilot.
#[derive(Debug, Clone, Copy, PartialEq)]
struct ModeSwitches {
    arm: Switch,
    levelling: [Option<Switch>; 3],
    autopilot: Switch,
}

/// The scripted pilot. A copy flies on by itself.
#[derive(Debug, Clone, PartialEq)]
pub struct Pilot {
    phase: Phase,
    takeoff_m: f64,
    switches: ModeSwitches,
    frame: RcFrame,
    /// Throttle stick that holds the altitude in ALTHOLD, as last seen, µs.
    hover_stick_us: u16,
}

impl Pilot {
    /// Returns a pilot that climbs to `takeoff_m` metres before engaging (0: engages at once, on the ground). It uses
    /// the channels that the mode conditions of the craft name.
    ///
    /// # Errors
    /// Fails with the mode that no channel switches. Without ARM and AUTOPILOT there is no flight.
    pub fn new(takeoff_m: f64, ranges: &[ModeRange]) -> Result<Self, Mode> {
        let find = |mode| Switch::of(mode, ranges);
        let switches = ModeSwitches {
            arm: find(Mode::Arm).ok_or(Mode::Arm)?,
            levelling: [Mode::Angle, Mode::AltHold, Mode::PosHold].map(find),
            autopilot: find(Mode::Autopilot).ok_or(Mode::Autopilot)?,
        };
        Ok(Self { phase: Phase::Waiting, takeoff_m, switches, frame: RcFrame::SAFE, hover_stick_us: MID_US })
    }

    /// Returns the altitude to which the pilot climbs before engaging, m.
    pub fn takeoff_m(&self) -> f64 {
        self.takeoff_m
    }

    /// Returns the present action of the pilot in a word or two.
    pub fn doing(&self) -> &'static str {
        match self.phase {
            Phase::Waiting => "waiting to arm",
            Phase::Arming => "arming",
            Phase::Raising { .. } => "taking off",
            Phase::Climbing { .. } => "climbing",
            Phase::Hovering { .. } => "hovering",
            Phase::Engaging => "engaging",
            Phase::FlyingAhead { .. } => "finding the heading",
            Phase::Engaged => "watching",
            Phase::Done => "done",
        }
    }

    /// Returns `true` if the flight is over for the pilot.
    pub fn is_done(&self) -> bool {
        self.phase == Phase::Done
    }

    /// Returns the next frame. Call it every 20 ms of simulated time.
    pub fn fly(&mut self, facts: &PilotFacts) -> RcFrame {
        self.hover_stick_us = facts.hover_stick_us;
        self.advance(facts);
        let throttle = match self.phase {
            Phase::Waiting | Phase::Arming | Phase::Done => LOW_US,
            Phase::Raising { since } => {
                let part = (facts.time.seconds_since(since) / RAISE_S).clamp(0.0, 1.0);
                LOW_US + part * (f64::from(facts.raised_stick_us) - LOW_US)
            }
            Phase::Climbing { stick_us } => stick_us,
            Phase::Hovering { .. } | Phase::Engaging | Phase::FlyingAhead { .. } => {
                f64::from(facts.hover_stick_us)
            }
            Phase::Engaged => 1500.0,
        };
        self.frame.channels[THROTTLE] = throttle.round() as u16;
        self.frame.channels[PITCH] =
            if matches!(self.phase, Phase::FlyingAhead { .. }) { facts.forward_stick_us } else { MID_US };
        self.frame
    }

    /// Returns the sticks as the pilot leaves them. A climbing craft holds its altitude, a craft that is still on the
    /// ground stays there.
    pub(super) fn released(&self) -> RcFrame {
        let mut frame = self.frame;
        match self.phase {
            Phase::Climbing { .. } => frame.channels[THROTTLE] = self.hover_stick_us,
            Phase::Raising { .. } => frame.channels[THROTTLE] = LOW_US as u16,
            Phase::FlyingAhead { .. } => frame.channels[PITCH] = MID_US,
            Phase::Waiting
            | Phase::Arming
            | Phase::Hovering { .. }
            | Phase::Engaging
            | Phase::Engaged
            | Phase::Done => {}
        }
        frame
    }

    fn advance(&mut self, facts: &PilotFacts) {
        let flying = !matches!(self.phase, Phase::Waiting | Phase::Arming | Phase::Done);
        if flying && !facts.armed {
            self.phase = Phase::Done;
            self.frame = RcFrame::SAFE;
            return;
        }
        match self.phase {
            Phase::Waiting => {
                if facts.fix && !facts.arming_blocked {
                    self.switch_on(self.switches.arm);
                    self.phase = Phase::Arming;
                }
            }
            Phase::Arming => {
                if facts.armed {
                    self.phase = Phase::Raising { since: facts.time };
                } else if facts.arming_blocked {
                    // The firmware refused to arm after all: release the switch and wait until the cause is gone.
                    self.frame = RcFrame::SAFE;
                    self.phase = Phase::Waiting;
                }
            }
            Phase::Raising { since } => {
                if facts.time.seconds_since(since) >= RAISE_S {
                    for switch in self.switches.levelling.into_iter().flatten() {
                        self.switch_on(switch);
                    }
                    if !facts.heading_known {
                        // The craft must fly forward before the autopilot engages.
                        self.takeoff_m = self.takeoff_m.max(AHEAD_ALT_M);
                    }
                    self.phase = if self.takeoff_m > 0.0 {
                        Phase::Climbing { stick_us: f64::from(facts.hover_stick_us) }
                    } else {
                        self.switch_on(self.switches.autopilot);
                        Phase::Engaging
                    };
                }
            }
            Phase::Climbing { stick_us } => {
                let left = self.takeoff_m - facts.alt_m;
                // ALTHOLD comes to rest within the remaining height.
                let climb = facts.climb_mps.max(0.0);
                if left <= TOP_M + climb * RESPONSE_S + climb * climb / (2.0 * STOP_MPS2) {
                    self.phase = Phase::Hovering { since: facts.time };
                } else {
                    self.phase = Phase::Climbing { stick_us: climb_stick(stick_us, left, facts) };
                }
            }
            Phase::Hovering { since } => {
                if facts.time.seconds_since(since) >= HOVER_S {
                    self.switch_on(self.switches.autopilot);
                    self.phase = Phase::Engaging;
                }
            }
            Phase::Engaging => {
                if facts.engaged {
                    self.phase = Phase::Engaged;
                } else if !facts.heading_known {
                    self.phase = Phase::FlyingAhead { since: facts.time };
                }
            }
            Phase::FlyingAhead { since } => {
                if facts.engaged {
                    self.phase = Phase::Engaged;
                } else if facts.time.seconds_since(since) >= AHEAD_S {
                    self.phase = Phase::Engaging;
                }
            }
            Phase::Engaged | Phase::Done => {}
        }
    }

    fn switch_on(&mut self, switch: Switch) {
        self.frame.channels[switch.channel] = switch.on_us;
    }
}

/// Returns the stick position that approaches the wanted climb, slower near the top as a person would do. On the
/// ground the stick goes up quickly by a large part of its travel and then slowly, since the craft needs a moment to
/// lift off.
fn climb_stick(stick_us: f64, left_m: f64, facts: &PilotFacts) -> f64 {
    let hover_us = f64::from(facts.hover_stick_us);
    let wanted = CLIMB_MPS.min(0.3 + 0.8 * left_m);
    let is_early = facts.is_airborne() || stick_us < hover_us + GROUND_STICK_SHARE * (2000.0 - hover_us);
    let rate = if is_early { 120.0 * (wanted - facts.climb_mps) } else { GROUND_STICK_US_PER_S };
    (stick_us + rate * FRAME_S).clamp(hover_us, CLIMB_STICK_MAX_US)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn range(mode: Mode, channel: u8) -> ModeRange {
        ModeRange { mode_box: mode.into(), channel, start_us: 1700, end_us: 2100 }
    }

    fn ranges() -> Vec<ModeRange> {
        vec![
            range(Mode::Arm, 4),
            range(Mode::Autopilot, 5),
            range(Mode::Angle, 6),
            range(Mode::AltHold, 6),
            range(Mode::PosHold, 6),
        ]
    }

    fn facts(seconds: f64) -> PilotFacts {
        PilotFacts {
            time: SimTime::from_secs_f64(seconds),
            fix: true,
            arming_blocked: false,
            armed: false,
            engaged: false,
            heading_known: true,
            forward_stick_us: 1625,
            alt_m: 0.0,
            climb_mps: 0.0,
            hover_stick_us: 1500,
            raised_stick_us: 1300,
        }
    }

    #[test]
    fn needs_arm_and_autopilot_switches() {
        assert_eq!(Pilot::new(10.0, &[range(Mode::Arm, 4)]), Err(Mode::Autopilot));
        assert_eq!(Pilot::new(10.0, &[]), Err(Mode::Arm));
    }

    #[test]
    fn arms_only_when_nothing_blocks_and_with_low_throttle() {
        let mut pilot = Pilot::new(10.0, &ranges()).unwrap();
        let blocked = PilotFacts { arming_blocked: true, ..facts(0.0) };
        assert_eq!(pilot.fly(&blocked), RcFrame::SAFE);
        let frame = pilot.fly(&facts(1.0));
        assert_eq!(frame.channels[4], 1900);
        assert_eq!(frame.channels[THROTTLE], 1000);
    }

    #[test]
    fn flies_ahead_when_the_heading_is_unknown() {
        let mut pilot = Pilot::new(0.0, &ranges()).unwrap();
        pilot.fly(&facts(0.0));
        let at = |seconds, heading_known| PilotFacts {
            armed: true,
            alt_m: if seconds > 2.0 { 5.0 } else { 0.0 },
            heading_known,
            ..facts(seconds)
        };
        pilot.fly(&at(1.0, false));
        assert_eq!(pilot.fly(&at(2.0, false)).channels[5], 1000, "climbs before it engages");
        pilot.fly(&at(4.0, false));
        assert_eq!(pilot.doing(), "hovering");
        assert_eq!(pilot.fly(&at(9.1, false)).channels[5], 1900);
        assert_eq!(pilot.fly(&at(9.2, false)).channels[PITCH], 1625);
        assert_eq!(pilot.doing(), "finding the heading");
        assert_eq!(pilot.fly(&at(14.1, true)).channels[PITCH], 1625);
        assert_eq!(pilot.fly(&at(14.2, true)).channels[PITCH], 1500);
        pilot.fly(&PilotFacts { engaged: true, ..at(14.3, true) });
        assert_eq!(pilot.doing(), "watching");
    }

    #[test]
    fn a_pilot_that_is_stopped_leaves_no_stick_that_climbs() {
        let mut transmitter = RcTransmitter::default();
        transmitter.start_pilot(Pilot::new(10.0, &ranges()).unwrap());
        let at = |seconds| PilotFacts { armed: true, ..facts(seconds) };
        let facts = [facts(0.0), at(1.0), at(2.0), at(2.02)];
        for facts in &facts {
            transmitter.frame(facts, None);
        }
        assert_eq!(transmitter.pilot_doing(), Some("climbing"));
        assert!(transmitter.sticks().channels[THROTTLE] > 1500);
        transmitter.stop_pilot();
        assert_eq!(transmitter.sticks().channels[THROTTLE], 1500);
        assert_eq!(transmitter.sticks().channels[6], 1900, "ALTHOLD stays on");

        transmitter.start_pilot(Pilot::new(10.0, &ranges()).unwrap());
        transmitter.frame(&facts[0], None);
        transmitter.frame(&facts[1], None);
        transmitter.frame(&at(1.5), None);
        assert_eq!(transmitter.pilot_doing(), Some("taking off"));
        transmitter.stop_pilot();
        assert_eq!(transmitter.sticks().channels[THROTTLE], 1000, "on the ground without ALTHOLD");
    }

    #[test]
    fn climbs_hovers_engages_and_centres_the_throttle() {
        let mut pilot = Pilot::new(10.0, &ranges()).unwrap();
        pilot.fly(&facts(0.0));
        let flying = PilotFacts { armed: true, ..facts(1.0) };
        pilot.fly(&flying);
        let at = |seconds, alt_m, engaged| PilotFacts {
            alt_m,
            engaged,
            ..PilotFacts { armed: true, ..facts(seconds) }
        };
        let frame = pilot.fly(&at(2.0, 0.1, false));
        assert_eq!(frame.channels[6], 1900, "levelling modes on once the throttle is up");
        assert!(pilot.fly(&at(2.02, 0.2, false)).channels[THROTTLE] > 1500);
        assert_eq!(pilot.fly(&at(7.0, 9.9, false)).channels[THROTTLE], 1500);
        assert_eq!(pilot.fly(&at(11.9, 10.0, false)).channels[5], 1000);
        assert_eq!(pilot.fly(&at(12.1, 10.0, false)).channels[5], 1900);
        assert_eq!(pilot.doing(), "engaging");
        pilot.fly(&at(12.2, 10.0, true));
        assert_eq!(pilot.doing(), "watching");
        assert_eq!(pilot.fly(&PilotFacts { armed: false, ..facts(99.0) }), RcFrame::SAFE);
        assert!(pilot.is_done());
    }
}
