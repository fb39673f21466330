//! Flies forecasts on copies of the session's vehicle, in a thread of its own.
//!
//! Only the newest job of each kind counts. It replaces an older one, which is dropped unfinished without a
//! reply.
#![allow(clippy::disallowed_methods, reason = "slices are cut by wall time, so that a newer job never waits")]

use std::sync::mpsc;
use std::thread;
use std::time::{Duration, Instant};

use crate::flight::forecast::{Forecast, ForecastKind, ForecastRun, PlanWithSettings, WhatIf};
use crate::lookahead::VehicleCopy;
use crate::plan::FlightPlan;

/// The longest time without a check for new jobs.
const SLICE: Duration = Duration::from_millis(8);
/// The number of ticks between two reads of the clock.
const TICKS: u32 = 100;
/// The niceness of the thread, 0…19. It yields to the other threads of this process, because the flight has
/// priority.
const NICENESS: i32 = 5;

/// The flight to forecast.
#[derive(Debug, Clone, PartialEq)]
pub enum ForecastRequest {
    /// This plan with its settings, from home.
    PlanEstimate {
        plan: Box<FlightPlan>,
        /// Setting lines that come with the plan, without `set `.
        settings: Vec<String>,
    },
    /// The current flight if nothing changes.
    LookAhead,
    /// The current flight with a failure or change that begins now; while nothing flies, the plan from home.
    WhatIf {
        what_if: WhatIf,
        plan: Box<FlightPlan>,
        /// Setting lines that come with the plan, without `set `.
        settings: Vec<String>,
    },
    /// The current flight with other settings and without them; while nothing flies, the plan from home.
    SettingChange {
        /// The changed setting lines, without `set `.
        changed: Vec<String>,
        plan: Box<FlightPlan>,
        /// Setting lines that come with the plan, without `set `.
        settings: Vec<String>,
    },
}

impl ForecastRequest {
    pub fn kind(&self) -> ForecastKind {
        match self {
            Self::PlanEstimate { .. } => ForecastKind::PlanEstimate,
            Self::LookAhead => ForecastKind::LookAhead,
            Self::WhatIf { .. } => ForecastKind::WhatIf,
            Self::SettingChange { .. } => ForecastKind::SettingChange,
        }
    }
}

/// A request with a number that comes back with its reply.
#[derive(Debug, Clone, PartialEq)]
pub struct ForecastJob {
    /// Distinguishes the reply to this request from those to older ones.
    pub revision: u64,
    /// The flight to forecast.
    pub request: ForecastRequest,
}

/// The reply to a job.
#[derive(Debug, Clone, PartialEq)]
pub struct ForecastReply {
    /// The revision of the job.
    pub revision: u64,
    /// The kind of the request.
    pub kind: ForecastKind,
    /// The forecast, or the reason why there is none, as a sentence.
    pub forecast: Result<Box<Forecast>, String>,
}

/// A job with a copy of the vehicle for it.
#[derive(Debug)]
struct Order {
    job: ForecastJob,
    copy: VehicleCopy,
}

/// A handle to the thread, which ends when the handle is dropped.
#[derive(Debug, Clone)]
pub struct Forecaster {
    orders: mpsc::Sender<Order>,
}

impl Forecaster {
    /// Starts the thread. `answer` receives the forecasts.
    ///
    /// # Errors
    /// Returns an error if the system cannot start a thread.
    pub fn start(answer: impl FnMut(ForecastReply) + Send + 'static) -> std::io::Result<Self> {
        let (orders, incoming) = mpsc::channel();
        thread::Builder::new().name("forecast".to_owned()).spawn(move || {
            yield_to_the_flight();
            Worker { answer, flying: Vec::new() }.run(&incoming);
        })?;
        Ok(Self { orders })
    }

    /// Orders a forecast of `job` with this copy of the vehicle.
    pub fn order(&self, job: ForecastJob, copy: VehicleCopy) {
        // The thread ends only together with this handle.
        drop(self.orders.send(Order { job, copy }));
    }
}

/// Lowers the priority of this thread. If that is impossible, the flight still gets its time, because it
/// sleeps most of it.
pub(super) fn yield_to_the_flight() {
    #[cfg(target_os = "linux")]
    // No process is named, so this affects only the calling thread.
    let _ = rustix::process::setpriority_process(None, NICENESS);
}

/// A forecast in progress.
#[derive(Debug)]
struct Flying {
    revision: u64,
    kind: ForecastKind,
    run: ForecastRun,
}

struct Worker<A> {
    answer: A,
    /// At most one of each kind.
    flying: Vec<Flying>,
}

impl<A: FnMut(ForecastReply)> Worker<A> {
    fn run(&mut self, incoming: &mpsc::Receiver<Order>) {
        loop {
            if self.flying.is_empty() {
                match incoming.recv() {
                    Ok(order) => self.begin(order),
                    Err(mpsc::RecvError) => return,
                }
            }
            loop {
                match incoming.try_recv() {
                    Ok(order) => self.begin(order),
                    Err(mpsc::TryRecvError::Empty) => break,
                    Err(mpsc::TryRecvError::Disconnected) => return,
                }
            }
            self.fly_on();
        }
    }

    fn begin(&mut self, Order { job, copy }: Order) {
        let ForecastJob { revision, request } = job;
        let VehicleCopy { vehicle, takeoff_m } = copy;
        let kind = request.kind();
        // Copies of the vehicle may arrive in another order than they were requested.
        if self.flying.iter().any(|flying| flying.kind == kind && flying.revision > revision) {
            return;
        }
        self.flying.retain(|flying| flying.kind != kind);
        let run = match request {
            ForecastRequest::PlanEstimate { plan, settings } => {
                ForecastRun::plan_estimate(*vehicle, &plan, &settings, takeoff_m)
            }
            ForecastRequest::LookAhead => ForecastRun::look_ahead(*vehicle),
            ForecastRequest::WhatIf { what_if, plan, settings } => {
                let plan = PlanWithSettings { plan: &plan, settings: &settings };
                ForecastRun::what_if(*vehicle, &what_if, plan, takeoff_m)
            }
            ForecastRequest::SettingChange { changed, plan, settings } => {
                let plan = PlanWithSettings { plan: &plan, settings: &settings };
                ForecastRun::setting_change(*vehicle, &changed, plan, takeoff_m)
            }
        };
        match run {
            Ok(run) => self.flying.push(Flying { revision, kind, run }),
            Err(reason) => (self.answer)(ForecastReply { revision, kind, forecast: Err(reason) }),
        }
    }

    /// Runs a slice of the forecast that has waited longest.
    fn fly_on(&mut self) {
        if self.flying.is_empty() {
            return;
        }
        let Flying { revision, kind, mut run } = self.flying.remove(0);
        let began = Instant::now();
        while began.elapsed() < SLICE {
            if let Some(forecast) = run.advance(TICKS) {
                (self.answer)(ForecastReply { revision, kind, forecast: Ok(Box::new(forecast)) });
                return;
            }
        }
        self.flying.push(Flying { revision, kind, run });
    }
}

#[cfg(test)]
mod tests;
