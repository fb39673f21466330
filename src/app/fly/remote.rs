//! A flight with a firmware outside, in real time.
#![allow(clippy::disallowed_methods, reason = "measures the wall time of the flight")]

use std::time::Instant;

use super::{Flown, Start, open_output};
use crate::app::firmware::RemoteFirmware;
use crate::app::firmware::run::{RemoteRun, Seen, Stopped};
use crate::app::{AppError, setup};
use crate::args::Speed;
use crate::session::{Event, hazards};

/// Prepares the firmware and flies; `None` when a signal came before the flight began.
pub(super) fn fly(start: Start<'_>, firmware: &RemoteFirmware) -> Result<Option<Flown>, AppError> {
    let options = start.options();
    let Start { args, plan, mut vehicle, mut notices, interrupted } = start;
    let speed = args.flight.speed.map_or(1.0, |Speed(speed)| speed);
    let state = args.flight.state_dir.as_deref();
    let mut run = RemoteRun::start(firmware, &vehicle, state, speed, interrupted, &mut notices)?;
    let mut output = open_output(args, &plan, &mut vehicle, notices)?;
    let mut tell = |event: &Event| output.event(event).and_then(|()| output.flush());
    let prepared = run
        .wait_until_ready(&mut vehicle, &mut tell)
        .and_then(|()| run.upload(&mut vehicle, &plan.plan, &mut tell));
    match prepared {
        Ok(()) => {}
        Err(Stopped::Interrupted) => return Ok(None),
        Err(Stopped::Failed(error)) => return Err(error),
    }
    for hazard in hazards(vehicle.controller()) {
        tell(&Event::notice(vehicle.time(), hazard))?;
    }
    let mut flight = setup::start_flight(vehicle, &options)?;
    let started = Instant::now();
    let mut engaged = None;
    let flown = run.fly(&mut flight, &mut |seen| match seen {
        Seen::Report(report) => output.report(report).and_then(|()| output.flush()),
        Seen::Told(event) => output.event(&event).and_then(|()| output.flush()),
        Seen::Ticked(flight) => {
            if engaged.is_none() && flight.engaged_at().is_some() {
                engaged = Some(Instant::now());
            }
            output.track(flight.vehicle())
        }
    });
    let end = match flown {
        Ok(end) => end,
        Err(Stopped::Interrupted) => flight.interrupt("stopped by a signal"),
        Err(Stopped::Failed(error)) => return Err(error),
    };
    Ok(Some(Flown { end, wall: engaged.unwrap_or(started).elapsed(), output }))
}
