//! Headers with lines that are damaged, missing or without a usable value.

use super::{FrameKind, Header};

const LINES: &str = "H Data version:2\n\
    H Field I name:loopIteration,time,vbatLatest,motor[0]\n\
    H Field I signed:0,0,0,0\n\
    H Field I predictor:0,0,9,11\n\
    H Field I encoding:1,1,3,1\n\
    H Field P predictor:6,2,1,1\n\
    H Field P encoding:9,0,0,0\n\
    H Field G name:time,GPS_numSat,GPS_coord[0],GPS_coord[1]\n\
    H Field G signed:0,0,1,1\n\
    H Field G predictor:10,0,7,7\n\
    H Field G encoding:1,1,0,0\n\
    H Field H name:GPS_home[0],GPS_home[1]\n\
    H Field H signed:1,1\n\
    H Field H predictor:0,0\n\
    H Field H encoding:0,0\n\
    H Firmware type:Betaflight\n\
    H Firmware revision:Betaflight 4.5.2 (024f8e13d) STM32F7X2\n\
    H Firmware date:Nov 27 2026 00:59:08\n\
    H Craft name:a: b\n\
    H I interval:32\n\
    H P interval:4\n\
    H P ratio:8\n\
    H motorOutput:1000,2000\n\
    H vbatref:1620\n";

fn read(lines: &str) -> Header {
    Header::read(lines.as_bytes(), true).unwrap().0
}

fn said(lines: &str) -> Vec<String> {
    read(lines).findings().iter().map(ToString::to_string).collect()
}

#[test]
fn a_whole_header_has_no_findings() {
    assert_eq!(said(LINES), [""; 0]);
}

#[test]
fn a_missing_line_is_named_with_what_is_assumed() {
    for (line, assumed) in [
        ("Data version:2", "version 2 is assumed"),
        ("I interval:32", "an interval of 1 is assumed, so iterations are right in whole frames only"),
        ("P interval:4", "an interval of 4 is assumed, from `P ratio`"),
        ("motorOutput:1000,2000", "1000 for idling motors and 2000 for full thrust are assumed"),
        ("vbatref:1620", "the voltage at arming is unknown, and voltages are differences from it"),
    ] {
        let found = said(&LINES.replace(&format!("H {line}\n"), ""));
        let (name, _) = line.split_once(':').unwrap();
        assert_eq!(found, [format!("The header has no line `{name}`: {assumed}.")]);
    }
    let unnamed = LINES.replace("H Firmware revision:Betaflight 4.5.2 (024f8e13d) STM32F7X2\n", "");
    assert_eq!(
        said(&unnamed),
        [
            "The header has no line `Firmware revision`: the units of an unknown version are assumed, and modes have no names."
        ]
    );
}

#[test]
fn a_revision_without_a_version_is_named_if_units_rest_on_it() {
    let with = |kind: &str, revision: &str| {
        let lines = LINES.replace("type:Betaflight", &format!("type:{kind}"));
        said(
            &lines
                .replace("revision:Betaflight 4.5.2 (024f8e13d) STM32F7X2", &format!("revision:{revision}")),
        )
    };
    for (kind, revision) in
        [("Betaflight", "x"), ("Betaflight", "Betaflight"), ("Cleanflight", "xyz"), ("Betaflight", "c49bd40")]
    {
        let found = with(kind, revision);
        let line = format!(
            "The line `Firmware revision:{revision}` of the header has no value that can be used: the units of an unknown version"
        );
        assert!(found.len() == 1 && found[0].starts_with(&line), "{found:?}");
    }
    for (kind, revision) in
        [("Cleanflight", "c49bd40"), ("INAV", "x"), ("Cleanflight", "Betaflight 3.1.0 (x) Y")]
    {
        assert_eq!(with(kind, revision), [""; 0], "{kind} {revision}");
    }
    for (revision, count) in [("Betaflcc_1G:2048", 2), ("Betaflight 4.5cc_1G:2048", 1)] {
        let found = with("Betaflight", revision);
        let joined = format!("`H Firmware revision:{revision}` has parts of two lines.");
        assert!(found.len() == count && found.iter().any(|line| line.ends_with(&joined)), "{found:?}");
    }
}

#[test]
fn an_interval_of_no_iterations_is_named() {
    for value in ["1/0", "0", "x"] {
        let lines = LINES.replace("P interval:4", &format!("P interval:{value}"));
        assert_eq!(
            said(&lines),
            [format!(
                "The line `P interval:{value}` of the header has no value that can be used: an interval of 4 is assumed, from `P ratio`."
            )]
        );
        assert_eq!(read(&lines).interval, read(LINES).interval);
    }
}

#[test]
fn a_line_of_a_frame_is_assumed_from_the_others() {
    for (line, of) in [
        ("Field G encoding:1,1,0,0", FrameKind::Gps),
        ("Field G predictor:10,0,7,7", FrameKind::Gps),
        ("Field H signed:1,1", FrameKind::GpsHome),
    ] {
        let lines = LINES.replace(&format!("H {line}\n"), "");
        let (name, _) = line.split_once(':').unwrap();
        let found = said(&lines);
        assert!(found.len() == 1 && found[0].contains(&format!("no line `{name}`")), "{found:?}");
        assert_eq!(read(&lines).fields(of), read(LINES).fields(of));
    }
    let unnamed = read(&LINES.replace("H Field H name:GPS_home[0],GPS_home[1]\n", ""));
    let names: Vec<_> = unnamed.fields(FrameKind::GpsHome).iter().map(|field| field.name.as_str()).collect();
    assert_eq!(names, ["H[0]", "H[1]"]);
}

#[test]
fn frames_without_their_definition_are_named_if_others_need_them() {
    let without = |frame: char| {
        let is_other = |line: &&str| !line.starts_with(&format!("H Field {frame} "));
        LINES.split_inclusive('\n').filter(is_other).collect::<String>()
    };
    let found = said(&without('H'));
    assert!(found.len() == 1 && found[0].contains("`Field H …`: H frames are passed"), "{found:?}");
    assert!(found[0].contains("places count from an unknown home"), "{found:?}");
    let header = read(&without('H'));
    assert!(header.may_have_undefined(FrameKind::GpsHome) && !header.may_have_undefined(FrameKind::Slow));
}

#[test]
fn a_gap_in_the_header_is_found_by_its_line_or_by_the_lines_that_it_took() {
    // The gap ends inside a line without its name, inside a value, at the end of a line, or left bytes of an empty card.
    let gap = |to: &str, joined: &str| {
        let (from, to) = (LINES.find("rmware revision").unwrap(), LINES.find(to).unwrap());
        format!("{}{joined}{}H looptime:1000\n", &LINES[..from], &LINES[to..])
    };
    for (lines, damaged) in [
        (
            gap("00,2000", ""),
            "Line 18 of the header is damaged, and lines after it may be missing: `H Fi00,2000` is not of the form",
        ),
        (gap("\nH vbatref", "rmware type:Be"), ""),
        (
            gap("Output:1000", "rmware type:Cl"),
            "`H Firmware type:ClOutput:1000,2000` has parts of two lines.",
        ),
        (gap("0,2000", "\0\0\0\n"), "is not of the form `H name:value`."),
    ] {
        let found = said(&lines).join("\n");
        assert!(found.contains(damaged), "{damaged} in {found}");
        assert!(found.contains("no line `I interval`") && found.contains("no line `P interval`"), "{found}");
        assert!(found.contains("no line `Firmware revision`") && found.contains("motorOutput"), "{found}");
        assert_eq!(read(&lines).value("looptime"), Some("1000"), "{found}");
    }
    let cut_value =
        LINES.replace("type:Betaflight", "type:Be").replace("revision:Betaflight 4.5.2", "revision:x");
    assert_eq!(
        said(&cut_value),
        [
            "The line `Firmware type:Be` of the header has no value that can be used: the units of an unknown firmware are assumed."
        ]
    );
}
