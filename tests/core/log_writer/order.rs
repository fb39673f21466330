//! The order of frames and events, and the ends of logs.

use crate::log_writer::flown::Flown;
use crate::log_writer::judge;
use crate::log_writer::reader::{self, Event, Part};
use betadeck_core::vehicle::VehicleCommand;

#[test]
fn a_log_begins_with_a_whole_frame_and_has_the_states_before_the_next_one() {
    for rate in ["1/1", "1/4", "1/16"] {
        let mut flown = Flown::boot(1000, &[&format!("blackbox_sample_rate = {rate}")]);
        flown.hop(1.0);
        let log = flown.log();
        let letters = log.letters();
        let second = letters.find('P').unwrap();
        assert!(letters.starts_with("IE"), "{rate}: {letters}");
        assert_eq!(&letters[second - 1..=second], "SP", "{rate}: {letters}");
        assert_eq!(log.mains()[0]["loopIteration"], 0);
    }
}

#[test]
fn the_events_are_the_beep_changes_of_switches_the_reason_and_the_end() {
    let mut flown = Flown::boot(1000, &[]);
    flown.hop(2.0);
    let log = flown.log();
    let first_us = log.mains()[0]["time"];
    let events = log.events();
    assert!(
        matches!(events[0], Event::SyncBeep { time_us } if (first_us - 10_000..first_us).contains(time_us))
    );
    // ARM, then ANGLE, ALTHOLD and POS HOLD of the starter modes.
    let modes = 1 | 1 << 1 | 1 << 4 | 1 << 9;
    let expected = [
        Event::FlightMode { new: modes, old: 1 },
        Event::FlightMode { new: 0, old: modes },
        Event::Disarm { reason: 4 },
        Event::End,
    ];
    assert_eq!(events[1..], expected.iter().collect::<Vec<_>>());
    assert!(flown.logs[0].ends_with(b"E\xffEnd of log\0"));
}

#[test]
fn the_states_are_written_when_they_change() {
    let mut flown = Flown::boot(1000, &[]);
    flown.hop(2.0);
    let log = flown.log();
    let slow = log.frames("S");
    let boxes: Vec<_> = slow.iter().map(|values| values["flightModeFlags"]).collect();
    assert_eq!(boxes, [1, 0x213, 0]);
    let values = slow[0];
    assert_eq!((values["stateFlags"], values["failsafePhase"]), (3, 0));
    assert_eq!((values["rxSignalReceived"], values["rxFlightChannelsValid"]), (1, 1));
}

#[test]
fn the_failsafe_of_a_lost_link_is_in_the_states() {
    let mut flown = Flown::boot(1000, &["ap_rx_loss_policy = LAND"]);
    flown.line("waypoint insert 0 40.4637000 -79.5182000 1000 500 HOLD 0 ORBIT");
    flown.vehicle.apply(&VehicleCommand::StartPilot(5.0)).accepted().unwrap();
    flown.fly(22.0);
    let _cut = flown.vehicle.apply(&betadeck_core::vehicle::VehicleCommand::CutRc(true));
    flown.fly(4.0);
    let log = judge::read(&flown.logs[0]);
    let phases: Vec<_> = log.frames("S").iter().map(|values| values["failsafePhase"]).collect();
    assert!(phases.ends_with(&[1, 6]) || phases.ends_with(&[0, 1, 6]), "{phases:?}");
    assert_eq!(log.frames("S").last().unwrap()["rxSignalReceived"], 0);
}

#[test]
fn states_and_home_are_repeated_for_logs_that_lack_their_beginning() {
    let mut flown = Flown::boot(1000, &["blackbox_sample_rate = 1/16"]);
    flown.hop(18.0);
    let log = flown.log();
    let slow = log.frames("S").len();
    assert!((4..=5).contains(&slow), "{slow}");
    let homes = log.frames("H");
    assert!((5..=6).contains(&homes.len()), "{}", homes.len());
    assert!(homes.iter().all(|home| *home == homes[0]));
    assert_eq!(homes[0]["GPS_home[0]"] / 1000, 404_635);
    // A log without its first half still has its map.
    let is_late =
        |part: &&Part| matches!(part, Part::Frame { letter: 'I', end, .. } if *end > flown.logs[0].len() / 2);
    let Some(Part::Frame { end, .. }) = log.parts.iter().find(is_late) else { panic!("a frame") };
    let rest = [&flown.logs[0][..log.header], &flown.logs[0][*end..]].concat();
    let known = judge::with_known_version(&rest);
    let file = blackbox_log::File::new(&known);
    let headers = file.parse(0).unwrap().unwrap();
    let mut parser = headers.data_parser();
    while parser.next().is_some() {}
    assert!(parser.stats().counts.gps > 20, "{:?}", parser.stats());
}

#[test]
fn each_arming_has_its_log_and_all_can_be_in_one_file() {
    let mut flown = Flown::boot(1000, &[]);
    flown.hop(1.0);
    flown.hop(2.0);
    assert_eq!((flown.logs.len(), &flown.ended[..]), (2, &[true, true][..]));
    let file: Vec<u8> = flown.logs.iter().flat_map(|log| judge::with_known_version(log)).collect();
    let file = blackbox_log::File::new(&file);
    assert_eq!(file.log_count(), 2);
    for (index, log) in flown.logs.iter().enumerate() {
        let headers = file.parse(index).unwrap().unwrap();
        let mut parser = headers.data_parser();
        while parser.next().is_some() {}
        assert_eq!(parser.stats().counts.main, reader::read(log).mains().len());
    }
}

part_and_search!(a_cut_log_is_read, every 13, a_log_that_is_cut_anywhere_is_read_to_its_last_whole_frame, a_log_that_is_cut_anywhere_is_read_to_its_last_whole_frame_at_every_byte);

fn a_cut_log_is_read(n: usize) {
    let mut flown = Flown::boot(1000, &["blackbox_sample_rate = 1/4"]);
    flown.hop(0.5);
    let bytes = &flown.logs[0];
    let whole = reader::read(bytes);
    for end in (whole.header + 200..bytes.len()).step_by(n) {
        let cut = reader::read(&bytes[..end]);
        assert_eq!(cut.parts[..], whole.parts[..cut.parts.len()], "cut at {end}");
        if end % 37 == 0 {
            judge::read(&bytes[..end]);
        }
    }
}

#[test]
fn a_restart_ends_the_log() {
    let mut flown = Flown::boot(1000, &[]);
    flown.fly(8.0);
    flown.arm();
    flown.fly(1.0);
    flown.vehicle.apply(&VehicleCommand::ResetCraft);
    flown.fly(0.5);
    let log = flown.log();
    let events = log.events();
    assert_eq!(events[events.len() - 2..], [&Event::Disarm { reason: 255 }, &Event::End]);
}

#[test]
fn a_craft_that_is_disarmed_at_once_has_a_readable_log() {
    let mut flown = Flown::boot(1000, &[]);
    flown.fly(8.0);
    flown.sticks(&[(5, 2000)]);
    while !flown.firmware().is_armed() {
        flown.fly(0.001);
    }
    flown.vehicle.apply(&VehicleCommand::ResetCraft);
    flown.fly(0.5);
    assert_eq!(flown.log().letters(), "IEE");
}
