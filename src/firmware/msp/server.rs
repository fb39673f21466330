//! Access of the messages to the running firmware.

use super::{MspAction, MspFacts, Outcome, UtcTime};
use crate::firmware::Firmware;
use crate::firmware::config::Feature;
use crate::msp::Access;
use crate::signals::RcSource;
use crate::telemetry::FirmwareEvent;

impl Firmware {
    /// Answers a message and carries out its requests to the firmware itself. Storing, restarting, the flash memory and
    /// setting the time of day are left to the owner, by the action in the outcome. `clock` is the time of day, if it was set.
    pub fn run_msp(&mut self, code: u16, request: &[u8], clock: Option<UtcTime>) -> Outcome {
        let facts = self.msp_facts(clock);
        let configuration = &mut self.setup.configuration;
        let had_gps = configuration.features.has(Feature::Gps);
        let outcome = super::handle(code, request, configuration, &facts);
        let writes = super::table::find(code).is_some_and(|message| message.kind.access == Access::Write);
        if writes && outcome.reply.is_some() && changes_configuration(outcome.action) {
            self.refresh();
        }
        if let Some(notice) = outcome.notice {
            self.outbox.push(FirmwareEvent::Notice(notice));
        }
        match outcome.action {
            Some(MspAction::Save) => self.setup.make_consistent(had_gps, &mut self.outbox),
            Some(MspAction::RawRc(frame)) => self.receive_rc(&frame, RcSource::Msp),
            Some(MspAction::MotorTest(motors)) => {
                for (motor, output_us) in (0..).zip(motors) {
                    self.control.test_motor(Some(motor), output_us);
                }
            }
            Some(MspAction::CalibrateAcc) => self.calibrate_accelerometer(),
            Some(MspAction::CalibrateMag) => self.calibrate_magnetometer(),
            Some(MspAction::RunawayPrevention(on)) => self.setup.allow_runaway_prevention(on),
            Some(MspAction::HoldHeading(deg)) => {
                self.control.controller.hold_heading(f64::from(deg).to_radians());
            }
            // Positions come from the simulator, so this one is not used.
            Some(MspAction::RawGps { .. }) => {}
            Some(
                MspAction::Reboot
                | MspAction::SaveAndReboot
                | MspAction::SetClock { .. }
                | MspAction::ReadFlash { .. }
                | MspAction::EraseFlash,
            )
            | None => {}
        }
        outcome
    }

    /// Returns the facts about the present instant for messages.
    #[doc(hidden)]
    pub fn msp_facts(&self, clock: Option<UtcTime>) -> MspFacts {
        MspFacts::observe(self, clock)
    }
}

/// Returns `true` if a message that was carried out may have changed a setting.
fn changes_configuration(action: Option<MspAction>) -> bool {
    !matches!(
        action,
        Some(
            MspAction::RawRc(_)
                | MspAction::MotorTest(_)
                | MspAction::RawGps { .. }
                | MspAction::HoldHeading(_)
                | MspAction::EraseFlash
        )
    )
}
