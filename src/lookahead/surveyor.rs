//! Flies many flights of the open plan on copies of the session's vehicle, in threads of lower priority.
//!
//! Only the newest job counts. It ends an older one, as does the end of the last handle.

mod go_no_go;

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, mpsc};
use std::thread;

use super::VehicleCopy;
use super::forecaster::yield_to_the_flight;
use super::sweep_flights::fly_sweep;
use crate::campaign::ForecastAnswer;
use crate::flight::sweep::{Sweep, SweepPoint};
use crate::plan::FlightPlan;
use crate::runner::parallel;
use crate::sim::ScheduledFault;

/// The revision of no job.
const NONE: u64 = u64::MAX;

/// The plan of the flights.
#[derive(Debug, Clone, PartialEq)]
pub struct SurveyedPlan {
    pub plan: FlightPlan,
    /// Setting lines that come with the plan, without `set `.
    pub settings: Vec<String>,
}

/// The flights to fly, each from home in the present air.
#[derive(Debug, Clone, PartialEq)]
pub enum SurveyRequest {
    /// The plan with this fault at every second of it.
    Sweep(ScheduledFault),
    /// The plan in a hundred winds around the present one, with sensor errors: go or no-go.
    GoNoGo,
}

/// A request with a number that comes back with its replies.
#[derive(Debug, Clone, PartialEq)]
pub struct SurveyJob {
    /// Distinguishes the replies to this request from those to older ones.
    pub revision: u64,
    pub plan: Box<SurveyedPlan>,
    pub request: SurveyRequest,
}

/// A reply to a job.
#[derive(Debug, Clone, PartialEq)]
pub struct SurveyReply {
    /// The revision of the job.
    pub revision: u64,
    pub news: SurveyNews,
}

/// A step of a survey.
#[derive(Debug, Clone, PartialEq)]
pub enum SurveyNews {
    /// The flight with the fault at the next second.
    Point(Box<SweepPoint>),
    /// All seconds are flown.
    SweepEnd,
    /// So many of the hundred flights are flown.
    Flown(u64),
    GoNoGo(Box<ForecastAnswer>),
    /// The reason why nothing can be flown, as a sentence.
    Refused(String),
}

impl SurveyNews {
    /// Returns `true` if no more replies to the job follow.
    pub fn is_last(&self) -> bool {
        !matches!(self, Self::Point(_) | Self::Flown(_))
    }
}

/// A job with a copy of the vehicle for it.
#[derive(Debug)]
struct Order {
    job: SurveyJob,
    copy: VehicleCopy,
}

/// The revision of the job that counts.
#[derive(Debug)]
struct Wanted(Arc<AtomicU64>);

impl Drop for Wanted {
    fn drop(&mut self) {
        self.0.store(NONE, Ordering::Relaxed);
    }
}

/// A handle to the thread, which ends with the last handle.
#[derive(Debug, Clone)]
pub struct Surveyor {
    orders: mpsc::Sender<Order>,
    wanted: Arc<Wanted>,
}

impl Surveyor {
    /// Starts the thread. `answer` receives the replies.
    ///
    /// # Errors
    /// Returns an error if the system cannot start a thread.
    pub fn start(mut answer: impl FnMut(SurveyReply) + Send + 'static) -> std::io::Result<Self> {
        let (orders, incoming) = mpsc::channel::<Order>();
        let newest = Arc::new(AtomicU64::new(NONE));
        let wanted = Arc::new(Wanted(newest.clone()));
        thread::Builder::new().name("survey".to_owned()).spawn(move || {
            // The threads that this one starts have its priority.
            yield_to_the_flight();
            while let Ok(Order { job, copy }) = incoming.recv() {
                let revision = job.revision;
                let is_stopped = || newest.load(Ordering::Relaxed) != revision;
                let mut report = |news| {
                    if !is_stopped() {
                        answer(SurveyReply { revision, news });
                    }
                };
                if let Err(reason) = fly(&job, &copy, &is_stopped, &mut report) {
                    report(SurveyNews::Refused(reason));
                }
            }
        })?;
        Ok(Self { orders, wanted })
    }

    /// Makes this revision the newest. A job with another one ends.
    pub fn want(&self, revision: u64) {
        self.wanted.0.store(revision, Ordering::Relaxed);
    }

    /// Orders a job that is wanted, with a copy of the vehicle.
    pub fn order(&self, job: SurveyJob, copy: VehicleCopy) {
        // The thread ends only together with this handle.
        drop(self.orders.send(Order { job, copy }));
    }
}

fn fly(
    job: &SurveyJob,
    copy: &VehicleCopy,
    is_stopped: &(impl Fn() -> bool + Sync),
    report: &mut impl FnMut(SurveyNews),
) -> Result<(), String> {
    match job.request {
        SurveyRequest::Sweep(fault) => sweep(&job.plan, copy, fault, is_stopped, report),
        SurveyRequest::GoNoGo => go_no_go::fly(&job.plan, copy, is_stopped, report),
    }
}

fn sweep(
    SurveyedPlan { plan, settings }: &SurveyedPlan,
    VehicleCopy { vehicle, takeoff_m, .. }: &VehicleCopy,
    fault: ScheduledFault,
    is_stopped: &(impl Fn() -> bool + Sync),
    report: &mut impl FnMut(SurveyNews),
) -> Result<(), String> {
    let mut sweep = Sweep::from_plan(vehicle, plan, settings, *takeoff_m, fault)?;
    fly_sweep(&mut sweep, parallel::beside_a_flight(), is_stopped, |point| {
        report(SurveyNews::Point(Box::new(point)));
    })
    .map_err(|problem| problem.to_string())?;
    if !is_stopped() {
        report(SurveyNews::SweepEnd);
    }
    Ok(())
}

#[cfg(test)]
mod tests;
