//! Prepares a remote firmware for a headless flight: starts it, waits for its setup, and uploads the plan.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use tokio::runtime::Runtime;

use super::RemoteFirmware;
use super::link;
use super::processor;
use crate::events::Event;
use crate::fc::{
    KeptFlight, Patience, Remote, RemoteLink, RemoteState, Unready, Unset, Upload, UploadProgress,
};
use crate::firmware::cli::CliReply;
use crate::launch::link::OpenLink;
use crate::link::conventions::FirmwareClock;
use crate::plan::{AltitudeError, FlightPlan};
use crate::process::error::AppError;
use crate::process::runtime;
use crate::runner::{Flying, Runner, Subscriber};
use crate::storage::FirmwareFolder;
use crate::vehicle::{LateAnswer, Ticket, Vehicle};

/// A remote firmware in operation. It ends on drop.
#[derive(Debug)]
pub(crate) struct RemoteRun {
    runner: Runner,
    interrupted: Arc<AtomicBool>,
    /// The port of its command line and MSP.
    tcp: u16,
    /// `true` if betadeck did not start it.
    is_attached: bool,
    /// Declared after the runner, because the program of its link runs in this folder.
    _directory: Option<FirmwareFolder>,
    _runtime: Runtime,
}

/// The reason why a run did not finish.
#[derive(Debug)]
pub(crate) enum Stopped {
    Interrupted,
    /// A subscriber cannot go on. It knows the reason.
    BySubscriber,
    Failed(AppError),
}

impl From<AppError> for Stopped {
    fn from(error: AppError) -> Self {
        Self::Failed(error)
    }
}

impl From<crate::runner::Stopped> for Stopped {
    fn from(stopped: crate::runner::Stopped) -> Self {
        match stopped {
            crate::runner::Stopped::Interrupted => Self::Interrupted,
            crate::runner::Stopped::BySubscriber => Self::BySubscriber,
            crate::runner::Stopped::Failed(sentence) => Self::Failed(AppError::environment(sentence)),
        }
    }
}

/// Returns the result, or `None` after an interrupt.
///
/// # Errors
/// Returns the error that stopped the run.
pub(crate) fn unless_interrupted<T>(result: Result<T, Stopped>) -> Result<Option<T>, AppError> {
    match result {
        Ok(done) => Ok(Some(done)),
        Err(Stopped::Interrupted | Stopped::BySubscriber) => Ok(None),
        Err(Stopped::Failed(error)) => Err(error),
    }
}

/// The options of a run.
#[derive(Debug)]
pub(crate) struct RunOptions<'a> {
    /// The place of the firmware's configuration; `None` = it is not kept.
    pub(crate) state: Option<&'a Path>,
    /// The requested multiple of real time.
    pub(crate) speed: Option<f64>,
    pub(crate) interrupted: Arc<AtomicBool>,
    /// The number of the processor for a flight in simulated time; `None` = the present one.
    pub(crate) processor: Option<usize>,
}

/// A subscriber that passes each event to a function.
#[derive(Debug)]
pub(crate) struct OnEvent<T>(pub(crate) T);

impl<F, T: FnMut(&Event)> Subscriber<F> for OnEvent<T> {
    fn event(&mut self, event: &Event) {
        (self.0)(event);
    }
}

impl RemoteRun {
    /// Starts the firmware for `vehicle`, waits until it answers and is set up, and uploads the plan.
    pub(crate) fn prepare(
        firmware: &RemoteFirmware,
        vehicle: &mut Vehicle,
        plan: &FlightPlan,
        options: RunOptions<'_>,
        subscriber: &mut impl Subscriber<Vehicle>,
    ) -> Result<Self, Stopped> {
        if firmware.clock == FirmwareClock::Sim {
            processor::keep_to_one(options.processor);
        }
        let runtime = runtime::with_threads(1)?;
        let opened = {
            let _inside = runtime.enter();
            link::open(firmware, vehicle, options.state)?
        };
        for notice in opened.notices() {
            subscriber.event(&Event::notice(vehicle.time(), notice));
        }
        let OpenLink { link, directory, .. } = opened;
        let speed = match (link.is_in_steps(), firmware.clock) {
            // The executable was to run in simulated time, and cannot.
            (false, FirmwareClock::Sim) => 1.0,
            _ => options.speed.unwrap_or(firmware.usual_speed()),
        };
        let mut run = Self {
            runner: Runner::new(vehicle.step_us(), speed, Some(link)),
            interrupted: options.interrupted,
            tcp: firmware.ports.tcp,
            is_attached: firmware.executable.is_none(),
            _directory: directory,
            _runtime: runtime,
        };
        run.wait_until_ready(vehicle, subscriber)?;
        run.upload(vehicle, plan, subscriber)?;
        Ok(run)
    }

    /// Returns the runner of the firmware's flight.
    pub(crate) fn runner(&mut self) -> &mut Runner {
        &mut self.runner
    }

    /// Returns the part of the setup that failed, if any.
    pub(crate) fn unset(&self) -> Option<&Unset> {
        self.remote()?.unset()
    }

    /// Flies to the end.
    pub(crate) fn fly<F: Flying>(
        &mut self,
        flight: &mut F,
        subscriber: &mut impl Subscriber<F>,
    ) -> Result<F::End, Stopped> {
        let interrupted = &self.interrupted;
        Ok(self.runner.fly(flight, subscriber, || interrupted.load(Ordering::Relaxed))?)
    }

    /// Returns the flight of a firmware in simulated time, if what it was given is kept.
    pub(crate) fn past(&mut self) -> Option<KeptFlight> {
        self.runner.link_mut()?.past()
    }

    /// Returns the hash over the motor packets of a firmware in simulated time.
    pub(crate) fn motor_hash(&self) -> Option<u64> {
        self.runner.link()?.motor_hash()
    }

    fn remote(&self) -> Option<&Remote> {
        self.runner.link().and_then(|link| link.protocol().msp())
    }

    /// Waits until the firmware answers and its setup is reported.
    fn wait_until_ready(
        &mut self,
        vehicle: &mut Vehicle,
        subscriber: &mut impl Subscriber<Vehicle>,
    ) -> Result<(), Stopped> {
        let mut patience = Patience::new(self.runner.protocol_time());
        while self.remote().is_some_and(|remote| remote.state() != RemoteState::Ready) {
            self.wait(vehicle, subscriber)?;
            let Some(remote) = self.remote() else { break };
            let now = self.runner.protocol_time();
            if let Some(why) = patience.look(remote.answers(), remote.connection(), now) {
                let (name, tcp, is_attached) = (&remote.craft().name, self.tcp, self.is_attached);
                let unready = Unready { name, tcp, is_attached, why };
                return Err(AppError::environment(unready.to_string()).into());
            }
        }
        Ok(())
    }

    /// Uploads the plan to the craft.
    fn upload(
        &mut self,
        vehicle: &mut Vehicle,
        plan: &FlightPlan,
        subscriber: &mut impl Subscriber<Vehicle>,
    ) -> Result<(), Stopped> {
        let Some(remote) = self.remote() else { return Ok(()) };
        let name = &remote.craft().name;
        if !remote.observer().has_plans() {
            return Err(AppError::environment(format!(
                "{name} has no waypoints: build today's master, or the branch of the test guide with \
                 EXTRA_FLAGS=\"-DENABLE_FLIGHT_PLANNING=1\""
            ))
            .into());
        }
        let reference = vehicle.controller().altitude_reference();
        let mut upload = Upload::new(plan, &[], reference).map_err(|unknown| {
            AppError::environment(match unknown {
                AltitudeError::Unreported => format!(
                    "{name} has reported no settings of its autopilot (`get ap_`), so the reference of its altitudes \
                     is unknown: fly a build with waypoints"
                ),
                AltitudeError::HomeUnknown => unknown.to_string(),
            })
        })?;
        let mut progress = upload.send_line(vehicle);
        loop {
            let waits_for = match progress {
                UploadProgress::Done(result) => {
                    let report = result.map_err(|refusal| self.refused(refusal))?;
                    if let Some(reported) = report.conversion() {
                        subscriber.event(&Event::notice(vehicle.time(), reported));
                    }
                    return Ok(());
                }
                UploadProgress::Waiting(ticket) => ticket,
            };
            let said = self.answer(vehicle, waits_for, subscriber)?;
            progress = upload.take_answer(&said, vehicle);
        }
    }

    /// Returns the error for a refused plan: the craft refused it, or the craft is gone.
    fn refused(&self, refusal: String) -> AppError {
        match self.remote().map(Remote::state) {
            Some(RemoteState::Ready) => AppError::input(refusal),
            _ => AppError::environment(refusal),
        }
    }

    /// Returns the answer to a line. If no answer comes, the link gives one.
    fn answer(
        &mut self,
        vehicle: &mut Vehicle,
        waits_for: Ticket,
        subscriber: &mut impl Subscriber<Vehicle>,
    ) -> Result<CliReply, Stopped> {
        loop {
            self.wait(vehicle, subscriber)?;
            match vehicle.take_answer() {
                Some((ticket, LateAnswer::Cli(said))) if ticket == waits_for => return Ok(said),
                _ => {}
            }
        }
    }

    /// Lets time pass for a craft on the ground.
    fn wait(
        &mut self,
        vehicle: &mut Vehicle,
        subscriber: &mut impl Subscriber<Vehicle>,
    ) -> Result<(), Stopped> {
        let interrupted = &self.interrupted;
        let is_stopped = || interrupted.load(Ordering::Relaxed);
        if self.runner.link().is_some_and(RemoteLink::is_in_steps) {
            self.runner.single_round(vehicle, subscriber, is_stopped)?;
        } else {
            self.runner.round(vehicle, subscriber, is_stopped)?;
        }
        Ok(())
    }
}
