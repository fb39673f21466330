use super::*;
use crate::recording::{End, Writer};

fn header(number: u32) -> Header {
    Header {
        format: 1,
        date: format!("2026-05-09T07:29:{number:02}Z"),
        plan: "a/b".to_owned(),
        ..Header::default()
    }
}

/// Records a flight of some bytes.
fn record(library: &mut Library, number: u32, bytes: usize) -> Result<(), String> {
    let mut writer = Writer::new(header(number));
    library.begin(&header(number), &writer.flush())?;
    // Noise, which does not get shorter by compression.
    let mut state = 0x9e37_79b9_u32;
    let mut letter = || {
        state ^= state << 13;
        state ^= state >> 17;
        state ^= state << 5;
        char::from(b'a' + (state % 26) as u8)
    };
    let noise: String = (0..bytes).map(|_| letter()).collect();
    writer.gap(noise);
    library.append(&writer.flush())?;
    library.end(&writer.finish(End { result: "complete".to_owned(), flown_s: 7.0, ..End::default() }))
}

fn names(state: &Path) -> Vec<String> {
    let name = |entry: &Listed| entry.file.file_name().unwrap().to_string_lossy().into_owned();
    list(state).unwrap().iter().map(name).collect()
}

#[test]
fn a_library_lists_what_was_recorded_the_newest_first() {
    let state = tempfile::tempdir().unwrap();
    assert_eq!(list(state.path()).unwrap(), []);
    let mut library = Library::new(state.path(), 1 << 20);
    for number in [1, 3, 2, 2] {
        record(&mut library, number, 100).unwrap();
    }
    assert_eq!(
        names(state.path()),
        [
            "2026-05-09T07-29-03-a-b.flight",
            "2026-05-09T07-29-02-a-b.flight",
            "2026-05-09T07-29-02-a-b-2.flight",
            "2026-05-09T07-29-01-a-b.flight"
        ]
    );
    let first = list(state.path()).unwrap().remove(0);
    let summary = first.summary.unwrap();
    assert_eq!((summary.header.plan.as_str(), summary.flown_s()), ("a/b", 7.0));
    assert_eq!(summary.end.unwrap().result, "complete");
}

#[test]
fn the_oldest_go_beyond_the_bound_and_not_what_is_being_recorded() {
    let state = tempfile::tempdir().unwrap();
    let mut library = Library::new(state.path(), 40_000);
    let mut other = Library::new(state.path(), 40_000);
    other.begin(&header(0), &Writer::new(header(0)).flush()).unwrap();
    for number in 1..=20 {
        record(&mut library, number, 8000).unwrap();
        let bytes: u64 = list(state.path()).unwrap().iter().map(|entry| entry.bytes).sum();
        assert!(bytes <= 40_000, "{bytes}");
    }
    let names = names(state.path());
    assert!((4..12).contains(&names.len()), "{names:?}");
    assert!(names[0].contains("29-20") && names.last().unwrap().contains("29-00"), "{names:?}");
    assert!(list(state.path()).unwrap().last().unwrap().is_growing);
}

#[test]
fn a_flight_that_takes_more_than_the_bound_keeps_what_fits() {
    let state = tempfile::tempdir().unwrap();
    let mut library = Library::new(state.path(), 3000);
    let problem = record(&mut library, 1, 100_000).unwrap_err();
    assert_eq!(problem, "it takes more than --recordings-max-mb, 0 MB");
    assert_eq!(library.append(b"more"), Ok(()), "it is over");
    let listed = list(state.path()).unwrap();
    assert!(listed[0].bytes <= 3000 && listed[0].summary.as_ref().unwrap().end.is_none());
    library.begin(&header(2), &Writer::new(header(2)).flush()).unwrap();
    library.discard();
    assert_eq!(names(state.path()).len(), 1);
    let tiny = Library::new(state.path(), 10).begin(&header(3), b"more than ten bytes");
    assert!(tiny.is_err() && names(state.path()).len() == 1);
}

#[test]
fn links_and_other_files_are_not_listed_and_a_damaged_recording_is() {
    let state = tempfile::tempdir().unwrap();
    let folder = state.path().join(FOLDER);
    record(&mut Library::new(state.path(), 1 << 20), 1, 100).unwrap();
    std::fs::write(state.path().join("precious.flight"), "precious").unwrap();
    std::os::unix::fs::symlink(state.path().join("precious.flight"), folder.join("link.flight")).unwrap();
    std::fs::write(folder.join("notes.txt"), "mine").unwrap();
    std::fs::write(folder.join("damaged.flight"), "GPS").unwrap();
    let listed = list(state.path()).unwrap();
    assert_eq!(listed.len(), 2, "{listed:?}");
    assert!(listed[1].summary.as_ref().unwrap_err().starts_with("it is not a recording"), "{listed:?}");
}

#[test]
fn a_folder_that_cannot_be_written_is_a_reason() {
    let state = tempfile::tempdir().unwrap();
    std::fs::write(state.path().join(FOLDER), "a file").unwrap();
    let problem = Library::new(state.path(), 1 << 20).begin(&header(1), b"x").unwrap_err();
    assert!(!problem.is_empty() && !problem.ends_with('.'), "{problem}");
    assert!(list(state.path()).is_err());
}

#[test]
fn a_list_that_is_read_again_has_what_was_recorded_meanwhile_and_lacks_what_is_gone() {
    let state = tempfile::tempdir().unwrap();
    let mut library = Library::new(state.path(), 1 << 20);
    let mut known = Known::default();
    record(&mut library, 1, 100).unwrap();
    assert_eq!(known.list(state.path()).unwrap(), list(state.path()).unwrap());
    library.begin(&header(2), &Writer::new(header(2)).flush()).unwrap();
    assert!(known.list(state.path()).unwrap()[0].is_growing);
    // The size stays the same.
    drop(library);
    let listed = known.list(state.path()).unwrap();
    assert!(!listed[0].is_growing && listed.len() == 2, "{listed:?}");
    std::fs::remove_file(&listed[1].file).unwrap();
    std::fs::write(&listed[0].file, "damaged").unwrap();
    let listed = known.list(state.path()).unwrap();
    assert!(listed.len() == 1 && listed[0].summary.is_err(), "{listed:?}");
}

#[test]
fn only_a_recording_of_the_library_that_is_over_is_deleted() {
    let state = tempfile::tempdir().unwrap();
    let mut library = Library::new(state.path(), 1 << 20);
    record(&mut library, 1, 100).unwrap();
    library.begin(&header(2), &Writer::new(header(2)).flush()).unwrap();
    let files: Vec<PathBuf> = list(state.path()).unwrap().into_iter().map(|listed| listed.file).collect();
    assert_eq!(remove(state.path(), &files[0]), Err("it is still being recorded".to_owned()));
    let precious = state.path().join("precious.flight");
    std::fs::write(&precious, "precious").unwrap();
    for outside in [
        precious,
        state.path().join(FOLDER).join("..").join("precious.flight"),
        files[1].with_extension("txt"),
    ] {
        assert_eq!(remove(state.path(), &outside), Err("it is not in the library".to_owned()));
    }
    assert_eq!(remove(state.path(), &files[1]), Ok(()));
    assert_eq!(list(state.path()).unwrap().len(), 1);
}
