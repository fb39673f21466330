//! Journals that are damaged, from a later version, or too large: every loss is reported.

use super::*;

/// Returns the journals, or the files set aside, in the order of their names.
fn kept(directory: &Path, extension: &str) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(directory.join("plans")).unwrap();
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.unwrap().path()).collect();
    paths.retain(|path| path.extension().is_some_and(|there| there == extension));
    paths.sort();
    paths
}

/// Writes a plan file of 50 m and a journal with edits to 51, 52, 53, 54 and 55 m, from a program that has ended.
fn edited_five_times(directory: &Path) -> PathBuf {
    let path = directory.join("plan.toml");
    let mut files = PlanFiles::new(Some(directory));
    let mut opened = files.start_with(None, document(5000));
    save(&mut files, &mut opened, &path, false);
    for alt_cm in [5100, 5200, 5300, 5400, 5500] {
        edit(&mut files, &mut opened, document(alt_cm));
    }
    path
}

/// Rewrites the journal with another line in the place of the edit to 53 m, and returns its bytes.
fn damage(directory: &Path, line: &str) -> Vec<u8> {
    let [journal] = kept(directory, "journal").try_into().unwrap();
    let text = std::fs::read_to_string(&journal).unwrap();
    let lines =
        text.lines().map(|there| if there.contains("5300") && there.contains("5200") { line } else { there });
    let damaged: String = lines.map(|line| format!("{line}\n")).collect();
    assert_ne!(damaged, text);
    std::fs::write(&journal, &damaged).unwrap();
    damaged.into_bytes()
}

#[test]
fn a_journal_that_is_damaged_in_the_middle_or_of_a_later_version_is_set_aside_as_it_was() {
    for line in ["{\"edited\":{\"label\":\"ed\u{0}\u{0}", "{\"edited_by\":{\"pilot\":1}}", ""] {
        let directory = tempfile::tempdir().unwrap();
        let path = edited_five_times(directory.path());
        let damaged = damage(directory.path(), line);
        let mut files = PlanFiles::new(Some(directory.path()));
        let mut replies = files
            .carry_out(FileRequest::Open { path: path.clone(), home: None, accepted: false })
            .into_iter();
        let Some(FileReply::Opened(mut back)) = replies.next() else { panic!("it is opened") };
        assert_eq!(back.history.document(), &document(5200), "what is whole is kept");
        let [bad] = kept(directory.path(), "bad").try_into().expect("one file set aside");
        let Some(FileReply::EditsLost(sentence)) = replies.next() else { panic!("the loss is reported") };
        let name = path.display();
        let expected = format!("3 edits of {name} could not be read: line 4 of the journal is damaged");
        assert!(sentence.starts_with(&expected), "{sentence}");
        assert!(sentence.ends_with(&format!("It is kept as {}.", bad.display())), "{sentence}");
        assert_eq!(std::fs::read(&bad).unwrap(), damaged);
        // The following edits are kept, and the next start has no losses to report.
        edit(&mut files, &mut back, document(6000));
        drop(files);
        let mut files = PlanFiles::new(Some(directory.path()));
        assert_eq!(open(&mut files, &path).history.document(), &document(6000));
        assert_eq!(kept(directory.path(), "bad"), [bad]);
    }
}

#[test]
fn a_file_that_was_set_aside_is_never_replaced() {
    let directory = tempfile::tempdir().unwrap();
    let path = edited_five_times(directory.path());
    let mut all = Vec::new();
    for line in ["noise", "more noise"] {
        all.push(damage(directory.path(), line));
        let mut files = PlanFiles::new(Some(directory.path()));
        let mut back = open(&mut files, &path);
        edit(&mut files, &mut back, document(5300));
    }
    let mut found: Vec<Vec<u8>> =
        kept(directory.path(), "bad").iter().map(|bad| std::fs::read(bad).unwrap()).collect();
    found.sort();
    all.sort();
    assert!(found == all, "both are kept, as they were");
}

#[test]
fn edits_after_the_damage_that_were_saved_are_in_the_file_and_shown_from_there() {
    for by_name in [true, false] {
        let directory = tempfile::tempdir().unwrap();
        let path = edited_five_times(directory.path());
        let mut files = PlanFiles::new(Some(directory.path()));
        let mut opened = open(&mut files, &path);
        save(&mut files, &mut opened, &path, false);
        drop(files);
        damage(directory.path(), "noise");
        let mut files = PlanFiles::new(Some(directory.path()));
        let mut back = match by_name {
            true => open(&mut files, &path),
            false => files.recovered().remove(0),
        };
        assert_eq!(back.history.document(), &document(5500), "the file is newer than the journal");
        assert!(back.history.is_saved() && files.changed().is_empty());
        back.history.undo();
        assert_eq!(back.history.document(), &document(5200));
    }
}

#[test]
fn a_journal_without_a_beginning_or_a_huge_one_is_set_aside() {
    let directory = tempfile::tempdir().unwrap();
    let plans = directory.path().join("plans");
    std::fs::create_dir(&plans).unwrap();
    std::fs::write(plans.join("noise.journal"), [0xff; 4096]).unwrap();
    std::fs::File::create(plans.join("huge.journal")).unwrap().set_len(1 << 40).unwrap();
    let mut files = PlanFiles::new(Some(directory.path()));
    assert!(files.recovered().is_empty());
    let bad = kept(directory.path(), "bad");
    assert_eq!(bad.len(), 2);
    let lost = files.take_losses();
    assert!(lost[0].contains("huge.journal was not read, it is larger than 64 MiB."), "{lost:?}");
    assert!(lost[1].contains("noise.journal was not read, its first line is damaged"), "{lost:?}");
    assert!(bad.iter().all(|bad| lost.iter().any(|lost| lost.contains(&bad.display().to_string()))));
    assert!(files.take_losses().is_empty());
    assert!(bad.iter().any(|path| std::fs::metadata(path).unwrap().len() == 1 << 40));
    assert!(bad.iter().any(|path| std::fs::metadata(path).unwrap().len() == 4096));
    assert!(kept(directory.path(), "journal").is_empty());
}

#[test]
fn a_line_that_was_cut_short_by_a_kill_is_no_damage() {
    let directory = tempfile::tempdir().unwrap();
    let path = edited_five_times(directory.path());
    let [journal] = kept(directory.path(), "journal").try_into().unwrap();
    let text = std::fs::read(&journal).unwrap();
    std::fs::write(&journal, &text[..text.len() - 9]).unwrap();
    let mut files = PlanFiles::new(Some(directory.path()));
    let back = open(&mut files, &path);
    assert_eq!(back.history.document(), &document(5400));
    assert!(back.notes[0].contains("cut off"), "{:?}", back.notes);
    assert!(files.take_losses().is_empty() && kept(directory.path(), "bad").is_empty());
}
