use super::*;
use crate::plan::WaypointRecord;

mod backdrop;
mod damaged_journals;

fn document(alt_cm: i32) -> PlanDocument {
    let mut document = PlanDocument { name: "test".to_owned(), ..PlanDocument::default() };
    document.plan.waypoints.push(WaypointRecord { alt_cm, ..Default::default() }.into());
    document
}

/// Edits a plan in the same way as the editor.
fn edit(files: &mut PlanFiles, opened: &mut Opened, after: PlanDocument) {
    let change = opened.history.commit("edit", after).expect("a change").change().clone();
    let change = Box::new(change);
    let line = JournalLine::Edited { label: "edit".to_owned(), change };
    assert!(files.carry_out(FileRequest::Journal(opened.id, line)).is_empty());
}

fn save(files: &mut PlanFiles, opened: &mut Opened, path: &Path, replace: bool) -> FileReply {
    let document = Box::new(opened.history.document().clone());
    let revision = opened.history.at();
    let (id, path) = (opened.id, path.to_owned());
    let request = FileRequest::Save { id, path, document, revision, replace, accepted: false };
    let reply = files.carry_out(request).remove(0);
    if matches!(reply, FileReply::Saved { .. }) {
        opened.history.mark_saved();
    }
    reply
}

fn open(files: &mut PlanFiles, path: &Path) -> Opened {
    match files.carry_out(FileRequest::Open { path: path.to_owned(), home: None, accepted: false }).remove(0)
    {
        FileReply::Opened(opened) => *opened,
        other => panic!("{other:?}"),
    }
}

#[test]
fn edits_survive_a_program_that_is_gone_and_undo_reaches_back_beyond_it() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("plan.toml");
    let mut files = PlanFiles::new(Some(directory.path()));
    let mut opened = files.start_with(None, document(1));
    assert!(matches!(save(&mut files, &mut opened, &path, false), FileReply::Saved { .. }));
    edit(&mut files, &mut opened, document(2));
    edit(&mut files, &mut opened, document(3));
    drop(files);

    let mut files = PlanFiles::new(Some(directory.path()));
    let mut again = open(&mut files, &path);
    assert!(again.recovered);
    assert_eq!(again.history.document(), &document(3));
    again.history.undo();
    assert_eq!(again.history.document(), &document(2));
    assert!(files.recovered().is_empty(), "it is open already");
}

#[test]
fn a_lossy_save_asks_once_and_again_when_more_is_lost() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("plan.txt");
    let mut files = PlanFiles::new(Some(directory.path()));
    let with_home = PlanDocument { home: "40,-79,300".parse().ok(), ..document(1) };
    let mut opened = files.start_with(None, with_home.clone());
    let asked = save(&mut files, &mut opened, &path, false);
    let FileReply::Losses(losses) = asked else { panic!("{asked:?}") };
    assert_eq!((losses.lines.len(), losses.summary.as_str()), (1, "1 lost"));
    assert!(!path.exists(), "nothing is written before the answer");
    let accept = |document: &PlanDocument| FileRequest::Save {
        id: opened.id,
        path: path.clone(),
        document: Box::new(document.clone()),
        revision: 0,
        replace: false,
        accepted: true,
    };
    assert!(matches!(files.carry_out(accept(&with_home)).remove(0), FileReply::Saved { .. }));
    edit(&mut files, &mut opened, PlanDocument { plan: document(2).plan, ..with_home.clone() });
    assert!(
        matches!(save(&mut files, &mut opened, &path, false), FileReply::Saved { .. }),
        "the same losses"
    );
    edit(&mut files, &mut opened, PlanDocument { settings: vec!["a = 1".to_owned()], ..with_home });
    assert!(matches!(save(&mut files, &mut opened, &path, false), FileReply::Losses(_)), "more is lost");
}

#[test]
fn a_plan_without_a_file_is_recovered_and_a_discarded_one_is_not() {
    let directory = tempfile::tempdir().unwrap();
    let mut files = PlanFiles::new(Some(directory.path()));
    let mut first = files.start_with(None, document(1));
    edit(&mut files, &mut first, document(2));
    assert!(PlanFiles::new(Some(directory.path())).recovered().is_empty(), "another program has it open");
    drop(files);

    let mut files = PlanFiles::new(Some(directory.path()));
    let recovered = files.recovered().remove(0);
    assert_eq!(recovered.history.document(), &document(2));
    files.carry_out(FileRequest::Close { id: recovered.id, discard: true });
    drop(files);
    assert!(PlanFiles::new(Some(directory.path())).recovered().is_empty());
}

#[test]
fn a_file_of_somebody_else_is_never_replaced_unasked() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("plan.txt");
    std::fs::write(&path, "# theirs\n").unwrap();
    let mut files = PlanFiles::new(None);
    let mut opened = files.start_with(None, document(1));
    assert!(matches!(
        save(&mut files, &mut opened, &path, false),
        FileReply::Occupied { changed: false, .. }
    ));
    assert_eq!(std::fs::read_to_string(&path).unwrap(), "# theirs\n");
    assert!(matches!(save(&mut files, &mut opened, &path, true), FileReply::Saved { .. }));
    assert!(files.changed().is_empty(), "what this program wrote is no news");

    std::fs::write(&path, "waypoint insert 0 1 2 300 0 LAND 0 NONE\n").unwrap();
    assert_eq!(files.changed(), [opened.id]);
    assert!(files.changed().is_empty(), "reported once");
    edit(&mut files, &mut opened, document(5));
    assert!(matches!(save(&mut files, &mut opened, &path, false), FileReply::Occupied { changed: true, .. }));
    let again = open(&mut files, &path);
    assert_eq!(again.id, opened.id, "read again in its place");
}

#[test]
fn a_file_that_another_program_changed_comes_as_an_edit() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("plan.toml");
    let mut files = PlanFiles::new(Some(directory.path()));
    let mut opened = files.start_with(None, document(1));
    edit(&mut files, &mut opened, document(2));
    save(&mut files, &mut opened, &path, false);
    drop(files);
    let theirs = crate::plan::format::write(&document(9).into(), crate::plan::format::Format::Toml).contents;
    std::fs::write(&path, theirs).unwrap();

    let mut files = PlanFiles::new(Some(directory.path()));
    let mut again = open(&mut files, &path);
    assert_eq!(again.history.document(), &document(9));
    assert!(again.history.is_saved() && again.notes[0].contains("another program"));
    again.history.undo();
    assert_eq!(again.history.document(), &document(2));
}

#[test]
fn what_is_wrong_is_one_sentence() {
    let directory = tempfile::tempdir().unwrap();
    let mut files = PlanFiles::new(None);
    let mut opened = files.start_with(None, document(1));
    let bad = directory.path().join("bad.toml");
    std::fs::write(&bad, "name = 3\n[[waypoint]]\ntype = \"LAMD\"\n").unwrap();
    for path in [bad, directory.path().join("missing.toml"), directory.path().to_owned()] {
        let FileReply::Failed(sentence) =
            files.carry_out(FileRequest::Open { path, home: None, accepted: false }).remove(0)
        else {
            panic!()
        };
        assert!(!sentence.is_empty());
    }
    let nameless = directory.path().join("plan");
    let FileReply::Failed(sentence) = save(&mut files, &mut opened, &nameless, false) else { panic!() };
    assert!(sentence.contains(".toml"), "{sentence}");
    let FileReply::Listed(listing) =
        files.carry_out(FileRequest::List(Some(directory.path().to_owned()))).remove(0)
    else {
        panic!()
    };
    assert_eq!(listing.entries.iter().map(|entry| entry.name.as_str()).collect::<Vec<_>>(), ["bad.toml"]);
}

#[test]
fn edits_that_a_full_disk_refused_are_kept_as_soon_as_there_is_room() {
    let directory = tempfile::tempdir().unwrap();
    let mut files = PlanFiles::new(Some(directory.path()));
    let mut opened = files.start_with(None, document(1));
    edit(&mut files, &mut opened, document(2));
    // Simulates a write that failed half way.
    let file = files.open.get_mut(&opened.id).unwrap();
    file.is_behind = true;
    let path = std::fs::read_dir(directory.path().join("plans")).unwrap().next().unwrap().unwrap().path();
    let text = std::fs::read_to_string(&path).unwrap();
    std::fs::write(&path, format!("{text}{{\"edited\":")).unwrap();
    edit(&mut files, &mut opened, document(3));
    edit(&mut files, &mut opened, document(4));
    drop(files);
    let recovered = PlanFiles::new(Some(directory.path())).recovered().remove(0);
    assert_eq!(recovered.history.document(), &document(4));
}

#[cfg(unix)]
#[test]
fn a_journal_that_is_a_pipe_or_nonsense_does_not_hold_the_program_up() {
    let directory = tempfile::tempdir().unwrap();
    let plans = directory.path().join("plans");
    std::fs::create_dir(&plans).unwrap();
    let fifo = plans.join("fifo.journal");
    assert!(std::process::Command::new("mkfifo").arg(&fifo).status().unwrap().success());
    std::fs::write(plans.join("noise.journal"), [0xff; 4096]).unwrap();
    std::fs::create_dir(plans.join("directory.journal")).unwrap();
    std::fs::File::create(plans.join("huge.journal")).unwrap().set_len(1 << 40).unwrap();
    assert!(PlanFiles::new(Some(directory.path())).recovered().is_empty());
}

/// Writes a plan like another program.
fn write_theirs(path: &Path, alt_cm: i32) {
    let theirs =
        crate::plan::format::write(&document(alt_cm).into(), crate::plan::format::Format::Toml).contents;
    std::fs::write(path, theirs).unwrap();
}

#[test]
fn read_it_again_shows_what_the_other_program_wrote_and_undo_what_i_had() {
    for state in [true, false] {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("plan.toml");
        let mut files = PlanFiles::new(Some(directory.path()).filter(|_| state));
        let mut opened = files.start_with(None, document(1));
        save(&mut files, &mut opened, &path, false);
        edit(&mut files, &mut opened, document(2));
        write_theirs(&path, 9);
        assert!(matches!(
            save(&mut files, &mut opened, &path, false),
            FileReply::Occupied { changed: true, .. }
        ));
        let mut again = open(&mut files, &path);
        assert_eq!((again.id, again.history.document()), (opened.id, &document(9)));
        assert!(again.history.is_saved() && !again.recovered, "{:?}", again.notes);
        again.history.undo();
        assert_eq!(again.history.document(), &document(2), "my edit is not lost");
        // The journal continues after it.
        let mut opened = open(&mut files, &path);
        edit(&mut files, &mut opened, document(10));
        assert!(matches!(save(&mut files, &mut opened, &path, false), FileReply::Saved { .. }));
    }
}

#[test]
fn edits_that_come_back_do_not_replace_what_another_program_wrote_meanwhile() {
    for by_name in [true, false] {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("plan.toml");
        let mut files = PlanFiles::new(Some(directory.path()));
        let mut opened = files.start_with(None, document(1));
        save(&mut files, &mut opened, &path, false);
        edit(&mut files, &mut opened, document(2));
        drop(files);
        let recover = |files: &mut PlanFiles| match by_name {
            true => open(files, &path),
            false => files.recovered().remove(0),
        };
        let mut files = PlanFiles::new(Some(directory.path()));
        let mut back = recover(&mut files);
        assert!(back.recovered);
        edit(&mut files, &mut back, document(3));
        assert!(files.changed().is_empty(), "nobody wrote the file");
        drop(files);
        write_theirs(&path, 9);
        let mut files = PlanFiles::new(Some(directory.path()));
        let mut back = recover(&mut files);
        assert_eq!(back.history.document(), &document(3));
        assert_eq!(files.changed(), [back.id]);
        let reply = save(&mut files, &mut back, &path, false);
        assert!(matches!(reply, FileReply::Occupied { changed: true, .. }), "{by_name}: {reply:?}");
    }
}

#[test]
fn a_plan_saved_in_a_format_without_names_was_changed_by_nobody() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("plan.txt");
    let mut files = PlanFiles::new(Some(directory.path()));
    let mut opened = files.start_with(None, document(1));
    edit(&mut files, &mut opened, document(2));
    assert!(matches!(save(&mut files, &mut opened, &path, false), FileReply::Saved { .. }));
    drop(files);
    let again = open(&mut PlanFiles::new(Some(directory.path())), &path);
    assert_eq!(again.notes, [""; 0]);
    assert_eq!(again.history.document(), &document(2), "the journal knows the name");
}

#[test]
fn a_write_protected_file_is_not_replaced() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("plan.toml");
    let mut files = PlanFiles::new(None);
    let mut opened = files.start_with(None, document(1));
    save(&mut files, &mut opened, &path, false);
    let written = std::fs::read_to_string(&path).unwrap();
    let mut permissions = path.metadata().unwrap().permissions();
    permissions.set_readonly(true);
    std::fs::set_permissions(&path, permissions).unwrap();
    edit(&mut files, &mut opened, document(2));
    for replace in [false, true] {
        let FileReply::Failed(sentence) = save(&mut files, &mut opened, &path, replace) else {
            panic!("it was replaced")
        };
        assert!(sentence.contains("plan.toml is write-protected: save under another name"), "{sentence}");
    }
    assert_eq!(std::fs::read_to_string(&path).unwrap(), written);
}

/// Writes a plan over the bytes of the file, and keeps its length, inode and time stamp.
fn write_theirs_unseen(path: &Path, alt_cm: i32) {
    let before = path.metadata().unwrap();
    write_theirs(path, alt_cm);
    let file = std::fs::OpenOptions::new().write(true).open(path).unwrap();
    file.set_modified(before.modified().unwrap()).unwrap();
    assert_eq!(path.metadata().unwrap().len(), before.len());
}

#[test]
fn a_change_of_the_same_length_within_a_clock_tick_is_seen() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("plan.toml");
    let mut files = PlanFiles::new(Some(directory.path()));
    let mut opened = files.start_with(None, document(1));
    save(&mut files, &mut opened, &path, false);
    edit(&mut files, &mut opened, document(2));
    write_theirs_unseen(&path, 9);
    assert_eq!(files.changed(), [opened.id]);
    let reply = save(&mut files, &mut opened, &path, false);
    assert!(matches!(reply, FileReply::Occupied { changed: true, .. }), "{reply:?}");
    assert_eq!(on_disk::read(&path, None).unwrap().document, document(9), "theirs is still there");
    let mut again = open(&mut files, &path);
    assert_eq!(again.history.document(), &document(9));
    again.history.undo();
    assert_eq!(again.history.document(), &document(2));
}

#[test]
fn a_file_with_a_new_time_stamp_and_the_same_content_was_changed_by_nobody() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("plan.toml");
    let mut files = PlanFiles::new(Some(directory.path()));
    let mut opened = files.start_with(None, document(1));
    save(&mut files, &mut opened, &path, false);
    let file = std::fs::OpenOptions::new().write(true).open(&path).unwrap();
    file.set_modified(std::time::UNIX_EPOCH).unwrap();
    assert!(files.changed().is_empty());
    edit(&mut files, &mut opened, document(2));
    assert!(matches!(save(&mut files, &mut opened, &path, false), FileReply::Saved { .. }));
}
