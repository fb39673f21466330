use std::sync::atomic::{AtomicUsize, Ordering};

use super::*;
use crate::flight::FlightSetup;
use crate::flight::forecast::{ForecastEnd, WHAT_IFS};
use crate::lookahead::FlyAgain;
use crate::plan::builtin::BuiltinPlan;
use crate::vehicle::VehicleCommand;

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
    let handle = thread::spawn(move || {
        Worker { answer: move |reply| drop(answers.send(reply)), flying: Vec::new() }.run(&incoming);
    });
    (Forecaster(Arc::new(Thread { orders: Some(orders), handle: Some(handle) })), answered)
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

/// Returns a copy of a vehicle that takes off. Its flight controller is flown again without an end, until that is stopped;
/// `begun` counts the flights so far, and `running` those under way.
fn copy_by_process([begun, running]: &[Arc<AtomicUsize>; 2]) -> VehicleCopy {
    let mut copy = copy();
    copy.vehicle.apply(&VehicleCommand::StartPilot(10.0)).accepted().unwrap();
    let (begun, running) = (Arc::clone(begun), Arc::clone(running));
    let again = FlyAgain::new(move |_, progress| {
        running.fetch_add(1, Ordering::SeqCst);
        begun.fetch_add(1, Ordering::SeqCst);
        while !progress.stopped().load(Ordering::SeqCst) {
            thread::yield_now();
        }
        running.fetch_sub(1, Ordering::SeqCst);
        Err("it was stopped".to_owned())
    });
    VehicleCopy { again: Some(again), ..copy }
}

#[test]
fn one_other_process_flies_at_a_time_and_none_when_the_program_ends() {
    let (forecaster, _answered) = start();
    let counts: [Arc<AtomicUsize>; 2] = Default::default();
    let now = || counts.each_ref().map(|count| count.load(Ordering::SeqCst));
    let what_if =
        ForecastRequest::WhatIf { what_if: WHAT_IFS[0].clone(), plan: Box::default(), settings: Vec::new() };
    for (revision, request) in (1..).zip([what_if, ForecastRequest::LookAhead]) {
        forecaster.order(ForecastJob { revision, request }, copy_by_process(&counts));
        while now()[0] < revision as usize {
            thread::yield_now();
        }
        assert_eq!(now()[1], 1, "flights under way");
    }
    drop(forecaster);
    assert_eq!(now(), [2, 0]);
}
