//! The hundred-a-second pass: failsafe, orders, navigator, holds, and which modes are on.

use crate::autopilot::io::NavInputs;
use crate::telemetry::{AbortReason, DisarmReason, FirmwareEvent, Mode, ModeFlags, NavEvent, NavState};

use super::Firmware;
use super::control::hold::HoldModes;
use super::failsafe::{FailsafeAction, FailsafeFacts, Procedure, Response};
use super::flight::Demand;
use super::mission::{OrderFacts, failsafe_response};
use super::modes::{ModeFacts, boxes, flight_modes};
use super::parameters::RescueCause;

impl Firmware {
    /// The hundred-a-second part, `dt` seconds after the last.
    pub(super) fn navigation_pass(&mut self, dt: f64) {
        self.sensor_pass();
        self.follow_fix();
        self.refresh_inputs(dt);
        self.failsafe_pass();
        self.navigator_pass();
        self.landing_pass(dt);
        self.refresh_modes();
        self.flight_pass();
    }

    /// Chooses who gives the demands of the next hundredth of a second: the navigator, the holds, or the pilot.
    fn flight_pass(&mut self) {
        let free = self.nav_output.is_none() && self.arming.armed();
        let hold = HoldModes {
            altitude: free && self.modes.has(Mode::AltHold),
            position: free && self.modes.has(Mode::PosHold),
            descend: free && self.failsafe.auto_landing(),
        };
        let throttle_us = self.rx.sticks().throttle_us;
        let parameters = &self.parameters;
        let held = self.holds.update(hold, &self.nav_inputs, throttle_us, &parameters.nav, &parameters.hold);
        if held.no_position && !self.no_position {
            self.outbox.push(FirmwareEvent::Notice("POS HOLD has no position: the craft is only levelled."));
        }
        self.no_position = held.no_position;
        self.flight.set_demand(match self.nav_output {
            Some(output) => Demand::from(output),
            None => Demand { lean: held.lean, throttle: held.throttle, ..Demand::default() },
        });
        if held.touchdown {
            self.disarm(DisarmReason::Landing);
            self.refresh_modes();
        }
    }

    fn refresh_inputs(&mut self, dt: f64) {
        let estimate = self.estimator.estimate();
        let stick = |value: f64| if self.rx.signal() { value } else { 0.0 };
        let sticks = self.rx.sticks();
        self.nav_inputs = NavInputs {
            time: self.now,
            dt,
            armed: self.arming.armed(),
            fix: self.fix && estimate.position_valid,
            altitude_valid: estimate.altitude_valid,
            throttle_raised: self.arming.raised(),
            failsafe: self.failsafe.active(),
            home: self.home,
            origin: estimate.origin.unwrap_or_default(),
            pos_ne: estimate.pos_ne,
            vel_ne: estimate.vel_ne,
            alt_m: estimate.alt_m,
            climb_mps: estimate.climb_mps,
            heading_rad: estimate.heading_rad,
            yaw_rate_rps: estimate.rates.yaw,
            roll_rad: estimate.roll_rad,
            pitch_rad: estimate.pitch_rad,
            cos_tilt: estimate.cos_tilt,
            accel_ne: estimate.accel_ne,
            throttle_us: self.flight.state().throttle_us,
            stick_roll: stick(sticks.roll),
            stick_pitch: stick(sticks.pitch),
            stick_yaw: stick(sticks.yaw),
        };
    }

    fn failsafe_pass(&mut self) {
        let inputs = &self.nav_inputs;
        let parameters = &self.parameters;
        let held =
            [Mode::Autopilot, Mode::AltHold, Mode::PosHold].into_iter().any(|mode| self.modes.has(mode));
        let received = self.rx.received_sticks(&parameters.rx);
        let facts = FailsafeFacts {
            now: self.uptime(),
            armed: inputs.armed,
            switch: self.boxes.has(boxes::FAILSAFE),
            link_up: self.link.up(),
            signal: self.rx.signal(),
            throttle_low: received.throttle_us < parameters.arming.min_check_us,
            held,
            stick_percent: received.deflection_percent(),
            fix: inputs.fix,
            home: self.home.is_some(),
            mission: self.orders.status(&self.navigator),
            response: failsafe_response(
                &self.navigator,
                &parameters.nav,
                parameters.failsafe.procedure,
                inputs.fix,
            ),
        };
        match self.failsafe.update(&parameters.failsafe, &facts) {
            Some(FailsafeAction::Stage1) => self.report_failsafe(1, facts.response),
            Some(FailsafeAction::Stage2(response) | FailsafeAction::Switch(response)) => {
                self.report_failsafe(2, response);
                self.respond(response);
            }
            Some(FailsafeAction::Disarm) => self.disarm(DisarmReason::Failsafe),
            Some(FailsafeAction::Recovered) if self.boxes.has(boxes::ARM) => self.arming.require_switch_off(),
            Some(FailsafeAction::Recovered) | None => {}
        }
    }

    fn report_failsafe(&mut self, stage: u8, response: Response) {
        let policy = self.parameters.nav.rx_loss_policy.into();
        self.outbox.push(FirmwareEvent::Failsafe { policy, stage, procedure: response.word() });
    }

    /// Carries out what stage 2 decided.
    fn respond(&mut self, response: Response) {
        let nav = &self.parameters.nav;
        let started = match response {
            Response::Procedure(Procedure::Drop) => {
                self.disarm(DisarmReason::Failsafe);
                Ok(())
            }
            Response::Procedure(Procedure::GpsRescue) => {
                let rescue = self.orders.rescue_flight(
                    &self.parameters.rescue,
                    &self.nav_inputs,
                    RescueCause::Failsafe,
                );
                self.navigator.return_to_home(&self.nav_inputs, nav, Some(rescue))
            }
            Response::EmergencyLand => self.navigator.emergency_land(&self.nav_inputs, nav),
            Response::Procedure(Procedure::AutoLand) | Response::Continue | Response::KeepLanding => Ok(()),
        };
        if let Err(refusal) = started {
            // The machine sees the absent mission and goes on to the descent.
            self.outbox.push(FirmwareEvent::Nav(NavEvent::Refused(refusal)));
        }
    }

    fn navigator_pass(&mut self) {
        let parameters = &self.parameters;
        self.nav_inputs.armed = self.arming.armed();
        self.nav_inputs.failsafe = self.failsafe.active();
        let facts = OrderFacts {
            autopilot_switch: self.boxes.has(boxes::AUTOPILOT),
            rescue_switch: self.boxes.has(boxes::GPS_RESCUE) && parameters.arming.rescue_configured,
            signal: self.rx.signal(),
            failsafe_active: self.failsafe.active(),
            failsafe_mission: self.failsafe.mission(),
            fix_for_s: if self.nav_inputs.fix { self.now.seconds_since(self.fix_since) } else { 0.0 },
        };
        let stored = &self.configuration.plan;
        self.orders.update(
            &mut self.navigator,
            &self.nav_inputs,
            &parameters.nav,
            &parameters.rescue,
            stored,
            &facts,
        );
        let output = self.navigator.update(&self.nav_inputs, &parameters.nav, stored);
        self.nav_output = self.navigator.is_flying().then_some(output);
        self.hear_navigator();
    }

    fn hear_navigator(&mut self) {
        let mut touched_down = false;
        for event in self.navigator.drain_events() {
            match event {
                NavEvent::Disarm => touched_down = true,
                NavEvent::State { to: NavState::Idle, reason, .. } => {
                    if let Some(why) = abort_reason(reason) {
                        self.orders.mission_aborted(why);
                    }
                }
                NavEvent::State { .. }
                | NavEvent::Plan { .. }
                | NavEvent::Climbing(_)
                | NavEvent::Geofence { .. }
                | NavEvent::Refused(_) => {}
            }
            self.outbox.push(FirmwareEvent::Nav(event));
        }
        if touched_down {
            self.disarm(DisarmReason::Landing);
        }
    }

    pub(super) fn refresh_modes(&mut self) {
        let modes = self.flight_modes();
        if modes != self.modes {
            self.modes = modes;
            self.outbox.push(FirmwareEvent::Mode(modes));
        }
    }

    fn flight_modes(&self) -> ModeFlags {
        let under_failsafe =
            matches!(self.failsafe.mission(), Some(Response::EmergencyLand | Response::KeepLanding));
        flight_modes(&ModeFacts {
            switches: self.boxes,
            armed: self.arming.armed(),
            raised: self.arming.raised(),
            altitude_valid: self.estimator.estimate().altitude_valid,
            failsafe_shown: self.failsafe.shown(),
            failsafe_active: self.failsafe.active(),
            autopilot: self.navigator.is_flying() && !under_failsafe,
            after_abort: self.orders.after_abort(),
        })
    }
}

/// The cause of a mission's end, when it was given up.
fn abort_reason(word: &str) -> Option<AbortReason> {
    match word {
        "GPS_LOST" => Some(AbortReason::GpsLost),
        "STALLED" => Some(AbortReason::Stalled),
        "FLYAWAY" => Some(AbortReason::Flyaway),
        "NO_PLAN" => Some(AbortReason::NoPlan),
        _ => None,
    }
}
