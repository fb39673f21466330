//! Writes the blackbox log of a flight from the screen.

use std::path::PathBuf;

use crate::blackbox::encode::LogBuffer;
use crate::files::named_file::Kind;
use crate::firmware::Firmware;
use crate::firmware::blackbox::LogStream;
use crate::timeline::RecordedFlight;

const LOG: Kind = Kind { extension: "bbl", command: "log" };

/// Flies the flight again with a log, and writes it to `file`, or to a new file named after the plan. Never replaces an
/// existing file. Returns a sentence with the name of the file, or with the reason for a failure.
pub(crate) fn write(file: Option<PathBuf>, plan: &str, flight: RecordedFlight) -> Result<String, String> {
    let path = LOG.write(file, plan, &flown_log(flight)?)?;
    let shown = path.display();
    Ok(format!("The log of the flight is written as {shown}: `betadeck replay {shown}` shows it."))
}

/// Flies a flight again with a log. The log ends where the flight does, so its size is that of the flight.
fn flown_log(flight: RecordedFlight) -> Result<Vec<u8>, String> {
    let RecordedFlight { start: mut vehicle, inputs, until } = flight;
    if !vehicle.set_logs(true) {
        return Err("only the embedded firmware writes a log here.".to_owned());
    }
    vehicle.begin_new_log();
    let (mut stream, mut buffer, mut log) = (LogStream::default(), LogBuffer::default(), Vec::new());
    let mut inputs = inputs.iter().peekable();
    while vehicle.time() < until {
        while let Some((_, input)) = inputs.next_if(|(at, _)| *at <= vehicle.time()) {
            // The answer was reported when the input came.
            let _reported = vehicle.apply(input);
        }
        vehicle.tick();
        vehicle.drain_events(drop);
        if let Some(step) = vehicle.embedded().and_then(Firmware::log_step) {
            buffer.clear();
            stream.step(&step, &mut buffer);
            log.extend_from_slice(buffer.bytes());
        }
    }
    if log.is_empty() {
        return Err("the craft was not armed in this flight.".to_owned());
    }
    Ok(log)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::blackbox::decode::{Item, LogReader};
    use crate::flight::FlightSetup;
    use crate::signals::{RcFrame, SimTime};
    use crate::timeline::Timeline;
    use crate::vehicle::{Vehicle, VehicleCommand};

    /// Records a short flight by hand. Returns it, and the vehicle after it.
    fn hop() -> (RecordedFlight, Vehicle) {
        let (mut vehicle, _) = FlightSetup::default().build().expect("a vehicle");
        let mut timeline = Timeline::new(&mut vehicle).expect("a recording");
        let mut sticks = RcFrame::SAFE;
        while vehicle.time().as_secs_f64() < 12.0 {
            if vehicle.time().0 == 8_000_000 {
                sticks.channels[4] = 2000;
                let _answer = vehicle.apply(&VehicleCommand::Sticks(sticks));
            }
            timeline.record(&mut vehicle);
            vehicle.tick();
            vehicle.drain_events(drop);
        }
        timeline.record(&mut vehicle);
        (timeline.recorded_flight(vehicle.time()).expect("a flight"), vehicle)
    }

    #[test]
    fn the_log_of_the_flight_so_far_has_all_of_it() {
        let (flight, vehicle) = hop();
        assert!(vehicle.controller().is_armed());
        let log = flown_log(flight).expect("a log");
        let mut reader = LogReader::new(log.as_slice());
        let mut last_us = 0;
        while let Some(item) = reader.next_item().expect("bytes") {
            match item {
                Item::Frame(frame) => last_us = frame.time_us,
                Item::Skipped { .. } | Item::Refused { .. } => panic!("{item:?}"),
                _ => {}
            }
        }
        let missing_us = vehicle.time().0 - last_us;
        assert!(missing_us < 20_000, "{missing_us}");
    }

    #[test]
    fn a_flight_without_arming_has_no_log() {
        let (mut flight, _) = hop();
        flight.until = SimTime(5_000_000);
        assert_eq!(flown_log(flight), Err("the craft was not armed in this flight.".to_owned()));
    }
}
