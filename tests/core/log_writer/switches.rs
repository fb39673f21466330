//! Devices, modes, and the switch that pauses a log.

use crate::log_writer::flown::Flown;
use crate::log_writer::judge;
use crate::log_writer::reader::{Event, Part};

#[test]
fn nothing_is_logged_without_a_device() {
    for device in ["NONE", "SDCARD", "SERIAL"] {
        let mut flown = Flown::boot_without_device(1000, &[&format!("blackbox_device = {device}")]);
        flown.hop(0.25);
        assert!(flown.logs.is_empty(), "{device}");
        assert!(flown.firmware().log_step().is_none(), "{device}");
    }
}

#[test]
fn a_device_that_is_chosen_in_flight_begins_a_log_and_one_that_is_removed_ends_it() {
    let mut flown = Flown::boot_without_device(1000, &[]);
    flown.fly(8.0);
    flown.arm();
    flown.line("set blackbox_device = SPIFLASH");
    flown.fly(0.5);
    flown.line("set blackbox_device = NONE");
    flown.fly(0.5);
    let log = flown.log();
    assert!(log.mains().len() > 100);
    assert_eq!(log.events(), [&Event::End]);
}

#[test]
fn logs_can_be_forced_without_a_device() {
    let mut flown = Flown::boot_without_device(1000, &[]);
    flown.vehicle.set_logs(true);
    flown.hop(0.25);
    assert!(flown.log().mains().len() > 50);
    assert_eq!(flown.firmware().configuration().settings.text("blackbox_device"), "NONE");
}

#[test]
fn the_switch_pauses_the_log() {
    let mut flown = Flown::boot(1000, &[]);
    flown.line("aux 6 26 5 1700 2100 0 0");
    flown.fly(8.0);
    flown.arm();
    // Off from the beginning: only the first frame is written.
    flown.fly(0.5);
    for pulse in [2000, 1000, 2000] {
        flown.sticks(&[(10, pulse)]);
        flown.fly(0.5);
    }
    flown.disarm();
    let log = flown.log();
    let mains = log.mains();
    let steps = mains.windows(2).map(|pair| pair[1]["loopIteration"] - pair[0]["loopIteration"]);
    let jumps: Vec<_> = steps.filter(|step| *step != 4).collect();
    assert_eq!(jumps.len(), 2, "{jumps:?}");
    assert!(jumps.iter().all(|jump| (450..600).contains(jump)), "{jumps:?}");
    let mut resumed = 0;
    for pair in log.parts.windows(2) {
        let Part::Event(Event::Resume { iteration, time_us }) = &pair[0] else { continue };
        let Part::Frame { letter: 'I', values, .. } = &pair[1] else {
            panic!("a resumed log goes on with a whole frame");
        };
        assert_eq!((values["loopIteration"], values["time"]), (*iteration, *time_us));
        resumed += 1;
    }
    assert_eq!(resumed, 2);
}

#[test]
fn always_logs_from_boot_on_across_flights() {
    let mut flown = Flown::boot(1000, &["blackbox_mode = ALWAYS"]);
    flown.hop(1.0);
    flown.fly(1.0);
    assert_eq!((flown.logs.len(), &flown.ended[..]), (1, &[false][..]));
    let log = judge::read(&flown.logs[0]);
    let mains = log.mains();
    assert!(mains[0]["time"] < 100_000);
    let is_arming = |event: &&&Event| matches!(event, Event::SyncBeep { .. } | Event::Disarm { .. });
    assert_eq!(log.events().iter().filter(is_arming).count(), 2, "{:?}", log.events());
    assert!(mains.iter().all(|values| values["motor[0]"] >= 1000));
    assert!(!log.events().contains(&&Event::End));
}

#[test]
fn a_motor_test_is_logged_until_five_seconds_after_it() {
    let mut flown = Flown::boot(1000, &["blackbox_mode = MOTOR_TEST"]);
    flown.fly(1.0);
    assert!(flown.logs.is_empty());
    flown.line("motor 0 1100");
    flown.fly(1.0);
    flown.line("motor 0 1000");
    flown.fly(4.9);
    assert_eq!((flown.logs.len(), &flown.ended[..]), (1, &[false][..]));
    flown.fly(0.5);
    let log = flown.log();
    assert_eq!(log.mains()[0]["motor[0]"], 1100);
    assert_eq!(log.events(), [&Event::End]);
    flown.hop(0.25);
    assert_eq!(flown.logs.len(), 2);
}

#[test]
fn a_copy_of_the_craft_logs_on_by_itself() {
    let mut flown = Flown::boot(1000, &[]);
    flown.fly(8.0);
    flown.arm();
    flown.fly(0.7);
    let mut copy =
        Flown { vehicle: flown.vehicle.clone(), logs: flown.logs.clone(), ..Flown::boot(1000, &[]) };
    copy.ended.clone_from(&flown.ended);
    copy.stream = flown.stream.clone();
    flown.fly(1.0);
    copy.fly(1.0);
    assert!(flown.logs == copy.logs, "the same flight has the same log");
    copy.vehicle.begin_new_log();
    copy.fly(0.5);
    assert_eq!(copy.logs.len(), 2);
    let log = judge::read(&copy.logs[1]);
    assert!(log.mains().len() > 100);
    assert!(log.events().is_empty(), "it was not armed in this log: {:?}", log.events());
}
