//! The sticks and switches of a log.

use super::maker::{Maker, header};
use super::only;
use crate::flight_log::LogSticks;
use crate::signals::RcFrame;

/// Returns the sticks of a log.
fn sticks(bytes: &[u8]) -> Option<LogSticks> {
    LogSticks::of(&only(bytes), bytes).unwrap()
}

fn frame(sticks: &LogSticks, since_us: u64) -> Option<RcFrame> {
    sticks.at(since_us).unwrap().frame
}

/// The boxes ARM and ANGLE in the order of Betaflight.
const ARMED: u32 = 1;
const ARMED_IN_ANGLE: u32 = 3;

/// Returns a log of 100 frames, a millisecond apart, with the slow frames of these numbers of frames.
fn log(lines: &str, slow: &[(u32, [u32; 5])]) -> Vec<u8> {
    let mut maker = Maker::default();
    maker.begin(lines);
    for at in 0..100 {
        for (_, values) in slow.iter().filter(|(when, _)| *when == at) {
            maker.slow(*values);
        }
        maker.main(at, 1_000_000 + at * 1000, 0, 0);
    }
    maker.end();
    maker.bytes
}

#[test]
fn sticks_are_the_pulses_that_give_the_logged_commands() {
    let sticks = sticks(&log(&header(), &[(0, [ARMED, 0, 0, 1, 1])])).unwrap();
    let channels = frame(&sticks, 50_000).unwrap().channels;
    // Yaw counts to the left in the log.
    assert_eq!(channels[..4], [1600, 1400, 1500, 1495]);
    assert_eq!(sticks.length().0, 80_000);
    assert_eq!(sticks.0.len(), 5, "fifty frames a second");
    assert_eq!(sticks.at(u64::MAX).map(|frame| frame.since_us), Some(80_000));
}

#[test]
fn switches_follow_the_modes_of_the_log() {
    let slow = [(0, [ARMED, 0, 0, 1, 1]), (50, [ARMED_IN_ANGLE, 0, 0, 1, 1]), (90, [0, 0, 0, 1, 1])];
    let mut sticks = sticks(&log(&header(), &slow)).unwrap();
    let switches = |sticks: &LogSticks, since_us| frame(sticks, since_us).unwrap().channels[4..6].to_vec();
    assert_eq!(switches(&sticks, 20_000), [2000, 1000]);
    assert_eq!(switches(&sticks, 60_000), [2000, 2000]);
    // The modes that follow no frame of the sticks have no effect.
    assert_eq!(switches(&sticks, 99_000), [2000, 2000]);
    sticks.0.clear();
    assert_eq!((sticks.at(0), sticks.length().0), (None, 0));
}

#[test]
fn a_loss_of_the_signal_is_flown_as_a_cut_link() {
    let slow = [(0, [ARMED, 0, 0, 1, 1]), (30, [ARMED, 0, 1, 0, 0]), (70, [ARMED, 0, 0, 1, 1])];
    let sticks = sticks(&log(&header(), &slow)).unwrap();
    let received: Vec<bool> = sticks.0.iter().map(|frame| frame.frame.is_some()).collect();
    assert_eq!(received, [true, true, false, false, true]);
}

#[test]
fn a_log_without_commands_has_no_sticks() {
    assert_eq!(sticks(&log(&header().replace("rcCommand", "nothing"), &[])), None);
}

#[test]
fn each_mode_gets_a_channel_that_the_firmware_reads() {
    let lines: Vec<String> = LogSticks::switch_lines().collect();
    let most = lines[0].strip_prefix("set max_aux_channels = ").unwrap().parse::<usize>().unwrap();
    assert!(lines.len() - 1 <= most, "{lines:?}");
    for (aux, line) in lines[1..].iter().enumerate() {
        let words: Vec<&str> = line.split(' ').collect();
        assert_eq!((words[1], words[3], words[4]), (&*aux.to_string(), &*aux.to_string(), "1700"), "{line}");
    }
}
