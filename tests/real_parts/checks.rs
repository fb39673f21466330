//! The page on tests names only tests that exist.

use std::fs;
use std::path::Path;

#[test]
fn every_test_that_the_page_names_for_a_link_check_is_there() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let page = fs::read_to_string(root.join("docs/testing.md")).unwrap();
    let rows: Vec<&str> = page.lines().filter(|line| line.starts_with("| L-")).collect();
    assert_eq!(rows.len(), 12);
    let mut named = 0;
    for row in rows {
        let mut target = "";
        for word in row.split('`').skip(1).step_by(2) {
            let (file, folder) = (root.join(format!("tests/{word}.rs")), root.join("tests").join(word));
            if file.is_file() || folder.is_dir() {
                target = word;
                continue;
            }
            assert!(
                text_of(&root.join("tests"), target).contains(&format!("fn {word}(")),
                "{target}: {word}"
            );
            named += 1;
        }
    }
    assert!(named > 20, "{named}");
}

/// Returns the whole source of a test target.
fn text_of(tests: &Path, target: &str) -> String {
    let file = tests.join(format!("{target}.rs"));
    if file.is_file() {
        return fs::read_to_string(file).unwrap();
    }
    let files = fs::read_dir(tests.join(target)).unwrap().map(|entry| entry.unwrap().path());
    files.filter(|path| path.is_file()).map(|path| fs::read_to_string(path).unwrap()).collect()
}
