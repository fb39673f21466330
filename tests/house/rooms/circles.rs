//! The modules of a room that import each other, directly or on a detour.

use std::collections::{BTreeMap, BTreeSet};

use crate::rooms::paths::{Named, named, tokens};
use crate::rooms::source::{SourceFile, files};

/// The greatest number of files of `ui` that import each other.
const MAX_CIRCLE_OF_UI: usize = 5;

type Module = Vec<String>;

/// The files of a room by their modules, without their unit tests.
pub(crate) struct Room {
    files: BTreeMap<Module, SourceFile>,
    paths: BTreeMap<Module, Vec<Named>>,
}

impl Room {
    pub(crate) fn new(files: impl IntoIterator<Item = SourceFile>) -> Self {
        let files: BTreeMap<Module, SourceFile> =
            files.into_iter().map(|file| (file.module(), file.product())).collect();
        let paths = files.iter().map(|(module, file)| (module.clone(), named(file))).collect();
        Self { files, paths }
    }

    /// Returns the arrows between the sub-rooms: the modules that the first page declares, and this page by the name of
    /// the room.
    pub(crate) fn arrows(&self) -> BTreeSet<(&str, String)> {
        let modules = self.files.keys().filter(|module| module.len() > 1);
        let arrows = modules.flat_map(|module| {
            let used = self.paths_in(module).into_iter().filter_map(|path| self.defined_in(&path, 0));
            used.map(move |used| (module[1].as_str(), used.get(1).unwrap_or(&used[0]).clone()))
        });
        arrows.filter(|(from, to)| from != to).collect()
    }

    /// Returns the modules that a module imports. Parent and child modules are left out.
    fn imports(&self, module: &Module) -> BTreeSet<Module> {
        let is_other =
            |other: &Module| other != module && !is_nested(module, other) && !is_nested(other, module);
        self.paths_in(module).iter().filter_map(|path| self.defined_in(path, 0)).filter(is_other).collect()
    }

    /// Returns the paths of a module from the root of the crate: those of its `use` declarations, and those that begin
    /// with a name that a `use` or a `mod` declares.
    fn paths_in(&self, module: &Module) -> Vec<Module> {
        let known = &self.paths[module];
        let mut paths: Vec<Module> =
            known.iter().filter_map(|named| self.whole_path(module, &named.path)).collect();
        let is_ours = |named: &&Named| named.is_ours;
        paths.extend(known.iter().filter(is_ours).map(|named| named.path.clone()));
        let tokens = tokens(&self.files[module].text);
        for (at, name) in
            tokens.iter().enumerate().filter(|(at, _)| tokens.get(at + 1).is_some_and(|next| next == "::"))
        {
            if at > 0 && tokens[at - 1] == "::" {
                continue;
            }
            let rest = tokens[at + 2..].iter().step_by(2).zip(tokens[at + 1..].iter().step_by(2));
            let rest: Module =
                rest.take_while(|(_, joint)| *joint == "::").map(|(segment, _)| segment.clone()).collect();
            let imported = known.iter().filter(is_ours).find(|named| named.name == *name);
            let base = imported
                .map(|named| named.path.clone())
                .or_else(|| self.whole_path(module, std::slice::from_ref(name)));
            paths.extend(base.map(|base| [base, rest].concat()));
        }
        paths
    }

    /// Returns a path that begins with a child of a module, from the root of the crate.
    fn whole_path(&self, module: &Module, path: &[String]) -> Option<Module> {
        let whole = [module.as_slice(), path].concat();
        self.files.contains_key(&whole[..=module.len()]).then_some(whole)
    }

    /// Returns the module that defines an item, also if others pass it on.
    fn defined_in(&self, path: &[String], detours: usize) -> Option<Module> {
        // A path may end in an item or in a module.
        let length = (2..=path.len()).rev().find(|&length| self.files.contains_key(&path[..length]));
        let length =
            length.or_else(|| (path.len() > 1 && self.files.contains_key(&path[..1])).then_some(1))?;
        let module = path[..length].to_vec();
        let Some(name) = path.get(length).filter(|_| detours < 10) else { return Some(module) };
        let passed_on = self.paths[&module].iter().find(|named| named.is_passed_on && named.name == *name);
        let source = passed_on.and_then(|named| {
            if named.is_ours { Some(named.path.clone()) } else { self.whole_path(&module, &named.path) }
        });
        source
            .and_then(|source| self.defined_in(&[&source, &path[length + 1..]].concat(), detours + 1))
            .or(Some(module))
    }

    /// Returns the largest set of modules each of which reaches all others by imports.
    fn largest_circle(&self) -> Vec<String> {
        let imports: BTreeMap<&Module, BTreeSet<Module>> =
            self.files.keys().map(|module| (module, self.imports(module))).collect();
        let reached: BTreeMap<&Module, BTreeSet<&Module>> = imports
            .keys()
            .map(|module| {
                let (mut reached, mut waiting) = (BTreeSet::new(), vec![*module]);
                while let Some(next) = waiting.pop() {
                    waiting.extend(imports[next].iter().filter(|import| reached.insert(*import)));
                }
                (*module, reached)
            })
            .collect();
        let circle = |module: &Module| -> Vec<String> {
            let others = reached[module].iter().filter(|other| reached[**other].contains(module));
            others.map(|other| other.join("/")).collect()
        };
        self.files.keys().map(circle).max_by_key(Vec::len).unwrap_or_default()
    }
}

/// Returns `true` if one module is the parent of the other.
fn is_nested(parent: &Module, child: &Module) -> bool {
    child.split_last().is_some_and(|(_, parents)| parents == parent.as_slice())
}

#[test]
fn few_modules_of_the_screen_import_each_other() {
    let room = Room::new(files().into_iter().filter(|file| file.room() == "ui"));
    let circle = room.largest_circle();
    assert!(circle.len() <= MAX_CIRCLE_OF_UI, "{} files: {circle:#?}", circle.len());
}

#[test]
fn circles_are_found_through_passed_on_items_and_local_names() {
    let circle = |files: &[(&str, &str)]| {
        let file =
            |(name, text): &(&str, &str)| SourceFile { name: (*name).to_owned(), text: (*text).to_owned() };
        Room::new(files.iter().map(file)).largest_circle()
    };
    let root = ("ui.rs", "mod a; mod b; mod c; pub use c::C;");
    let other = ("ui/b.rs", "use super::C; pub(in crate::ui) struct B;");
    assert_eq!(
        circle(&[root, other, ("ui/a.rs", "use super::b::B;"), ("ui/c.rs", "use crate::ui::a::A;")]).len(),
        3
    );
    assert_eq!(circle(&[root, other, ("ui/a.rs", "use super::b::B;"), ("ui/c.rs", "")]), [""; 0]);
    let by_name = ("ui/a.rs", "use super::c; fn f() { c::d::g() }");
    let (child, grandchild) = (("ui/c.rs", "mod d; mod e;"), ("ui/c/d.rs", "use crate::ui::a::A;"));
    assert_eq!(circle(&[root, by_name, child, grandchild]), ["ui/a", "ui/c/d"]);
    let nested = [
        ("ui/c.rs", "mod d; use d::D;"),
        ("ui/c/d.rs", "use super::C; #[cfg(test)]\nmod tests { use crate::ui::a; }"),
    ];
    assert_eq!(circle(&nested), [""; 0]);
}
