//! What the owner of the firmware can ask of it: command line, plans, return home, restart.

use crate::signals::{RcFrame, RcSource};
use crate::telemetry::{
    BadPackets, DisarmReason, FirmwareEvent, InFlightCommand, InFlightRefusal, LostTime, NavEvent, Refusal,
};

use super::Firmware;
use super::cli::{BuildInfo, CliAction, CliContext, CliFacts, CliReply, Interpreter, StorageFacts};
use super::config::{Configuration, Feature};

impl Firmware {
    /// Takes an RC frame for the next step, where its age begins; of one source only the newest counts.
    pub fn receive_rc(&mut self, frame: &RcFrame, source: RcSource) {
        self.rc.queue(frame, source);
    }

    /// The frames that came since the last step never arrived: the receiver hears nothing.
    pub fn lose_rc(&mut self) {
        self.rc.drop_queued();
    }

    /// Lets the virtual sticks win over the other sources of RC, or ends that.
    pub fn take_over_sticks(&mut self, sticks_first: bool) {
        self.rc.take_over(sticks_first);
    }

    /// Runs one CLI line and carries out what it asks of the firmware itself. Storing and restarting are left to the
    /// owner: the reply says so.
    pub fn run_cli(&mut self, session: &mut Interpreter, line: &str) -> CliReply {
        let facts = CliFacts::observe(self);
        let configuration = self.setup.configuration_mut();
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

    /// A command line session was opened on a serial link: no arming until reboot.
    pub fn cli_opened(&mut self) {
        self.safety.cli_opened();
    }

    /// The session ended: motors that it turned stop.
    pub fn cli_closed(&mut self) {
        self.control.end_motor_test();
    }

    /// What the commands tell about the stored configuration.
    pub fn set_storage_facts(&mut self, facts: StorageFacts) {
        self.setup.set_storage(facts);
    }

    /// What the commands tell of useless packets from scripts and simulators.
    pub fn set_bad_packets(&mut self, bad_packets: BadPackets) {
        self.setup.set_bad_packets(bad_packets);
    }

    /// What the commands tell of real time that the flight could not keep up with.
    pub fn set_lost_time(&mut self, lost_time: LostTime) {
        self.setup.set_lost_time(lost_time);
    }

    /// What the commands tell about whether an earlier instant is shown, during which clients change nothing.
    pub fn set_rewound(&mut self, rewound: bool) {
        self.setup.set_rewound(rewound);
    }

    /// Version and build that the firmware announces.
    pub fn set_build(&mut self, build: BuildInfo) {
        self.setup.set_build(build);
    }

    /// Restarts with this configuration; the flight is over, the receiver's sources keep their order.
    pub fn restart(&mut self, configuration: Configuration) {
        let was_armed = self.safety.armed();
        let mut outbox = std::mem::take(&mut self.outbox);
        let setup = self.setup.restarted(configuration, &mut outbox);
        let mut fresh = Self::boot(setup, self.now, outbox);
        fresh.rc = self.rc.restarted(&fresh.setup.parameters().rx);
        fresh.safety = self.safety.restarted();
        if was_armed {
            fresh.outbox.push(FirmwareEvent::Disarmed(DisarmReason::System));
        }
        *self = fresh;
    }

    /// Restarts with the configuration in memory, stored or not.
    pub fn restart_in_place(&mut self) {
        let configuration = self.setup.configuration().clone();
        self.restart(configuration);
    }

    /// Flies home and lands, whatever the AUTOPILOT switch says.
    ///
    /// # Errors
    /// When the craft is not armed, its throttle was never raised, or it has no fix or no altitude.
    pub fn return_to_home(&mut self) -> Result<(), Refusal> {
        let done = self.navigation.return_to_home(self.setup.parameters());
        self.answer(done)
    }

    /// Has the navigator that flies the stored plan do something else: go to a waypoint, hold here, go on.
    ///
    /// # Errors
    /// Why not; then nothing has changed.
    pub fn command(&mut self, command: InFlightCommand) -> Result<(), InFlightRefusal> {
        let stored = &self.setup.configuration().plan;
        self.navigation.command(command, self.setup.parameters(), stored)
    }

    /// Lands here, whatever the AUTOPILOT switch says.
    ///
    /// # Errors
    /// As [`Firmware::return_to_home`].
    pub fn emergency_land(&mut self) -> Result<(), Refusal> {
        let done = self.navigation.emergency_land();
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
        self.navigation.cancel_command();
    }

    /// Calibrates the accelerometer; the craft must stand level. Ignored while armed.
    pub fn calibrate_accelerometer(&mut self) {
        if !self.safety.armed() {
            self.sensing.calibrate_accelerometer();
        }
    }

    /// Calibrates the magnetometer: for 30 s the craft is to be turned about all its axes. Ignored while armed or
    /// without a magnetometer.
    pub fn calibrate_magnetometer(&mut self) {
        if !self.safety.armed() && self.setup.boot().mag {
            self.sensing.calibrate_magnetometer();
        }
    }
}
