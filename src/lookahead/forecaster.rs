//! Flies forecasts on copies of the session's vehicle, in a thread of its own.
//!
//! Only the newest job of each kind counts. It replaces an older one, which is dropped unfinished without a
//! reply.
#![allow(clippy::disallowed_methods, reason = "slices are cut by wall time, so that a newer job never waits")]

use std::any::Any;
use std::sync::{Arc, mpsc};
use std::thread;
use std::time::{Duration, Instant};

use crate::flight::forecast::{Forecast, ForecastKind, ForecastRun, PlanWithSettings, WhatIf};
use crate::lookahead::{FlownAgain, FlyingAgain, VehicleCopy};
use crate::plan::FlightPlan;
use crate::runner::{Runner, Stopped};

/// The longest time without a check for new jobs.
const SLICE: Duration = Duration::from_millis(8);
/// The number of ticks between two reads of the clock.
const TICKS: u32 = 100;
/// The time between two looks at a process that computes a flight again.
const PROGRESS: Duration = Duration::from_millis(20);
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
    /// Returns `true` if it continues the present flight, if there is one.
    pub fn continues(&self) -> bool {
        matches!(self, Self::LookAhead | Self::WhatIf { .. })
    }

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

/// A handle to the thread. When the last one is dropped, the thread ends, with the processes that it has started.
#[derive(Debug, Clone)]
pub struct Forecaster(Arc<Thread>);

#[derive(Debug)]
struct Thread {
    orders: Option<mpsc::Sender<Order>>,
    handle: Option<thread::JoinHandle<()>>,
}

impl Drop for Thread {
    fn drop(&mut self) {
        self.orders = None;
        // A panic of the thread was reported.
        drop(self.handle.take().map(thread::JoinHandle::join));
    }
}

impl Forecaster {
    /// Starts the thread. `answer` receives the forecasts.
    ///
    /// # Errors
    /// Returns an error if the system cannot start a thread.
    pub fn start(answer: impl FnMut(ForecastReply) + Send + 'static) -> std::io::Result<Self> {
        let (orders, incoming) = mpsc::channel();
        let handle = thread::Builder::new().name("forecast".to_owned()).spawn(move || {
            yield_to_the_flight();
            Worker { answer, flying: Vec::new() }.run(&incoming);
        })?;
        Ok(Self(Arc::new(Thread { orders: Some(orders), handle: Some(handle) })))
    }

    /// Orders a forecast of `job` with this copy of the vehicle.
    pub fn order(&self, job: ForecastJob, copy: VehicleCopy) {
        // The thread ends only together with this handle.
        if let Some(orders) = &self.0.orders {
            drop(orders.send(Order { job, copy }));
        }
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
    controller: Controller,
}

/// The flight controller of a forecast.
#[derive(Debug)]
enum Controller {
    /// It is part of the vehicle.
    Embedded,
    /// Another process of an executable computes the flight up to the present instant.
    FlyingAgain(FlyingAgain),
    /// That process flies ahead. Dropped in this order.
    Ahead { runner: Box<Runner>, _keeps: Box<dyn Any + Send> },
}

impl Flying {
    /// Flies for one slice. Returns the result once there is one.
    fn advance(&mut self) -> Option<Result<Box<Forecast>, String>> {
        let began = Instant::now();
        while began.elapsed() < SLICE {
            let forecast = match &mut self.controller {
                Controller::Embedded => self.run.advance(TICKS),
                Controller::FlyingAgain(flying) => match flying.result()? {
                    (_, Ok(FlownAgain { link, keeps })) => {
                        let step_us = self.run.vehicle().step_us();
                        let runner = Box::new(Runner::new(step_us, f64::INFINITY, Some(link)));
                        self.controller = Controller::Ahead { runner, _keeps: keeps };
                        None
                    }
                    (_, Err(sentence)) => return Some(Err(sentence)),
                },
                Controller::Ahead { runner, .. } => match runner.round(&mut self.run, &mut (), || false) {
                    Ok(end) => end,
                    Err(Stopped::Failed(sentence)) => return Some(Err(sentence)),
                    Err(Stopped::Interrupted | Stopped::BySubscriber) => None,
                },
            };
            if let Some(forecast) = forecast {
                return Some(Ok(Box::new(forecast)));
            }
        }
        None
    }

    /// Returns `true` if another process of an executable flies it.
    fn is_by_process(&self) -> bool {
        !matches!(self.controller, Controller::Embedded)
    }

    /// Returns `true` while another process computes the flight up to the present instant.
    fn waits(&self) -> bool {
        matches!(self.controller, Controller::FlyingAgain(_))
    }
}

struct Worker<A> {
    answer: A,
    /// At most one of each kind.
    flying: Vec<Flying>,
}

impl<A: FnMut(ForecastReply)> Worker<A> {
    /// Works until the handle is dropped.
    fn run(&mut self, incoming: &mpsc::Receiver<Order>) {
        while let Ok(order) = self.next(incoming) {
            match order {
                Some(order) => self.begin(order),
                None => self.fly_on(),
            }
        }
    }

    /// Returns the next order; `None` while there is none and a forecast can go on.
    fn next(&self, incoming: &mpsc::Receiver<Order>) -> Result<Option<Order>, mpsc::RecvError> {
        if self.flying.is_empty() {
            return incoming.recv().map(Some);
        }
        let rest = if self.flying.iter().all(Flying::waits) { PROGRESS } else { Duration::ZERO };
        match incoming.recv_timeout(rest) {
            Ok(order) => Ok(Some(order)),
            Err(mpsc::RecvTimeoutError::Timeout) => Ok(None),
            Err(mpsc::RecvTimeoutError::Disconnected) => Err(mpsc::RecvError),
        }
    }

    fn begin(&mut self, Order { job, copy }: Order) {
        let ForecastJob { revision, request } = job;
        let VehicleCopy { vehicle, takeoff_m, again } = copy;
        let until = vehicle.time();
        let kind = request.kind();
        // Copies of the vehicle may arrive in another order than they were requested.
        if self.flying.iter().any(|flying| flying.kind == kind && flying.revision > revision) {
            return;
        }
        // One process beside the one that flies is enough.
        let is_replaced = |flying: &Flying| flying.kind == kind || again.is_some() && flying.is_by_process();
        self.flying.retain(|flying| !is_replaced(flying));
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
        let controller = match again.filter(|_| run.is_ok()).map(|again| again.start(until)) {
            None => Ok(Controller::Embedded),
            Some(Ok(flying)) => Ok(Controller::FlyingAgain(flying)),
            Some(Err(error)) => Err(format!("The flight cannot be flown again: {error}.")),
        };
        match run.and_then(|run| Ok(Flying { revision, kind, run, controller: controller? })) {
            Ok(flying) => self.flying.push(flying),
            Err(reason) => (self.answer)(ForecastReply { revision, kind, forecast: Err(reason) }),
        }
    }

    /// Runs a slice of the forecast that has waited longest. There is at least one.
    fn fly_on(&mut self) {
        let mut flying = self.flying.remove(0);
        match flying.advance() {
            Some(forecast) => {
                let Flying { revision, kind, .. } = flying;
                (self.answer)(ForecastReply { revision, kind, forecast });
            }
            None => self.flying.push(flying),
        }
    }
}

#[cfg(test)]
mod tests;
