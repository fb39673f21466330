//! The files of `src/`.

/// The first page of the core. It declares its rooms.
const CORE: &str = include_str!("../../../src/core.rs");

use std::path::Path;

/// A source file of the crate.
#[derive(Debug)]
pub(crate) struct SourceFile {
    /// The path below `src/`, with `/`.
    pub(crate) name: String,
    pub(crate) text: String,
}

impl SourceFile {
    /// Returns the top-level module of the file.
    pub(crate) fn room(&self) -> String {
        self.module().into_iter().next().unwrap_or_else(|| "lib".to_owned())
    }

    /// Returns `true` if the file is compiled into the core.
    pub(crate) fn is_of_the_core(&self) -> bool {
        CORE.lines().any(|line| line.strip_prefix("pub mod ") == Some(&format!("{};", self.room())))
    }

    /// Returns the path of the file's module from the crate's root.
    pub(crate) fn module(&self) -> Vec<String> {
        let path = self.name.trim_end_matches(".rs");
        // The first page of a room that is a crate of its own.
        let path = path.strip_suffix("/lib").unwrap_or(path);
        if ["core", "lib"].contains(&path) {
            Vec::new()
        } else {
            path.split('/').map(str::to_owned).collect()
        }
    }

    /// Returns the file without its unit tests.
    pub(crate) fn product(&self) -> Self {
        let is_test = self.name.ends_with("/tests.rs") || self.name.contains("/tests/");
        let text = self.text.split("#[cfg(test)]\nmod tests {").next().unwrap_or_default();
        Self { name: self.name.clone(), text: if is_test { String::new() } else { text.to_owned() } }
    }
}

/// Returns all files, sorted by name, except `main.rs`, which is a crate of its own in the same room as `app`.
pub(crate) fn files() -> Vec<SourceFile> {
    let root = test_support::path("src");
    let mut files = Vec::new();
    let mut folders = vec![root.clone()];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                let name = below(&root, &path);
                let text = std::fs::read_to_string(&path).unwrap();
                files.push(SourceFile { name, text });
            }
        }
    }
    files.retain(|file| file.name != "main.rs");
    files.sort_by(|a, b| a.name.cmp(&b.name));
    files
}

fn below(root: &Path, path: &Path) -> String {
    let parts: Vec<_> = path.strip_prefix(root).unwrap().iter().map(|part| part.to_str().unwrap()).collect();
    parts.join("/")
}
