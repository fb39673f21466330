//! The page on tests names only tests that exist.

use std::fs;
use std::path::Path;

#[test]
fn every_test_that_the_page_names_for_a_link_check_is_there() {
    let root = test_support::path("");
    let page = fs::read_to_string(root.join("docs/testing.md")).unwrap();
    let rows: Vec<&str> = page.lines().filter(|line| line.starts_with("| L-")).collect();
    assert_eq!(rows.len(), 12);
    let mut named = 0;
    for row in rows {
        let mut target = String::new();
        for word in row.split('`').skip(1).step_by(2) {
            let module = word.replace("::", "/");
            let (file, folder) = (root.join(format!("tests/{module}.rs")), root.join("tests").join(&module));
            if file.is_file() || folder.is_dir() {
                target = module;
                continue;
            }
            assert!(
                text_of(&root.join("tests"), &target).contains(&format!("fn {word}(")),
                "{target}: {word}"
            );
            named += 1;
        }
    }
    assert!(named > 20, "{named}");
}

/// Returns the whole source of a module of the tests.
fn text_of(tests: &Path, module: &str) -> String {
    let mut text = fs::read_to_string(tests.join(format!("{module}.rs"))).unwrap_or_default();
    for entry in fs::read_dir(tests.join(module)).into_iter().flatten() {
        let path = entry.unwrap().path();
        if path.is_file() {
            text.push_str(&fs::read_to_string(path).unwrap());
        }
    }
    text
}
