//! The sub-rooms of each module that use each other, directly or on a detour.

use std::collections::{BTreeMap, BTreeSet};

use crate::rooms::paths::{Named, named, tokens};
use crate::rooms::source::{SourceFile, files};

/// The greatest number of pairs of sub-rooms of a module that use each other.
const MAX_CIRCLES: usize = 4;

/// The library that is loaded into an executable. The functions of libc that it replaces call each other.
const PRELOAD: &str = "link::sitl_child::lockstep::preload";

type Module = Vec<String>;

/// The sub-rooms of a module: the modules that its page declares, each with those that it uses.
type SubRooms<'a> = BTreeMap<&'a str, BTreeSet<&'a str>>;

/// Files by their modules, without their unit tests.
struct House {
    files: BTreeMap<Module, SourceFile>,
    paths: BTreeMap<Module, Vec<Named>>,
}

impl House {
    fn new(files: impl IntoIterator<Item = SourceFile>) -> Self {
        let files: BTreeMap<Module, SourceFile> =
            files.into_iter().map(|file| (file.module(), file.product())).collect();
        let paths = files.iter().map(|(module, file)| (module.clone(), named(file))).collect();
        Self { files, paths }
    }

    /// Returns the arrows between the sub-rooms of each module. A file counts for all modules above it.
    fn sub_rooms(&self) -> BTreeMap<&[String], SubRooms<'_>> {
        let mut all: BTreeMap<&[String], SubRooms<'_>> = BTreeMap::new();
        for module in self.files.keys() {
            for used in self.paths_in(module).iter().filter_map(|path| self.defined_in(path, 0)) {
                let Some((used, _)) = self.files.get_key_value(&used) else { continue };
                let shared = module.iter().zip(used).take_while(|(own, other)| own == other).count();
                if let (Some(from), Some(to)) = (module.get(shared), used.get(shared)) {
                    all.entry(&module[..shared]).or_default().entry(from).or_default().insert(to);
                }
            }
        }
        all
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
        let passed_on = self.paths[&module].iter().find(|named| named.name == *name);
        let source = passed_on.and_then(|named| {
            if named.is_ours { Some(named.path.clone()) } else { self.whole_path(&module, &named.path) }
        });
        source
            .and_then(|source| self.defined_in(&[&source, &path[length + 1..]].concat(), detours + 1))
            .or(Some(module))
    }
}

/// Returns the sets of sub-rooms each of which reaches all others of its set.
fn circles<'a>(rooms: &SubRooms<'a>) -> BTreeSet<Vec<&'a str>> {
    let reached = |from: &'a str| {
        let (mut reached, mut waiting) = (BTreeSet::new(), vec![from]);
        while let Some(next) = waiting.pop() {
            waiting.extend(rooms.get(next).into_iter().flatten().filter(|used| reached.insert(**used)));
        }
        reached
    };
    let all: BTreeMap<&str, BTreeSet<&str>> = rooms.keys().map(|room| (*room, reached(room))).collect();
    let circle = |(room, reached): (&&'a str, &BTreeSet<&'a str>)| {
        let back = |other: &&&'a str| all.get(**other).is_some_and(|others| others.contains(*room));
        reached.iter().filter(back).copied().collect::<Vec<_>>()
    };
    all.iter().map(circle).filter(|circle| circle.len() > 1).collect()
}

#[test]
fn at_most_two_sub_rooms_of_a_module_use_each_other() {
    let house = House::new(files());
    let mut wrong = Vec::new();
    for (module, rooms) in house.sub_rooms().into_iter().filter(|(module, _)| !module.is_empty()) {
        let (circles, name) = (circles(&rooms), module.join("::"));
        if name == PRELOAD {
            continue;
        }
        wrong.extend(
            circles.iter().filter(|circle| circle.len() > 2).map(|circle| format!("{name}: {circle:?}")),
        );
        if circles.len() > MAX_CIRCLES {
            wrong.push(format!("{name}: {circles:?}"));
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn circles_are_found_through_passed_on_items_and_local_names() {
    let found = |files: &[(&str, &str)]| {
        let file =
            |(name, text): &(&str, &str)| SourceFile { name: (*name).to_owned(), text: (*text).to_owned() };
        let house = House::new(files.iter().map(file));
        let all = house.sub_rooms();
        all.get(&["ui".to_owned()][..]).map(|rooms| format!("{:?}", circles(rooms))).unwrap_or_default()
    };
    let root = ("ui.rs", "mod a; mod b; mod c; pub(super) use c::C;");
    let other = ("ui/b.rs", "use super::C; pub(in crate::ui) struct B;");
    let (a, c) = (("ui/a.rs", "use super::b::B;"), ("ui/c.rs", "use crate::ui::a::A;"));
    assert_eq!(found(&[root, other, a, c]), "{[\"a\", \"b\", \"c\"]}");
    assert_eq!(found(&[root, other, a, ("ui/c.rs", "")]), "{}");
    let by_name = ("ui/a.rs", "use super::c; fn f() { c::d::g() }");
    let (child, grandchild) = (("ui/c.rs", "mod d; mod e;"), ("ui/c/d.rs", "use crate::ui::a::A;"));
    assert_eq!(found(&[root, by_name, child, grandchild]), "{[\"a\", \"c\"]}");
    let nested = [
        ("ui/c.rs", "mod d; use d::D;"),
        ("ui/c/d.rs", "use super::C; #[cfg(test)]\nmod tests { use crate::ui::a; }"),
    ];
    assert_eq!(found(&nested), "");
}
