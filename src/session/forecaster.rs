//! Flies forecasts on a thread of its own, beside the session, on copies of its vehicle.
//!
//! Of each kind the newest job counts: it takes the place of an older one, which is dropped unfinished and not answered.
#![allow(clippy::disallowed_methods, reason = "slices are cut by wall time, so that a newer job never waits")]

use std::sync::mpsc;
use std::thread;
use std::time::{Duration, Instant};

use crate::flight::forecast::{Forecast, ForecastKind, ForecastRun, WhatIf};
use crate::plan::FlightPlan;
use crate::session::command::VehicleCopy;

/// Longest time for which new jobs are not looked at.
const SLICE: Duration = Duration::from_millis(8);
/// Ticks between two looks at the clock.
const TICKS: u32 = 100;
/// How much the thread yields to the others of this process, 0…19: the flight comes first.
const NICENESS: i32 = 5;

/// What is to be flown ahead.
#[derive(Debug, Clone, PartialEq)]
pub enum ForecastRequest {
    /// This plan with its settings, from home.
    PlanEstimate {
        plan: Box<FlightPlan>,
        /// Setting lines that come with it, without `set `.
        settings: Vec<String>,
    },
    /// The present flight as things stand.
    LookAhead,
    /// The present flight with something going wrong now.
    WhatIf(WhatIf),
}

impl ForecastRequest {
    pub fn kind(&self) -> ForecastKind {
        match self {
            Self::PlanEstimate { .. } => ForecastKind::PlanEstimate,
            Self::LookAhead => ForecastKind::LookAhead,
            Self::WhatIf(_) => ForecastKind::WhatIf,
        }
    }
}

/// A request, and a number that comes back with its answer.
#[derive(Debug, Clone, PartialEq)]
pub struct ForecastJob {
    /// Tells the answer to this request from those to older ones.
    pub revision: u64,
    /// What is to be flown ahead.
    pub request: ForecastRequest,
}

/// The answer to a job.
#[derive(Debug, Clone, PartialEq)]
pub struct ForecastReply {
    /// That of the job.
    pub revision: u64,
    /// That of the request.
    pub kind: ForecastKind,
    /// The forecast, or why there is none, as a sentence.
    pub forecast: Result<Box<Forecast>, String>,
}

/// A job with the copy of the vehicle to fly it with.
#[derive(Debug)]
struct Order {
    job: ForecastJob,
    copy: VehicleCopy,
}

/// The thread, from outside; it ends when this is dropped.
#[derive(Debug, Clone)]
pub struct Forecaster {
    orders: mpsc::Sender<Order>,
}

impl Forecaster {
    /// Starts the thread; `answer` gets the forecasts.
    ///
    /// # Errors
    /// When the system gives no thread.
    pub fn start(answer: impl FnMut(ForecastReply) + Send + 'static) -> std::io::Result<Self> {
        let (orders, incoming) = mpsc::channel();
        thread::Builder::new().name("forecast".to_owned()).spawn(move || {
            yield_to_the_flight();
            Worker { answer, flying: Vec::new() }.run(&incoming);
        })?;
        Ok(Self { orders })
    }

    /// Flies `job` ahead with this copy of the vehicle.
    pub fn order(&self, job: ForecastJob, copy: VehicleCopy) {
        // The thread ends only with this handle.
        drop(self.orders.send(Order { job, copy }));
    }
}

/// Lowers the priority of this thread. Where that is not possible, the flight still gets its time: it sleeps most of it.
fn yield_to_the_flight() {
    #[cfg(target_os = "linux")]
    // Of the calling thread alone: none is named.
    let _ = rustix::process::setpriority_process(None, NICENESS);
}

/// A forecast under way.
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
        // Copies of the vehicle need not come in the order in which they were asked for.
        if self.flying.iter().any(|flying| flying.kind == kind && flying.revision > revision) {
            return;
        }
        self.flying.retain(|flying| flying.kind != kind);
        let run = match request {
            ForecastRequest::PlanEstimate { plan, settings } => {
                ForecastRun::plan_estimate(*vehicle, &plan, &settings, takeoff_m)
            }
            ForecastRequest::LookAhead => ForecastRun::look_ahead(*vehicle),
            ForecastRequest::WhatIf(what_if) => ForecastRun::what_if(*vehicle, &what_if),
        };
        match run {
            Ok(run) => self.flying.push(Flying { revision, kind, run }),
            Err(reason) => (self.answer)(ForecastReply { revision, kind, forecast: Err(reason) }),
        }
    }

    /// A slice of the forecast that waits longest.
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
