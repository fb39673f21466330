//! Plans as INAV items, and the way back.

use super::*;

const FORMATS: [Format; 2] = [Format::MwXml, Format::InavCli];

/// The items of a plan as `wp` lines, and the findings.
fn items(records: &[WaypointRecord], home: Option<&str>) -> (Vec<String>, Vec<String>) {
    let file = PlanFile { home: home.map(|home| home.parse().unwrap()), ..file(records) };
    let written = write(&file, Format::InavCli);
    let lines = written.text().lines().filter(|line| line.starts_with("wp")).map(str::to_owned).collect();
    let findings = written.losses.findings.iter().map(ToString::to_string).collect();
    (lines, findings)
}

fn record(kind: WaypointType) -> WaypointRecord {
    let position = LatLon::new(404_640_000, -795_175_000);
    WaypointRecord { kind, position, alt_cm: 5000, ..Default::default() }
}

/// Returns the text without its private data.
fn public(text: &str) -> String {
    let lines = text.lines().filter(|line| !line.starts_with('#') || line.starts_with("# wp"));
    let text: String = lines.map(|line| format!("{line}\n")).collect();
    match text.split_once("  <!--") {
        Some((begin, _)) => format!("{begin}</mission>\n"),
        None => text,
    }
}

#[test]
fn points_holds_and_landings_have_items() {
    let (lines, findings) = items(
        &[
            WaypointRecord { speed: 500, ..record(WaypointType::Flyover) },
            record(WaypointType::Flyby),
            WaypointRecord { speed: 300, duration_ds: 304, ..record(WaypointType::Hold) },
            WaypointRecord { duration_ds: 1, pattern: HoldPattern::Orbit, ..record(WaypointType::Hold) },
            WaypointRecord { speed: 300, pattern: HoldPattern::Figure8, ..record(WaypointType::Hold) },
            WaypointRecord { speed: 30, duration_ds: 50, ..record(WaypointType::Land) },
        ],
        None,
    );
    assert_eq!(
        lines,
        [
            format!("wp 0 1 {A} 500 0 0 0"),
            format!("wp 1 1 {A} 0 0 0 0"),
            format!("wp 2 3 {A} 30 300 0 0"),
            format!("wp 3 3 {A} 1 0 0 0"),
            format!("wp 4 2 {A} 0 0 0 0"),
            format!("wp 5 3 {A} 5 0 0 0"),
            format!("wp 6 8 {A} 0 0 0 165"),
        ]
    );
    assert_eq!(
        findings,
        [
            "changed  WP 2 (item 2) duration: 30.4 s → 30 s: INAV holds for whole seconds",
            "lost     WP 3 (item 3) pattern: ORBIT → NONE: INAV holds on the point only",
            "changed  WP 3 (item 3) duration: 0.1 s → 1 s: INAV holds for whole seconds",
            "lost     WP 4 (item 4) pattern: FIGURE8 → NONE: INAV holds on the point only",
            "changed  WP 4 (item 4) speed: 3 m/s → default: a POSHOLD_UNLIM has no leg speed",
            "changed  WP 5 (item 5) speed: 0.3 m/s → default: INAV ignores a leg speed up to 0.5 m/s",
            "changed  WP 5 (item 5) duration: 5 s → POSHOLD_TIME, LAND: a wait before a landing is a hold of its own",
            "info     type: 2 FLYOVER or FLYBY → WAYPOINT: INAV turns at every waypoint by its own setting",
        ]
    );
}

#[test]
fn modifiers_change_the_next_item_or_are_lost() {
    let next = LatLon::new(404_730_000, -795_175_000);
    let (lines, findings) = items(
        &[
            WaypointRecord { duration_ds: 20, ..record(WaypointType::Takeoff) },
            WaypointRecord { speed: 45, ..record(WaypointType::YawRate) },
            WaypointRecord { duration_ds: 100, ..record(WaypointType::Delay) },
            record(WaypointType::Flyby),
            WaypointRecord { alt_cm: 3050, ..record(WaypointType::AltChange) },
            WaypointRecord { duration_ds: 1000, ..record(WaypointType::Delay) },
            WaypointRecord { position: next, ..record(WaypointType::Flyby) },
            record(WaypointType::AltChange),
        ],
        None,
    );
    assert_eq!(
        lines,
        [format!("wp 0 1 {A} 0 0 0 0"), "wp 1 1 404730000 -795175000 3050 1002 0 0 165".to_owned()]
    );
    assert_eq!(
        findings[..7],
        [
            "lost     WP 0 type: TAKEOFF: INAV has no climb on the spot: take off by hand before the mission",
            "lost     WP 1 yaw rate: 45 deg/s: INAV limits the yaw rate by a setting only",
            "lost     WP 2 duration: DELAY 10 s: the leg begins at the home, and that is unknown",
            "changed  WP 4 (item 1) altitude: ALT_CHANGE → 30.5 m: INAV has no item for it: the next item has its \
             altitude",
            "changed  WP 5 (item 1) duration: DELAY 100 s → 10.02 m/s: INAV has no item for it: the leg has the speed \
             for it",
            "lost     WP 7 altitude: ALT_CHANGE 50 m: no waypoint follows it",
            "info     type: 2 FLYOVER or FLYBY → WAYPOINT: INAV turns at every waypoint by its own setting",
        ]
    );
    let (_, findings) = items(
        &[WaypointRecord { duration_ds: 100, ..record(WaypointType::Delay) }, record(WaypointType::Land)],
        Some("40.4635,-79.5182"),
    );
    assert_eq!(findings[0], "lost     home: 40.4635000,-79.5182000: INAV takes the place of arming");
    assert!(findings[1].starts_with("changed  WP 0 (item 0) duration: DELAY 10 s → 8.1"), "{findings:?}");
}

#[test]
fn values_beyond_an_item_are_named() {
    let zero = LatLon::default();
    let (lines, findings) =
        items(&[WaypointRecord { position: zero, speed: 40_000, ..record(WaypointType::Flyby) }], None);
    assert_eq!(lines, ["wp 0 1 1 0 5000 32767 0 0 165"]);
    assert_eq!(
        findings[..2],
        [
            "changed  WP 0 (item 0) position: 0.0000000,0.0000000 → 0.0000001,0.0000000: INAV takes 0,0 for the home \
             of the flight",
            "changed  WP 0 (item 0) speed: 400 m/s → 327.67 m/s: it is the fastest leg of an item",
        ]
    );
    let high = file(&[WaypointRecord { alt_cm: 2_000_001, ..record(WaypointType::Flyby) }]);
    for format in FORMATS {
        let written = write(&high, format);
        assert!(written.is_refused() && written.contents.is_empty());
        assert!(
            written.losses.findings[0].to_string().starts_with("refused  WP 0 altitude: altitude 20000.01")
        );
    }
    let written =
        write(&file(&[WaypointRecord { alt_cm: 5049, ..record(WaypointType::Land) }]), Format::MwXml);
    assert_eq!(
        written.losses.findings[0].to_string(),
        "changed  WP 0 (item 1) altitude: 50.49 m → 50 m: MW-XML has whole metres"
    );
}

#[test]
fn private_data_are_used_only_if_the_items_are_the_same() {
    let record =
        WaypointRecord { pattern: HoldPattern::Orbit, duration_ds: 301, ..record(WaypointType::Hold) };
    let home = "40.4635,-79.5182,300".parse().ok();
    let file = PlanFile {
        name: "a--->b".to_owned(),
        home,
        settings: vec!["ap_max_angle = 25".to_owned()],
        ..file(&[record])
    };
    for (format, from, to) in
        [(Format::MwXml, "alt=\"50\"", "alt=\"60\""), (Format::InavCli, " 5000 30 ", " 6000 30 ")]
    {
        let text = write(&file, format).text().into_owned();
        let back = read_text(&text, format);
        assert_eq!((&back.name, &back.home, &back.settings), (&file.name, &home, &file.settings));
        assert_eq!((&back.plan, findings(&back)), (&file.plan, vec![]));
        let edited = read_text(&text.replacen(from, to, 1), format);
        assert_eq!((&edited.name, &edited.home, &edited.settings), (&file.name, &home, &file.settings));
        assert_eq!(words(&edited), ["HOLD 40.4640000,-79.5175000 60 m 0 m/s 30 s"]);
        assert_eq!(
            findings(&edited),
            [
                "assumed  private data: another program edited the items, so the waypoints are those of the items \
                 alone",
                "lost     WP 0 pattern, duration: ORBIT, 30.1 s → NONE, 30 s: only the private data had it",
            ]
        );
        let broken = read_text(&text.replacen("pattern =", "patern =", 1), format);
        assert_eq!(findings(&broken), ["assumed  private data: they cannot be read and are not used"]);
        let later = read_text(&text.replacen("betadeck 1\n", "betadeck 2\n", 1), format);
        assert_eq!((later.settings.len(), findings(&later)), (0, vec![]));
    }
    let moved = write(&file, Format::MwXml).text().replacen("home-y=\"40.4635000\"", "home-y=\"40.5\"", 1);
    let moved = read_text(&moved, Format::MwXml);
    assert_eq!((moved.home, &moved.plan), ("40.5,-79.5182".parse().ok(), &file.plan));
}

#[test]
fn the_home_of_the_user_completes_that_of_the_file() {
    let file = PlanFile { home: "40.4635,-79.5182".parse().ok(), ..file(&[record(WaypointType::Land)]) };
    for format in FORMATS {
        let text = write(&file, format).text().into_owned();
        assert_eq!(try_read(&text, format, &at_home()).unwrap().home, at_home().home);
    }
}

#[test]
fn dropped_private_waypoints_are_named() {
    let next =
        WaypointRecord { position: LatLon::new(404_730_000, -795_175_000), ..record(WaypointType::Land) };
    let file = file(&[record(WaypointType::Takeoff), record(WaypointType::Flyover), next]);
    let text = write(&file, Format::MwXml).text().replacen("alt=\"50\"", "alt=\"60\"", 1);
    assert_eq!(
        findings(&read_text(&text, Format::MwXml))[2..],
        [
            "lost     waypoint: TAKEOFF (WP 0 of the private data): only the private data had it",
            "lost     WP 0 type: FLYOVER → FLYBY: only the private data had it",
        ]
    );
}

/// Returns the indices of the waypoints that no finding above info names, and that no modifier before them changes.
fn untouched(file: &PlanFile, format: Format) -> Vec<usize> {
    let losses = write(file, format).losses;
    let is_named = |index: usize| {
        let heavy = losses.findings.iter().filter(|finding| finding.severity > Severity::Info);
        heavy.into_iter().any(|finding| finding.waypoint == Some(index))
    };
    let waypoints = &file.plan.waypoints;
    let follows = |index: usize| {
        let before = waypoints[..index].iter().rev().take_while(|waypoint| !waypoint.kind.is_positional());
        before.into_iter().any(|waypoint| waypoint.kind != WaypointType::YawRate)
    };
    (0..waypoints.len()).filter(|&index| !is_named(index) && !follows(index)).collect()
}

/// Returns the parts of a waypoint that mean something to INAV.
fn flown(waypoint: &Waypoint) -> Waypoint {
    let uses = waypoint.kind.capability();
    let kind = if waypoint.kind.passes() { WaypointType::Flyby } else { waypoint.kind };
    let mut flown = Waypoint { kind, yaw_rate_dps: 0, ..*waypoint };
    if !uses.pattern {
        flown.pattern = HoldPattern::None;
    }
    if waypoint.kind.passes() {
        flown.duration = Default::default();
    }
    flown
}

proptest! {
    #[test]
    fn private_data_carry_everything(file in plan_file()) {
        for format in FORMATS {
            let written = write(&file, format);
            let back = read_text(&written.text(), format);
            prop_assert_eq!(&PlanFile { losses: Default::default(), ..back.clone() }, &file);
            prop_assert!(back.losses.findings.is_empty());
            prop_assert_eq!(&write(&back, format), &written);
            let crlf = read_text(&written.text().replace('\n', "\r\n"), format);
            prop_assert_eq!(crlf.plan, back.plan);
        }
    }

    #[test]
    fn items_carry_all_that_no_finding_names(file in plan_file()) {
        for format in FORMATS {
            let text = public(&write(&file, format).text());
            // A LAND that waits becomes two items, which may be too many for a plan.
            let waits = |waypoint: &&Waypoint| waypoint.kind == WaypointType::Land && !waypoint.duration.is_zero();
            let items = file.plan.waypoints.len() + file.plan.waypoints.iter().filter(waits).count();
            if let Err(errors) = try_read(&text, format, &ReadOptions::default()) {
                prop_assert!(items > MAX_WAYPOINTS && errors[0].contains("the mission has"), "{:?}", errors);
                continue;
            }
            let back = read_text(&text, format);
            let mut rest = back.plan.waypoints.iter();
            for index in untouched(&file, format) {
                let waypoint = flown(&file.plan.waypoints[index]);
                prop_assert!(rest.any(|other| *other == waypoint), "{} {:?}\n{}", index, waypoint, text);
            }
            if format == Format::MwXml {
                let home = |file: &PlanFile| file.home.map(|home| super::super::as_place(home.position));
                prop_assert_eq!(home(&back), home(&file));
            }
            let again = write(&back, format);
            prop_assert_eq!(public(&again.text()), text);
            prop_assert!(again.losses.is_lossless(), "{:?}", again.losses);
        }
    }

    #[test]
    fn no_text_panics(
        words in proptest::collection::vec(
            prop_oneof![Just("wp"), Just("6"), Just("165"), Just("\n"), Just("-1"), Just("4"), Just("#"), Just("0")],
            0..120,
        ),
    ) {
        let _ = try_read(&words.join(" "), Format::InavCli, &at_home());
    }
}
