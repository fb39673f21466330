//! What the owner of the firmware can ask of it: command line, plans, return home, restart.

use crate::autopilot::io::{NavEvent, Refusal};
use crate::plan::FlightPlan;
use crate::signals::{RcFrame, RcSource};

use super::Firmware;
use super::cli::{BuildInfo, CliAction, CliContext, CliReply, Interpreter, StorageFacts};
use super::config::{Configuration, correct};
use super::event::{DisarmReason, FirmwareEvent};
use super::parameters::Parameters;
use super::settings::Value;

impl Firmware {
    /// Takes an RC frame for the next step, where its age begins; of one source only the newest counts.
    pub fn receive_rc(&mut self, frame: &RcFrame, source: RcSource) {
        self.inbox[source as usize] = Some(*frame);
    }

    /// Lets the virtual sticks win over the other sources of RC, or ends that.
    pub fn take_over_sticks(&mut self, sticks_first: bool) {
        self.rx.take_over(sticks_first);
    }

    /// Runs one CLI line and carries out what it asks of the firmware itself. Storing and restarting are left to the
    /// owner: the reply says so.
    pub fn run_cli(&mut self, session: &mut Interpreter, line: &str) -> CliReply {
        let facts = self.cli_facts();
        let reply =
            session.run(line, &mut CliContext { configuration: &mut self.configuration, facts: &facts });
        for action in &reply.actions {
            match *action {
                CliAction::Save => correct(&mut self.configuration),
                CliAction::Leave => self.flight.end_motor_test(),
                CliAction::MotorTest { motor, output_us } => self.flight.test_motor(motor, output_us),
                CliAction::PlanChanged | CliAction::Restart { .. } => {}
            }
        }
        self.refresh();
        reply
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

    /// Changes the configuration from outside the command line (MSP, an upload); the firmware follows at once.
    pub fn edit_configuration<R>(&mut self, edit: impl FnOnce(&mut Configuration) -> R) -> R {
        let result = edit(&mut self.configuration);
        self.refresh();
        result
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

    /// Replaces the stored flight plan in memory; the mission being flown is not touched (clearing it ends it).
    pub fn set_plan(&mut self, plan: FlightPlan) {
        self.configuration.plan = plan;
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

    /// Takes [`Firmware::return_to_home`] or [`Firmware::emergency_land`] back: the switch decides again.
    pub fn cancel_command(&mut self) {
        self.orders.cancel();
    }

    /// Jumps to a waypoint of the mission, or chooses where the next one begins; `false` = not possible.
    pub fn set_current_waypoint(&mut self, index: u8) -> bool {
        let plan = &self.configuration.plan;
        self.navigator.set_current(index, &self.nav_inputs, &self.parameters.nav, plan)
    }

    /// Calibrates the accelerometer; the craft must stand level. Ignored while armed.
    pub fn calibrate_accelerometer(&mut self) {
        if !self.arming.armed() {
            self.estimator.calibrate_accelerometer();
        }
    }

    /// Puts the result of a calibration into the configuration, the flag behind the three offsets kept.
    pub(super) fn keep_acc_calibration(&mut self, offsets: [i64; 3]) {
        let settings = &mut self.configuration.settings;
        let mut values = settings.array("acc_calibration").to_vec();
        for (value, offset) in values.iter_mut().zip(offsets) {
            *value = offset;
        }
        // The estimator's offsets fit the setting's type.
        let _kept = settings.set("acc_calibration", Value::Array(values));
        self.refresh();
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
