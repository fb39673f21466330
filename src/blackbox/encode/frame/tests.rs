//! Frames of small layouts, byte by byte.

use super::super::group::Coding::{Neg14Bit, Null, SignedVb, Tag2_3S32, Tag8_4S16, Tag8_8Svb, UnsignedVb};
use super::*;
use crate::blackbox::Predictor::{
    Average2, HomeCoordinate, Increment, LastMainFrameTime, MinMotor, Motor0, Previous, StraightLine,
    VbatReference, Zero,
};

const CONSTANTS: LogConstants =
    LogConstants { p_interval: 2, min_throttle: 1070, min_motor: 1000, vbat_reference: 1620 };

fn layout(kind: FrameKind, groups: &[FieldGroup]) -> LogLayout {
    let mut layout = LogLayout::default();
    assert!(groups.iter().all(|group| layout.add(kind, *group)));
    layout
}

fn values(first: &[i32]) -> FrameValues {
    let mut values = [0; MAX_FIELDS];
    values[..first.len()].copy_from_slice(first);
    values
}

fn taken(buffer: &mut LogBuffer) -> Vec<u8> {
    let bytes = buffer.bytes().to_vec();
    buffer.clear();
    bytes
}

#[test]
fn a_frame_between_two_whole_ones_has_the_differences_from_those_before() {
    let layout = layout(
        FrameKind::Intra,
        &[
            FieldGroup::main(&["loopIteration"], false, Rule(Zero, UnsignedVb), Rule(Increment, Null)),
            FieldGroup::main(&["time"], false, Rule(Zero, UnsignedVb), Rule(StraightLine, SignedVb)),
            FieldGroup::main(
                &["axisI[0]", "axisI[1]", "axisI[2]"],
                true,
                Rule(Zero, SignedVb),
                Rule(Previous, Tag2_3S32),
            ),
            FieldGroup::main(
                &["vbatLatest"],
                false,
                Rule(VbatReference, Neg14Bit),
                Rule(Previous, Tag8_8Svb),
            ),
            FieldGroup::main(&["rssi"], false, Rule(Zero, UnsignedVb), Rule(Previous, Tag8_8Svb)),
            FieldGroup::main(&["gyroADC[0]"], true, Rule(Zero, SignedVb), Rule(Average2, SignedVb)),
            FieldGroup::main(&["motor[0]"], false, Rule(MinMotor, UnsignedVb), Rule(Average2, SignedVb)),
            FieldGroup::main(&["motor[1]"], false, Rule(Motor0, SignedVb), Rule(Average2, SignedVb)),
        ],
    );
    let mut encoder = LogEncoder::new(&layout, CONSTANTS);
    let buffer = &mut LogBuffer::default();
    encoder.intra(&values(&[64, 1000, 1, -1, 0, 1600, 1023, -4, 1100, 1090]), buffer);
    assert_eq!(taken(buffer), [b'I', 64, 0xe8, 7, 2, 1, 0, 20, 0xff, 7, 7, 100, 19],);
    // After a whole frame both frames before are that frame: the line through them is flat.
    encoder.inter(&values(&[66, 3000, 2, -2, 0, 1600, 1023, 3, 1101, 1090]), buffer);
    assert_eq!(taken(buffer), [b'P', 0xa0, 0x1f, 0x1c, 0, 14, 2, 0]);
    // The average of 3 and -4 is truncated to 0, that of 1101 and 1100 to 1100.
    encoder.inter(&values(&[68, 5001, 2, -2, 9, 1599, 1020, 0, 1100, 1090]), buffer);
    assert_eq!(taken(buffer), [b'P', 2, 0x80, 0, 9, 3, 1, 5, 0, 0, 0]);
}

#[test]
fn solutions_count_from_home_and_from_the_last_main_frame() {
    let mut layout = layout(
        FrameKind::Gps,
        &[
            FieldGroup::side(&["time"], false, Rule(LastMainFrameTime, UnsignedVb)),
            FieldGroup::side(&["GPS_coord[0]", "GPS_coord[1]"], true, Rule(HomeCoordinate, SignedVb)),
        ],
    );
    let home = FieldGroup::side(&["GPS_home[0]", "GPS_home[1]"], true, Rule(Zero, SignedVb));
    assert!(layout.add(FrameKind::GpsHome, home));
    let main = [("loopIteration", UnsignedVb), ("time", UnsignedVb)];
    for (name, coding) in main {
        let names: &[&str] = if name == "time" { &["time"] } else { &["loopIteration"] };
        let rule = Rule(Zero, coding);
        assert!(layout.add(FrameKind::Intra, FieldGroup::main(names, false, rule, rule)));
    }
    let mut encoder = LogEncoder::new(&layout, CONSTANTS);
    let buffer = &mut LogBuffer::default();
    encoder.intra(&values(&[0, 900]), buffer);
    buffer.clear();
    encoder.home(&values(&[404_635_000, -795_182_000]), buffer);
    buffer.clear();
    encoder.gps(&values(&[1000, 404_635_003, -795_182_001]), buffer);
    assert_eq!(taken(buffer), [b'G', 100, 6, 1]);
}

#[test]
fn groups_of_four_and_a_slow_frame() {
    let mut layout = layout(
        FrameKind::Intra,
        &[FieldGroup::main(
            &["setpoint[0]", "setpoint[1]", "setpoint[2]", "setpoint[3]"],
            true,
            Rule(Zero, SignedVb),
            Rule(Previous, Tag8_4S16),
        )],
    );
    for group in [
        FieldGroup::side(&["flightModeFlags", "stateFlags"], false, Rule(Zero, UnsignedVb)),
        FieldGroup::side(
            &["failsafePhase", "rxSignalReceived", "rxFlightChannelsValid"],
            false,
            Rule(Zero, Tag2_3S32),
        ),
    ] {
        assert!(layout.add(FrameKind::Slow, group));
    }
    let mut encoder = LogEncoder::new(&layout, CONSTANTS);
    let buffer = &mut LogBuffer::default();
    encoder.intra(&values(&[0; 4]), buffer);
    buffer.clear();
    encoder.inter(&values(&[0, 3, -100, 500]), buffer);
    assert_eq!(taken(buffer), [b'P', 0xe4, 0x39, 0xc0, 0x1f, 0x40]);
    encoder.slow(&values(&[2049, 3, 0, 1, 1]), buffer);
    assert_eq!(taken(buffer), [b'S', 0x81, 0x10, 3, 0x05]);
}

#[test]
fn the_header_names_the_fields_and_their_rules() {
    let mut layout = layout(
        FrameKind::Intra,
        &[
            FieldGroup::main(&["loopIteration"], false, Rule(Zero, UnsignedVb), Rule(Increment, Null)),
            FieldGroup::main(&["axisP[0]", "axisP[1]"], true, Rule(Zero, SignedVb), Rule(Previous, SignedVb)),
        ],
    );
    assert!(layout.add(FrameKind::Slow, FieldGroup::side(&["stateFlags"], false, Rule(Zero, UnsignedVb))));
    let lines: String = (0..).map_while(|number| layout.line(number)).map(|line| line.to_string()).collect();
    assert_eq!(
        lines,
        "H Field I name:loopIteration,axisP[0],axisP[1]\n\
         H Field I signed:0,1,1\n\
         H Field I predictor:0,0,0\n\
         H Field I encoding:1,0,0\n\
         H Field P predictor:6,1,1\n\
         H Field P encoding:9,0,0\n\
         H Field S name:stateFlags\n\
         H Field S signed:0\n\
         H Field S predictor:0\n\
         H Field S encoding:1\n"
    );
}

#[test]
fn a_frame_has_a_limited_number_of_fields() {
    let mut layout = LogLayout::default();
    let group = FieldGroup::side(&["debug[0]"; 40], true, Rule(Zero, SignedVb));
    assert!(layout.add(FrameKind::Intra, group));
    assert!(!layout.add(FrameKind::Intra, group));
    assert!(!layout.add(FrameKind::Event, group));
    assert_eq!(layout.len(FrameKind::Inter), 40);
}
