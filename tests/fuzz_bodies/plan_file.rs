//! Plan files, in every format.

use betadeck::plan::estimate::{Assumptions, estimate};
use betadeck::plan::format::{
    Format, PlanError, PlanFile, ReadOptions, parse, read, read_features, report, table, write,
};
use betadeck::plan::review::review;
use strum::IntoEnumIterator as _;

/// Reads the text in every format, and writes each result in every format.
pub fn run(data: &[u8]) {
    // Archives and UTF-16 are bytes.
    if let Ok(file) = read("fuzz", data, Format::detect("fuzz.kmz", data).0, &ReadOptions::default()) {
        assert_good(&file);
    }
    let Ok(text) = std::str::from_utf8(data) else { return };
    for format in Format::iter() {
        match parse("fuzz", text, format) {
            Ok(file) => assert_good(&file),
            Err(errors) => assert_places(&errors, text),
        }
    }
    match read_features("fuzz", data) {
        Ok(features) => {
            assert!(
                features
                    .iter()
                    .flat_map(betadeck::plan::feature::Feature::vertices)
                    .all(|v| v.position.is_on_globe())
            );
        }
        Err(errors) => assert_places(&errors, text),
    }
}

fn assert_good(file: &PlanFile) {
    for format in Format::iter() {
        let written = write(file, format);
        if written.is_refused() {
            assert!(written.contents.is_empty());
            continue;
        }
        let is_own = matches!(format, Format::Toml | Format::CliText);
        let back = match read("fuzz", &written.contents, format, &ReadOptions::default()) {
            Ok(back) => back,
            // A map without points is no plan.
            Err(_) if !is_own && file.plan.waypoints.is_empty() => continue,
            Err(errors) => panic!("{}\n{}", report(&errors), written.text()),
        };
        if is_own || written.losses.is_lossless() {
            assert_eq!(back.plan, file.plan, "{}", written.text());
            assert_eq!(write(&back, format).contents, written.contents);
        }
        if written.losses.is_lossless() {
            assert_eq!((&back.home, &back.settings), (&file.home, &file.settings), "{}", written.text());
        }
    }
    let home = file.home.map_or_else(Default::default, |home| home.position);
    let assumptions = Assumptions::from_settings(&file.settings);
    let figures = estimate(&file.plan, home, &assumptions);
    assert!(figures.distance_m.is_finite() && figures.time_s.is_none_or(f64::is_finite), "{figures:?}");
    assert_eq!(figures.legs.len(), file.plan.waypoints.len());
    for finding in review(&file.plan, home, &assumptions) {
        assert!(!finding.to_string().is_empty());
    }
    assert!(table(file, home, &assumptions).lines().count() > file.plan.waypoints.len());
}

fn assert_places(errors: &[PlanError], text: &str) {
    assert!(!errors.is_empty());
    // A CR ends a line too. A CRLF counts twice: more lines than there are do no harm.
    let lines = text.split(['\n', '\r']).count();
    for error in errors {
        assert!((1..=lines).contains(&error.line) && error.column >= 1 && error.width >= 1, "{error}");
        assert!(!error.message.contains(['\n', '\r']), "{error}");
    }
    assert!(!report(errors).is_empty());
}
