//! The files over which the methods of one type are spread.

use std::collections::{BTreeMap, BTreeSet};

use crate::rooms::paths::{named, tokens};
use crate::rooms::source::{SourceFile, files};

/// The greatest number of files with methods of one type.
const MAX_FILES: usize = 4;

/// Returns the types that have inherent `impl` blocks in a file, also under another name.
fn types_with_methods(file: &SourceFile) -> BTreeSet<String> {
    let file = file.product();
    let imported = named(&file);
    let tokens = tokens(&file.text);
    let begins_item =
        |at: &usize| *at == 0 || ["}", ";", "]", "unsafe", "{"].contains(&tokens[at - 1].as_str());
    let blocks = (0..tokens.len()).filter(|&at| tokens[at] == "impl").filter(begins_item);
    let names = blocks.filter_map(|at| inherent_type(&tokens[at + 1..]));
    names
        .map(|name| {
            let renamed = imported.iter().find(|named| named.name == name);
            renamed.and_then(|named| named.path.last().cloned()).unwrap_or(name)
        })
        .collect()
}

/// Returns the type of the block whose `impl` is before these tokens, or `None` if it implements a trait.
fn inherent_type(tokens: &[String]) -> Option<String> {
    let mut depth = 0;
    let mut name = None;
    for (at, token) in tokens.iter().enumerate() {
        match token.as_str() {
            "<" => depth += 1,
            ">" if tokens[at - 1] != "-" => depth -= 1,
            "for" if depth == 0 => return None,
            "{" | "where" if depth == 0 => return name,
            word if depth == 0 && word.starts_with(char::is_alphabetic) => name = Some(word.to_owned()),
            _ => {}
        }
    }
    None
}

/// Returns the types whose methods are in too many files of a room, with these files.
fn spread(files: &[SourceFile]) -> Vec<(String, String, Vec<String>)> {
    let mut places: BTreeMap<(String, String), Vec<String>> = BTreeMap::new();
    for file in files {
        for name in types_with_methods(file) {
            places.entry((file.room(), name)).or_default().push(file.name.clone());
        }
    }
    places
        .into_iter()
        .filter(|(_, files)| files.len() > MAX_FILES)
        .map(|((room, name), files)| (room, name, files))
        .collect()
}

#[test]
fn the_methods_of_a_type_are_in_few_files() {
    let found = spread(&files());
    assert!(found.is_empty(), "{found:#?}");
}

#[test]
fn methods_are_found_however_the_block_is_written() {
    let blocks = [
        "impl World { fn f() {} }",
        "impl<T: Into<f64>> super::World<T> where T: Copy { fn f() {} }",
        "#[cfg(unix)]\nimpl<'a, F: Fn() -> f64> World<'a, F> { fn f() {} }",
        "use super::World as W;\nimpl W { fn f() {} }",
        "mod inside { impl crate::sim::World {} }",
    ];
    let file =
        |(at, text): (usize, &&str)| SourceFile { name: format!("sim/{at}.rs"), text: (*text).to_owned() };
    let mut files: Vec<_> = blocks.iter().enumerate().map(file).collect();
    assert_eq!(
        spread(&files).iter().map(|(_, name, files)| (name.as_str(), files.len())).collect::<Vec<_>>(),
        [("World", 5)]
    );
    for other in [
        "impl Clock for World {}",
        "impl<T: for<'a> F<'a>> From<T> for World {}",
        "fn f(of: impl World) -> impl World {}",
        "#[cfg(test)]\nmod tests { impl World {} }",
    ] {
        files[0].text = other.to_owned();
        assert_eq!(spread(&files).len(), 0, "{other}");
    }
}
