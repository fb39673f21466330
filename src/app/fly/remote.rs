//! A flight with a remote firmware, in real time.
#![allow(clippy::disallowed_methods, reason = "measures the wall time of the flight")]

use std::time::Instant;

use super::output::Prelude;
use super::{Flown, Start};
use crate::app::firmware::RemoteFirmware;
use crate::app::firmware::run::{RemoteRun, RunOptions, Seen, Stopped, unless_interrupted};
use crate::app::{AppError, setup};
use crate::args::Speed;
use crate::session::{Event, hazards};

/// Prepares the firmware and flies; `None` if a signal came before the flight began.
pub(super) fn fly(start: Start<'_>, firmware: &RemoteFirmware) -> Result<Option<Flown>, AppError> {
    let options = start.options();
    let Start { args, plan, mut vehicle, notices, interrupted } = start;
    let mut prelude = Prelude::new(args);
    for event in super::first_events(&mut vehicle, notices) {
        prelude.event(&event)?;
    }
    let run = RunOptions {
        state: args.flight.state_dir.as_deref(),
        speed: args.flight.speed.map_or(1.0, |Speed(speed)| speed),
        interrupted,
    };
    let mut tell = |event: &Event| prelude.event(event);
    let prepared = RemoteRun::prepare(firmware, &mut vehicle, &plan.plan, run, &mut tell);
    let Some(mut run) = unless_interrupted(prepared)? else { return Ok(None) };
    for hazard in hazards(&vehicle, options.takeoff_m, Some(args.review.max_altitude_m())) {
        tell(&Event::notice(vehicle.time(), hazard))?;
    }
    let mut flight = setup::start_flight(vehicle, &options)?;
    let mut output = prelude.open(flight.vehicle(), &plan)?;
    let started = Instant::now();
    let mut engaged = None;
    let flown = run.fly(&mut flight, &mut |seen| match seen {
        Seen::Report(report) => output.report(report).and_then(|()| output.flush()),
        Seen::Reported(event) => output.event(&event).and_then(|()| output.flush()),
        Seen::Ticked(flight) => {
            if engaged.is_none() && flight.engaged_at().is_some() {
                engaged = Some(Instant::now());
            }
            output.track(flight.vehicle())
        }
    });
    let (end, failure) = match flown {
        Ok(end) => (end, None),
        Err(Stopped::Interrupted) => (flight.interrupt("stopped by a signal"), None),
        // The files end like those of a finished flight.
        Err(Stopped::Failed(error)) => (flight.interrupt(&error.message), Some(error)),
    };
    Ok(Some(Flown { end, wall: engaged.unwrap_or(started).elapsed(), output, failure }))
}
