//! The sizes of files and rooms.

use crate::rooms::source::{self, SourceFile};

/// The greatest length of a file, lines.
const LONGEST: usize = 500;
/// The greatest median length of the files, lines.
const MEDIAN: usize = 150;
/// The smallest number of lines of the core for each line of the shell.
const CORE_TO_SHELL: f64 = 2.5;
/// The number of files above which the first page of a room explains the layers inside.
const MANY_FILES: usize = 60;

/// Returns `true` for a file that talks to people, sockets, files or the clock. All other files are the core, including
/// the state of the screen: messages in, picture out.
fn is_shell(file: &SourceFile) -> bool {
    match file.room().as_str() {
        "link" => !file.name.starts_with("link/proto"),
        "fc" => ["fc/feed.rs", "fc/remote_link.rs", "fc/stepped.rs"].contains(&file.name.as_str()),
        "ui" => ["ui/run.rs", "ui/terminal.rs", "ui/files_link.rs"].contains(&file.name.as_str()),
        "app" | "args" | "session" | "storage" => true,
        _ => false,
    }
}

#[test]
fn files_are_small() {
    let mut lines: Vec<_> =
        source::files().iter().map(|file| (file.text.lines().count(), file.name.clone())).collect();
    lines.sort();
    let (median, longest) = (lines[lines.len() / 2].0, lines.last().unwrap());
    println!("{} files, median {median} lines, longest {longest:?}", lines.len());
    assert!(median <= MEDIAN, "{median}");
    assert!(longest.0 <= LONGEST, "{longest:?}");
}

#[test]
fn the_core_outweighs_the_shell() {
    let (shell, core): (Vec<_>, Vec<_>) = source::files().into_iter().partition(is_shell);
    let count = |files: &[SourceFile]| files.iter().map(SourceFile::product_lines).sum::<usize>() as f64;
    let (core, shell) = (count(&core), count(&shell));
    println!("core {core} lines, shell {shell} lines, {:.2} : 1", core / shell);
    assert!(core / shell >= CORE_TO_SHELL, "{core} : {shell}");
}

#[test]
fn a_room_with_many_files_explains_its_layers() {
    let files = source::files();
    for first_page in files.iter().filter(|file| !file.name.contains('/')) {
        let room = first_page.room();
        let inside = format!("{room}/");
        let layers: std::collections::BTreeSet<_> = files
            .iter()
            .filter_map(|file| file.name.strip_prefix(&inside)?.split_once('/'))
            .map(|(layer, _)| layer)
            .collect();
        let count = files.iter().filter(|file| file.name.starts_with(&inside)).count();
        if count <= MANY_FILES {
            continue;
        }
        let page: String = first_page.text.lines().take_while(|line| line.starts_with("//!")).collect();
        for layer in layers {
            assert!(page.contains(&format!("`{layer}`")), "src/{room}.rs does not explain its layer {layer}");
        }
    }
}
