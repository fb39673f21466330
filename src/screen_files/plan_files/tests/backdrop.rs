//! Backdrops are remembered with the files of plans.

use super::*;

const MAP: &str = r#"{"type":"LineString","coordinates":[[8.5,47.3],[8.6,47.4]]}"#;

fn names(replies: &[FileReply]) -> Vec<(PathBuf, bool)> {
    let layer = |reply: &FileReply| match reply {
        FileReply::Backdrop { layer, is_new, .. } => Some((layer.path.clone(), *is_new)),
        _ => None,
    };
    replies.iter().filter_map(layer).collect()
}

#[test]
fn a_backdrop_comes_back_with_the_file_of_its_plan() {
    let directory = tempfile::tempdir().unwrap();
    let at = |name: &str| directory.path().join(name);
    std::fs::write(at("road.geojson"), MAP).unwrap();
    let mut files = PlanFiles::new(Some(directory.path()));
    let mut opened = files.start_with(None, document(1));
    let shown = files.carry_out(FileRequest::Backdrop(opened.id, at("road.geojson")));
    assert_eq!(names(&shown), [(at("road.geojson"), true)]);
    assert!(matches!(save(&mut files, &mut opened, &at("plan.toml"), false), FileReply::Saved { .. }));

    let mut later = PlanFiles::new(Some(directory.path()));
    let replies = later.carry_out(FileRequest::Open { path: at("plan.toml"), home: None, accepted: false });
    assert_eq!(names(&replies), [(at("road.geojson"), false)]);
    let FileReply::Opened(opened) = &replies[0] else { panic!("{replies:?}") };
    assert!(later.carry_out(FileRequest::NoBackdrop(opened.id)).is_empty());
    let mut last = PlanFiles::new(Some(directory.path()));
    assert_eq!(
        names(&last.carry_out(FileRequest::Open { path: at("plan.toml"), home: None, accepted: false })),
        []
    );
}

#[test]
fn a_map_that_cannot_be_read_is_one_sentence_and_stays_remembered() {
    let directory = tempfile::tempdir().unwrap();
    let at = |name: &str| directory.path().join(name);
    std::fs::write(at("road.geojson"), MAP).unwrap();
    let mut files = PlanFiles::new(Some(directory.path()));
    let mut opened = files.start_with(None, document(1));
    assert!(matches!(save(&mut files, &mut opened, &at("plan.toml"), false), FileReply::Saved { .. }));
    files.carry_out(FileRequest::Backdrop(opened.id, at("road.geojson")));
    for (name, contents) in [("empty.kml", "<kml/>"), ("wrong.gpx", "not a map")] {
        std::fs::write(at(name), contents).unwrap();
        let replies = files.carry_out(FileRequest::Backdrop(opened.id, at(name)));
        assert!(matches!(&replies[..], [FileReply::Failed(text)] if text.contains(name)), "{replies:?}");
    }
    std::fs::remove_file(at("road.geojson")).unwrap();
    let mut later = PlanFiles::new(Some(directory.path()));
    let replies = later.carry_out(FileRequest::Open { path: at("plan.toml"), home: None, accepted: false });
    assert!(matches!(&replies[1], FileReply::Failed(text) if text.contains("road.geojson")), "{replies:?}");
    std::fs::write(at("road.geojson"), MAP).unwrap();
    let mut last = PlanFiles::new(Some(directory.path()));
    assert_eq!(
        names(&last.carry_out(FileRequest::Open { path: at("plan.toml"), home: None, accepted: false }))
            .len(),
        1
    );
}
