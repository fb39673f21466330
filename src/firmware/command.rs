//! What the owner of the firmware can ask of it: command line, plans, return home, restart.

use crate::signals::{RcFrame, RcSource};
use crate::telemetry::{DisarmReason, FirmwareEvent, NavEvent, Refusal};

use super::Firmware;
use super::cli::{BuildInfo, CliAction, CliContext, CliReply, Interpreter, StorageFacts};
use super::config::{Configuration, Feature, correct};
use super::estimate::NotTurned;
use super::parameters::Parameters;
use super::settings::Value;

impl Firmware {
    /// Takes an RC frame for the next step, where its age begins; of one source only the newest counts.
    pub fn receive_rc(&mut self, frame: &RcFrame, source: RcSource) {
        self.inbox[source as usize] = Some(*frame);
    }

    /// The frames that came since the last step never arrived: the receiver hears nothing.
    pub fn lose_rc(&mut self) {
        self.inbox.fill(None);
    }

    /// Lets the virtual sticks win over the other sources of RC, or ends that.
    pub fn take_over_sticks(&mut self, sticks_first: bool) {
        self.rx.take_over(sticks_first);
    }

    /// Runs one CLI line and carries out what it asks of the firmware itself. Storing and restarting are left to the
    /// owner: the reply says so.
    pub fn run_cli(&mut self, session: &mut Interpreter, line: &str) -> CliReply {
        let facts = self.cli_facts();
        let had_gps = self.configuration.features.has(Feature::Gps);
        let reply =
            session.run(line, &mut CliContext { configuration: &mut self.configuration, facts: &facts });
        for action in &reply.actions {
            match *action {
                CliAction::Save => {
                    correct(&mut self.configuration);
                    self.tell_lost_gps(had_gps);
                }
                CliAction::Leave => self.flight.end_motor_test(),
                CliAction::MotorTest { motor, output_us } => self.flight.test_motor(motor, output_us),
                CliAction::PlanChanged | CliAction::Restart { .. } => {}
            }
        }
        self.refresh();
        reply
    }

    /// Says so when making the configuration consistent took the GPS away.
    pub(super) fn tell_lost_gps(&mut self, had_gps: bool) {
        if had_gps && !self.configuration.features.has(Feature::Gps) {
            self.outbox.push(FirmwareEvent::Notice(
                "GPS is off: gps_provider wants a receiver on a serial port; set gps_provider = VIRTUAL, feature GPS, save.",
            ));
        }
    }

    /// A command line session was opened on a serial link: no arming until reboot.
    pub fn cli_opened(&mut self) {
        self.arming.cli_opened();
    }

    /// The session ended: motors that it turned stop.
    pub fn cli_closed(&mut self) {
        self.flight.end_motor_test();
    }

    /// What the commands tell about the stored configuration.
    pub fn set_storage_facts(&mut self, facts: StorageFacts) {
        self.storage = facts;
    }

    /// Restarts with this configuration; the flight is over, the receiver's sources keep their order.
    pub fn restart(&mut self, configuration: Configuration) {
        let was_armed = self.arming.armed();
        let sticks_first = self.rx.sources().taken_over();
        let mut fresh = Self::new(configuration, self.options);
        fresh.booted_at = self.now;
        fresh.now = self.now;
        fresh.nav_time = self.now;
        fresh.build = std::mem::take(&mut self.build);
        fresh.storage = std::mem::take(&mut self.storage);
        let mut outbox = std::mem::take(&mut self.outbox);
        while let Some(event) = fresh.outbox.take() {
            outbox.push(event);
        }
        fresh.outbox = outbox;
        fresh.inbox = self.inbox;
        fresh.rx.take_over(sticks_first);
        *self = fresh;
        if was_armed {
            self.note_disarm(DisarmReason::System);
        }
    }

    /// Restarts with the configuration in memory, stored or not.
    pub fn restart_in_place(&mut self) {
        let configuration = self.configuration.clone();
        self.restart(configuration);
    }

    /// Flies home and lands, whatever the AUTOPILOT switch says.
    ///
    /// # Errors
    /// When the craft is not armed, its throttle was never raised, or it has no fix or no altitude.
    pub fn return_to_home(&mut self) -> Result<(), Refusal> {
        let nav = &self.parameters.nav;
        let done = self.orders.return_to_home(&mut self.navigator, &self.nav_inputs, nav, None);
        self.answer(done)
    }

    /// Lands here, whatever the AUTOPILOT switch says.
    ///
    /// # Errors
    /// As [`Firmware::return_to_home`].
    pub fn emergency_land(&mut self) -> Result<(), Refusal> {
        let done = self.orders.emergency_land(&mut self.navigator, &self.nav_inputs, &self.parameters.nav);
        self.answer(done)
    }

    fn answer(&mut self, done: Result<(), Refusal>) -> Result<(), Refusal> {
        if let Err(refusal) = done {
            self.outbox.push(FirmwareEvent::Nav(NavEvent::Refused(refusal)));
        }
        done
    }

    /// Takes [`Firmware::return_to_home`] or [`Firmware::emergency_land`] back: the switch decides again, and starts its
    /// mission again if it is on. Without such a command nothing happens.
    pub fn cancel_command(&mut self) {
        self.orders.take_back(&mut self.navigator);
    }

    /// Calibrates the accelerometer; the craft must stand level. Ignored while armed.
    pub fn calibrate_accelerometer(&mut self) {
        if !self.arming.armed() {
            self.estimator.calibrate_accelerometer();
        }
    }

    /// Calibrates the magnetometer: for 30 s the craft is to be turned about all its axes. Ignored while armed or
    /// without a magnetometer.
    pub fn calibrate_magnetometer(&mut self) {
        if !self.arming.armed() && self.boot.mag {
            self.estimator.calibrate_magnetometer();
        }
    }

    /// Puts the result of an accelerometer calibration into the configuration: it includes what the trims levelled.
    pub(super) fn keep_acc_calibration(&mut self, offsets: [i64; 3]) {
        const DONE: i64 = 1;
        let [x, y, z] = offsets;
        let settings = &mut self.configuration.settings;
        // The estimator's offsets fit the setting's type, and 0 is in every trim's range.
        let _kept = settings.set("acc_calibration", Value::Array(vec![x, y, z, DONE]));
        let _level = [settings.set_number("acc_trim_roll", 0), settings.set_number("acc_trim_pitch", 0)];
        self.refresh();
        self.outbox.push(FirmwareEvent::Notice("Accelerometer calibrated; save keeps the result."));
    }

    /// Puts the result of a magnetometer calibration into the configuration.
    pub(super) fn keep_mag_calibration(&mut self, result: Result<[i64; 3], NotTurned>) {
        let notice = match result {
            Err(NotTurned) => {
                "Magnetometer not calibrated: the craft was not turned about all its axes; its offsets stay."
            }
            Ok(offsets) => {
                match self.configuration.settings.set("mag_calibration", Value::Array(offsets.to_vec())) {
                    Ok(()) => "Magnetometer calibrated; save keeps the result.",
                    Err(_) => "Magnetometer not calibrated: its field is out of range; its offsets stay.",
                }
            }
        };
        self.refresh();
        self.outbox.push(FirmwareEvent::Notice(notice));
    }

    /// Version and build that the firmware announces.
    pub fn set_build(&mut self, build: BuildInfo) {
        self.build = build;
    }

    /// Makes the typed parameters follow the configuration.
    pub(super) fn refresh(&mut self) {
        self.parameters = Parameters::new(&self.configuration, &self.boot, &self.options);
        self.estimator.set_tuning(self.parameters.estimator.clone());
        self.flight.set_tuning(&self.parameters.control);
    }
}
