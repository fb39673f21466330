//! Requests that the owner of the firmware can make: command line, plans, return home, restart.

use crate::plan::{FlightPlan, record_lines};
use crate::signals::{RcFrame, RcSource};
use crate::telemetry::{DisarmReason, FirmwareEvent, InFlightCommand, InFlightRefusal, NavEvent, Refusal};

use super::Firmware;
use super::blackbox::FlashFacts;
use super::cli::{
    BuildInfo, CliAction, CliContext, CliFacts, CliReply, Interpreter, RefusedLine, StorageFacts,
};
use super::config::{Configuration, Feature};

impl Firmware {
    /// Takes an RC frame for the next step, at which its age begins. Only the newest frame of each source counts.
    pub fn receive_rc(&mut self, frame: &RcFrame, source: RcSource) {
        self.rc.queue(frame, source);
    }

    /// Drops the frames that came since the last step. The receiver does not get them.
    pub fn lose_rc(&mut self) {
        self.rc.drop_queued();
    }

    /// Gives the virtual sticks priority over the other sources of RC, or ends that.
    pub fn take_over_sticks(&mut self, sticks_first: bool) {
        self.rc.receiver.take_over(sticks_first);
    }

    /// Runs one CLI line and carries out its requests to the firmware itself. Storing and restarting are left to the
    /// owner, by the actions in the reply.
    #[doc(hidden)]
    pub fn run_cli(&mut self, session: &mut Interpreter, line: &str) -> CliReply {
        let facts = CliFacts::observe(self);
        let configuration = &mut self.setup.configuration;
        let had_gps = configuration.features.has(Feature::Gps);
        let reply = session.run(line, &mut CliContext { configuration, facts: &facts });
        for action in &reply.actions {
            match *action {
                CliAction::Save => self.setup.make_consistent(had_gps, &mut self.outbox),
                CliAction::Leave => self.control.end_motor_test(),
                CliAction::MotorTest { motor, output_us } => self.control.test_motor(motor, output_us),
                CliAction::PlanChanged | CliAction::Restart { .. } => {}
            }
        }
        for notice in &reply.notices {
            self.outbox.push(FirmwareEvent::Notice(*notice));
        }
        self.refresh();
        reply
    }

    /// Stores settings and a plan as the `set` and `waypoint` lines of a ground station do, and returns the replies to
    /// them.
    ///
    /// # Errors
    /// Returns the first refusal. The lines before it keep their effect.
    pub fn upload(&mut self, plan: &FlightPlan, settings: &[String]) -> Result<Vec<String>, RefusedLine> {
        let mut session = Interpreter::default();
        let mut replies = Vec::new();
        for setting in settings {
            let line = format!("set {setting}");
            let CliReply { text, failed, .. } = self.run_cli(&mut session, &line);
            let reply = text.trim().to_owned();
            if failed {
                return Err(RefusedLine { line, reply });
            }
            replies.push(reply);
        }
        let (records, facts) = (plan.records(), CliFacts::observe(self));
        let context = &mut CliContext { configuration: &mut self.setup.configuration, facts: &facts };
        let CliReply { text, failed, .. } = session.store_plan(&records, context);
        self.refresh();
        let mut stored: Vec<String> = text.lines().map(str::to_owned).collect();
        if failed && let Some(reply) = stored.pop() {
            let line = record_lines(records).nth(stored.len()).unwrap_or_default();
            return Err(RefusedLine { line, reply });
        }
        replies.append(&mut stored);
        Ok(replies)
    }

    /// Blocks arming until reboot. Called when a command line session is opened on a serial link.
    pub fn cli_opened(&mut self) {
        self.safety.arming.cli_opened();
    }

    /// Stops motors that the session started. Called when the session ends.
    pub fn cli_closed(&mut self) {
        self.control.end_motor_test();
    }

    /// Sets the facts about the stored configuration that commands print.
    #[doc(hidden)]
    pub fn set_storage_facts(&mut self, facts: StorageFacts) {
        self.setup.storage = facts;
    }

    /// Sets the facts about the flash memory for logs that messages report.
    #[doc(hidden)]
    pub fn set_flash_facts(&mut self, facts: FlashFacts) {
        self.setup.flash = facts;
    }

    /// Sets the flag that an earlier instant is shown. Clients cannot change anything then.
    #[doc(hidden)]
    pub fn set_rewound(&mut self, rewound: bool) {
        self.setup.rewound = rewound;
    }

    /// Sets the version and build that the firmware announces.
    pub fn set_build(&mut self, build: BuildInfo) {
        self.setup.build = build;
    }

    /// Restarts with this configuration. This ends the flight, but the receiver's sources keep their order.
    pub fn restart(&mut self, configuration: Configuration) {
        let was_armed = self.safety.arming.armed();
        let mut outbox = std::mem::take(&mut self.outbox);
        let setup = self.setup.restarted(configuration, &mut outbox);
        let mut fresh = Self::boot(setup, self.now, outbox);
        fresh.rc = self.rc.restarted(&fresh.setup.parameters.rx);
        fresh.safety = self.safety.restarted();
        if let Some(mut recorder) = self.recorder.take() {
            recorder.end();
            fresh.recorder = Some(recorder);
        }
        if was_armed {
            fresh.outbox.push(FirmwareEvent::Disarmed(DisarmReason::System));
        }
        *self = fresh;
    }

    /// Begins to write logs, or stops to do so after the log under way, whatever the setting `blackbox_device` says.
    pub fn set_logs(&mut self, logs: bool) {
        self.setup.options.logs = logs;
        self.refresh();
    }

    /// Begins a new log if one is under way, because what was written of it belongs to another flight.
    pub fn begin_new_log(&mut self) {
        if let Some(recorder) = &mut self.recorder {
            recorder.forget();
        }
    }

    /// Restarts with the configuration in memory, stored or not.
    pub fn restart_in_place(&mut self) {
        let configuration = self.setup.configuration.clone();
        self.restart(configuration);
    }

    /// Flies home and lands, regardless of the AUTOPILOT switch.
    ///
    /// # Errors
    /// Returns a refusal if the craft is not armed, its throttle was never raised, or it has no fix or no altitude.
    pub fn return_to_home(&mut self) -> Result<(), Refusal> {
        let done = self.navigation.return_to_home(&self.setup.parameters);
        self.answer(done)
    }

    /// Changes the flight of a stored plan: go to a waypoint, hold here, continue.
    ///
    /// # Errors
    /// Returns the reason if the command is refused. Nothing has changed then.
    pub fn command(&mut self, command: InFlightCommand) -> Result<(), InFlightRefusal> {
        let stored = &self.setup.configuration.plan;
        self.navigation.command(command, &self.setup.parameters, stored)
    }

    fn answer(&mut self, done: Result<(), Refusal>) -> Result<(), Refusal> {
        if let Err(refusal) = done {
            self.outbox.push(FirmwareEvent::Nav(NavEvent::Refused(refusal)));
        }
        done
    }

    /// Cancels [`Firmware::return_to_home`]. The switch decides again, and starts its mission again if it is on. Without
    /// such a command nothing happens.
    pub fn cancel_command(&mut self) {
        self.navigation.cancel_command();
    }

    /// Calibrates the accelerometer. The craft must be level and still. Ignored while armed.
    pub fn calibrate_accelerometer(&mut self) {
        if !self.safety.arming.armed() {
            self.sensing.estimator.calibrate_accelerometer();
        }
    }

    /// Calibrates the magnetometer. The pilot must turn the craft about all its axes for 30 s. Ignored while armed or
    /// without a magnetometer.
    pub fn calibrate_magnetometer(&mut self) {
        if !self.safety.arming.armed() && self.setup.boot.mag {
            self.sensing.estimator.calibrate_magnetometer();
        }
    }
}
