//! Files in the manner of the tools of INAV.

use super::super::super::{Format, ReadOptions};
use super::{at_home, findings, read_text, try_read, words};

const MWP: &str = include_str!("../../../../../tests/exchange/inav/mwp-two-missions.mission");
const WINGUI: &str = include_str!("../../../../../tests/exchange/inav/wingui.xml");
const CONFIGURATOR: &str = include_str!("../../../../../tests/exchange/inav/configurator.mission");
const DIFF_ALL: &str = include_str!("../../../../../tests/exchange/inav/diff-all.txt");

#[test]
fn contents_show_the_format() {
    for (name, text, format) in [
        ("a.mission", MWP, Format::MwXml),
        ("a.xml", WINGUI, Format::MwXml),
        ("a.mission", CONFIGURATOR, Format::MwXml),
        ("a.txt", DIFF_ALL, Format::InavCli),
    ] {
        assert_eq!(Format::detect(name, text.as_bytes()), (format, None), "{text}");
    }
}

#[test]
fn mwp_writes_several_missions() {
    let file = read_text(MWP, Format::MwXml);
    assert_eq!(file.home, "50.9104,-1.5348".parse().ok());
    assert_eq!((file.plan.waypoints.len(), file.losses.items), (8, 6));
    assert_eq!(words(&file)[7], "LAND 50.9104000,-1.5348000 40 m 0 m/s 0 s");
    assert_eq!(
        findings(&file)[..5],
        [
            "info     element fwapproach: 1: it is the approach of fixed wings",
            "info     element mwp: 2: only the home is a part of a plan",
            "lost     missions: mission 2 (4 items): a plan is one mission: choose it with --mission N",
            "lost     WP 1 (item 2, line 14) user actions: 1: plans switch nothing at a waypoint",
            "lost     item 3, line 15 nose direction: SET_HEAD: the nose of the craft follows ap_yaw_mode",
        ]
    );
    let second = try_read(MWP, Format::MwXml, &ReadOptions { mission: 2, ..ReadOptions::default() }).unwrap();
    assert_eq!((second.plan.waypoints.len(), second.losses.items), (7, 4));
    assert_eq!(words(&second)[6], "LAND 50.9104000,-1.5348000 30 m 0 m/s 0 s");
}

#[test]
fn old_tools_write_upper_case_and_decimals() {
    let file = read_text(WINGUI, Format::MwXml);
    assert_eq!(
        words(&file),
        [
            "FLYBY 48.1374100,11.5754900 20 m 0 m/s 0 s",
            "HOLD 48.1381200,11.5763300 25.5 m 0 m/s 15 s",
            "HOLD 48.1374100,11.5754900 20 m 0 m/s 0 s",
        ]
    );
    assert_eq!(file.home, None);
}

#[test]
fn the_configurator_writes_a_home_without_its_altitude() {
    let errors = try_read(CONFIGURATOR, Format::MwXml, &ReadOptions::default()).unwrap_err();
    assert!(errors[0].starts_with("a:6:3: altitude 350 m is above sea level"), "{errors:?}");
    let file = try_read(CONFIGURATOR, Format::MwXml, &at_home()).unwrap();
    assert_eq!(file.home, at_home().home);
    assert_eq!(
        words(&file),
        [
            "FLYBY 40.4640000,-79.5175000 50 m 5 m/s 0 s",
            "FLYBY 40.4635000,-79.5182000 40 m 0 m/s 0 s",
            "LAND 40.4640000,-79.5190000 30 m 0 m/s 0 s",
        ]
    );
}

#[test]
fn a_whole_diff_has_the_mission() {
    let file = try_read(DIFF_ALL, Format::InavCli, &at_home()).unwrap();
    assert_eq!(
        words(&file),
        [
            "FLYBY 50.9108000,-1.5349400 35 m 0 m/s 0 s",
            "HOLD 50.9097870,-1.5320360 40.5 m 6 m/s 20 s",
            "FLYBY 50.9108000,-1.5349400 35 m 0 m/s 0 s",
            "HOLD 50.9097870,-1.5320360 40.5 m 6 m/s 20 s",
            "FLYOVER 40.4635000,-79.5182000 40.5 m 0 m/s 0 s",
            "HOLD 40.4635000,-79.5182000 40.5 m 0 m/s 0 s",
        ]
    );
    assert_eq!(
        findings(&file)[..3],
        [
            "info     fwapproach lines: 1: they are the approaches of fixed wings",
            "info     safehome lines: 1: this craft returns to its home",
            "info     other lines: 8: they are no part of a mission",
        ]
    );
}
