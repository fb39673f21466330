//! Flies with a remote firmware in real time, without a session.
#![allow(
    clippy::disallowed_methods,
    reason = "the firmware's clock is the wall clock, which paces the flight"
)]

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use tokio::runtime::Runtime;

use super::RemoteFirmware;
use super::folder::FirmwareFolder;
use super::link::{self, OpenLink};
use crate::app::{AppError, runtime};
use crate::fc::{
    EXCHANGE_PAUSE, Patience, RemoteLink, RemoteNotice, RemoteState, Unready, Unset, Upload, UploadProgress,
};
use crate::firmware::cli::CliReply;
use crate::flight::{Flight, FlightEnd, Report};
use crate::plan::{AltitudeError, FlightPlan};
use crate::session::{Event, Pacer, SessionEvent};
use crate::vehicle::{LateAnswer, Ticket, Vehicle};

/// The most ticks between two exchanges.
const SLICE: u64 = 50;

/// A remote firmware in operation. It ends on drop.
#[derive(Debug)]
pub(in crate::app) struct RemoteRun {
    link: RemoteLink,
    pacer: Pacer,
    step_us: u64,
    started: Instant,
    interrupted: Arc<AtomicBool>,
    /// The port of its command line and MSP.
    tcp: u16,
    /// `true` if betadeck did not start it.
    is_attached: bool,
    /// Declared after the link, because the program of the link runs in this folder.
    _directory: Option<FirmwareFolder>,
    _runtime: Runtime,
}

/// The reason why a run did not finish.
#[derive(Debug)]
pub(in crate::app) enum Stopped {
    Interrupted,
    Failed(AppError),
}

impl From<AppError> for Stopped {
    fn from(error: AppError) -> Self {
        Self::Failed(error)
    }
}

/// Returns the result, or `None` after an interrupt.
///
/// # Errors
/// Returns the error that stopped the run.
pub(in crate::app) fn unless_interrupted<T>(result: Result<T, Stopped>) -> Result<Option<T>, AppError> {
    match result {
        Ok(done) => Ok(Some(done)),
        Err(Stopped::Interrupted) => Ok(None),
        Err(Stopped::Failed(error)) => Err(error),
    }
}

/// The options of a run.
#[derive(Debug)]
pub(in crate::app) struct RunOptions<'a> {
    /// The place of the firmware's configuration; `None` = it is not kept.
    pub(in crate::app) state: Option<&'a Path>,
    pub(in crate::app) speed: f64,
    pub(in crate::app) interrupted: Arc<AtomicBool>,
}

/// An observation of a flight.
#[derive(Debug)]
pub(in crate::app) enum Seen<'a> {
    /// A report of the flight.
    Report(Report<'a>),
    /// A report about the firmware.
    Reported(Event),
    /// The flight after a tick.
    Ticked(&'a Flight),
}

impl RemoteRun {
    /// Starts the firmware for `vehicle`, waits until it answers and is set up, and uploads the plan.
    pub(in crate::app) fn prepare(
        firmware: &RemoteFirmware,
        vehicle: &mut Vehicle,
        plan: &FlightPlan,
        options: RunOptions<'_>,
        tell: &mut impl FnMut(&Event) -> Result<(), AppError>,
    ) -> Result<Self, Stopped> {
        let RunOptions { state, speed, interrupted } = options;
        let mut notices = Vec::new();
        let mut run = Self::start(firmware, vehicle, state, speed, interrupted, &mut notices)?;
        for notice in notices {
            tell(&Event::notice(vehicle.time(), notice))?;
        }
        run.wait_until_ready(vehicle, tell)?;
        run.upload(vehicle, plan, tell)?;
        Ok(run)
    }

    /// Starts the firmware for `vehicle`, and adds messages for the user to `notices`.
    fn start(
        firmware: &RemoteFirmware,
        vehicle: &Vehicle,
        state: Option<&Path>,
        speed: f64,
        interrupted: Arc<AtomicBool>,
        notices: &mut Vec<String>,
    ) -> Result<Self, AppError> {
        let runtime = runtime::with_threads(1)?;
        let opened = {
            let _inside = runtime.enter();
            link::open(firmware, vehicle, state)?
        };
        notices.extend(opened.notice());
        let OpenLink { link, directory, .. } = opened;
        Ok(Self {
            link,
            pacer: Pacer::new(vehicle.step_us(), speed),
            step_us: vehicle.step_us(),
            started: Instant::now(),
            interrupted,
            tcp: firmware.ports.tcp,
            is_attached: firmware.executable.is_none(),
            _directory: directory,
            _runtime: runtime,
        })
    }

    /// Waits until the firmware answers and its setup is reported.
    fn wait_until_ready(
        &mut self,
        vehicle: &mut Vehicle,
        tell: &mut impl FnMut(&Event) -> Result<(), AppError>,
    ) -> Result<(), Stopped> {
        let mut patience = Patience::new(self.started.elapsed());
        while self.link.remote().state() != RemoteState::Ready {
            self.wait(vehicle, tell)?;
            let remote = self.link.remote();
            if let Some(why) = patience.look(remote.answers(), remote.connection(), self.started.elapsed()) {
                let (name, tcp, is_attached) = (&remote.craft().name, self.tcp, self.is_attached);
                let unready = Unready { name, tcp, is_attached, why };
                return Err(AppError::environment(unready.to_string()).into());
            }
        }
        Ok(())
    }

    /// Returns the part of the setup that failed, if any.
    pub(in crate::app) fn unset(&self) -> Option<&Unset> {
        self.link.remote().unset()
    }

    /// Uploads the plan to the craft.
    fn upload(
        &mut self,
        vehicle: &mut Vehicle,
        plan: &FlightPlan,
        tell: &mut impl FnMut(&Event) -> Result<(), AppError>,
    ) -> Result<(), Stopped> {
        let name = &self.link.remote().craft().name;
        if !self.link.remote().observer().has_plans() {
            return Err(AppError::environment(format!(
                "{name} has no waypoints: build it with EXTRA_FLAGS=\"-DENABLE_FLIGHT_PLANNING=1\""
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
        let mut progress = upload.send_lines(vehicle.controller_mut());
        loop {
            let waits_for = match progress {
                UploadProgress::Done(result) => {
                    let report = result.map_err(|refusal| self.refused(refusal))?;
                    if let Some(reported) = report.conversion() {
                        tell(&Event::notice(vehicle.time(), reported))?;
                    }
                    return Ok(());
                }
                UploadProgress::Waiting(ticket) => ticket,
            };
            let said = self.answer(vehicle, waits_for, tell)?;
            progress = upload.take_answer(&said, vehicle.controller_mut());
        }
    }

    /// Returns the error for a refused plan: the craft refused it, or the craft is gone.
    fn refused(&self, refusal: String) -> AppError {
        match self.link.remote().state() {
            RemoteState::Ready => AppError::input(refusal),
            _ => AppError::environment(refusal),
        }
    }

    /// Returns the answer to a line. If no answer comes, the link gives one.
    fn answer(
        &mut self,
        vehicle: &mut Vehicle,
        waits_for: Ticket,
        tell: &mut impl FnMut(&Event) -> Result<(), AppError>,
    ) -> Result<CliReply, Stopped> {
        loop {
            self.wait(vehicle, tell)?;
            match vehicle.controller_mut().take_answer() {
                Some((ticket, LateAnswer::Cli(said))) if ticket == waits_for => return Ok(said),
                _ => {}
            }
        }
    }

    /// Flies to the end.
    pub(in crate::app) fn fly(
        &mut self,
        flight: &mut Flight,
        see: &mut impl FnMut(Seen<'_>) -> Result<(), AppError>,
    ) -> Result<FlightEnd, Stopped> {
        loop {
            for _ in 0..self.due() {
                let mut seen = Ok(());
                let end = flight.tick(|report| {
                    if seen.is_ok() {
                        seen = see(Seen::Report(report));
                    }
                });
                seen.and_then(|()| see(Seen::Ticked(flight)))?;
                if let Some(end) = end {
                    return Ok(end);
                }
            }
            for event in self.exchange(flight.vehicle_mut())? {
                see(Seen::Reported(event))?;
            }
            self.rest();
        }
    }

    /// Lets time pass for a craft on the ground.
    fn wait(
        &mut self,
        vehicle: &mut Vehicle,
        tell: &mut impl FnMut(&Event) -> Result<(), AppError>,
    ) -> Result<(), Stopped> {
        for _ in 0..self.due() {
            vehicle.tick();
        }
        let mut reported = Ok(());
        vehicle.drain_events(|event| {
            if reported.is_ok() {
                reported = tell(&event.into());
            }
        });
        reported?;
        for event in self.exchange(vehicle)? {
            tell(&event)?;
        }
        self.rest();
        Ok(())
    }

    /// Returns the number of ticks that are due now.
    pub(in crate::app) fn due(&mut self) -> u64 {
        let most = self.link.most_steps(self.step_us, self.pacer.speed(), Instant::now());
        self.pacer.due(self.started.elapsed(), SLICE.min(most))
    }

    /// Exchanges the results of the ticks with the firmware, and returns the reports about it.
    pub(in crate::app) fn exchange(&mut self, vehicle: &mut Vehicle) -> Result<Vec<Event>, Stopped> {
        if self.interrupted.load(Ordering::Relaxed) {
            return Err(Stopped::Interrupted);
        }
        let mut reported = Vec::new();
        for notice in self.link.exchange(vehicle, None, Instant::now()) {
            if let RemoteNotice::Failed(sentence) = notice {
                return Err(AppError::environment(sentence).into());
            }
            reported.push(Event { time: vehicle.time(), kind: SessionEvent::Remote(notice) });
        }
        Ok(reported)
    }

    /// Sleeps until the next tick is due.
    pub(in crate::app) fn rest(&self) {
        let now = self.started.elapsed();
        let next = self.pacer.next_due().unwrap_or(now + Duration::from_millis(1));
        let pause = if self.pacer.is_behind() { EXCHANGE_PAUSE } else { next.saturating_sub(now) };
        std::thread::sleep(pause);
    }
}
