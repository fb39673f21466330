use super::*;
use crate::flight::FlightSetup;
use crate::flight::forecast::ForecastEnd;
use crate::plan::builtin::BuiltinPlan;

fn copy() -> VehicleCopy {
    let (vehicle, _) = FlightSetup::default().build().unwrap();
    VehicleCopy { vehicle: Box::new(vehicle), takeoff_m: 10.0, again: None }
}

fn estimate(revision: u64, plan: &str) -> ForecastJob {
    let plan = Box::new(BuiltinPlan::find(plan).unwrap().read().unwrap().plan);
    ForecastJob { revision, request: ForecastRequest::PlanEstimate { plan, settings: Vec::new() } }
}

/// Starts a worker. Returns its handle and its replies.
fn start() -> (Forecaster, mpsc::Receiver<ForecastReply>) {
    let (answers, answered) = mpsc::channel();
    (Forecaster::start(move |reply| drop(answers.send(reply))).unwrap(), answered)
}

/// Starts a worker that finds all of these jobs at its start, so that no job is flown before the next one
/// arrives.
fn start_on(jobs: Vec<ForecastJob>) -> (Forecaster, mpsc::Receiver<ForecastReply>) {
    let (orders, incoming) = mpsc::channel();
    let (answers, answered) = mpsc::channel();
    for job in jobs {
        orders.send(Order { job, copy: copy() }).unwrap();
    }
    thread::spawn(move || {
        Worker { answer: move |reply| drop(answers.send(reply)), flying: Vec::new() }.run(&incoming);
    });
    (Forecaster { orders }, answered)
}

#[test]
fn a_newer_job_takes_the_place_of_an_older_one() {
    let (forecaster, answered) = start_on((1..=5).map(|revision| estimate(revision, "land")).collect());
    let reply = answered.recv().unwrap();
    assert_eq!((reply.revision, reply.kind), (5, ForecastKind::PlanEstimate));
    assert!(reply.forecast.unwrap().is_complete());
    drop(forecaster);
    assert_eq!(answered.recv(), Err(mpsc::RecvError), "the thread ends with its handle");
}

#[test]
fn a_copy_that_comes_late_does_not_take_the_place_of_a_newer_one() {
    let (forecaster, answered) = start();
    forecaster.order(estimate(2, "land"), copy());
    forecaster.order(estimate(1, "square"), copy());
    assert_eq!(answered.recv().unwrap().revision, 2);
}

#[test]
fn kinds_do_not_wait_for_each_other() {
    let look_ahead = ForecastJob { revision: 2, request: ForecastRequest::LookAhead };
    let (_forecaster, answered) = start_on(vec![estimate(1, "land"), look_ahead]);
    let refused = answered.recv().unwrap();
    assert_eq!((refused.revision, refused.kind), (2, ForecastKind::LookAhead));
    assert!(refused.forecast.unwrap_err().contains("disarmed"));
    let flown = answered.recv().unwrap().forecast.unwrap();
    assert!(!matches!(flown.end, ForecastEnd::Endless));
}
