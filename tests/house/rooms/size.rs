//! The sizes of files and rooms.

use crate::rooms::source;

/// The greatest length of a file, lines.
const LONGEST: usize = 500;
/// The greatest median length of the files, lines.
const MEDIAN: usize = 150;
/// The number of files above which the first page of a room explains the layers inside.
const MANY_FILES: usize = 60;

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
