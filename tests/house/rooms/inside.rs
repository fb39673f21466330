//! The arrows between the sub-rooms of large rooms.

use std::collections::BTreeSet;

use crate::rooms::circles::Room;
use crate::rooms::source::{SourceFile, files};

/// The sub-rooms of each room with those they use. The name of the room is its first page.
const TABLE: &str = include_str!("inside.txt");

/// Returns the arrows of a room in the table.
fn allowed(room: &str) -> BTreeSet<(&str, String)> {
    let block = TABLE.split("\n\n").find_map(|block| block.strip_prefix(&format!("# {room}\n")));
    let rows = block.unwrap_or_else(|| panic!("{room} is not in the table")).lines();
    rows.flat_map(|row| {
        let (from, used) = row.split_once(": ").unwrap_or_else(|| panic!("{row}"));
        used.split(' ').map(move |used| (from, used.to_owned()))
    })
    .collect()
}

#[test]
fn sub_rooms_use_what_the_table_allows() {
    let mut wrong = Vec::new();
    for room in TABLE.lines().filter_map(|line| line.strip_prefix("# ")) {
        let parsed = Room::new(files().into_iter().filter(|file| file.room() == room));
        let (found, allowed) = (parsed.arrows(), allowed(room));
        wrong.extend(found.difference(&allowed).map(|(from, to)| format!("{room}: new: {from} uses {to}")));
        wrong
            .extend(allowed.difference(&found).map(|(from, to)| format!("{room}: unused: {from} uses {to}")));
    }
    assert!(wrong.is_empty(), "the arrows of the code and of tests/house/rooms/inside.txt: {wrong:#?}");
}

#[test]
fn arrows_are_found_through_passed_on_items() {
    let file = |name: &str, text: &str| SourceFile { name: name.to_owned(), text: text.to_owned() };
    let room = Room::new([
        file("sim.rs", "mod a; mod b; mod c; pub use c::C; pub struct Whole;"),
        file("sim/a.rs", "use super::C; mod inside;"),
        file(
            "sim/a/inside.rs",
            "use super::super::b; use crate::sim::Whole; use super::A; fn f() { b::g() }",
        ),
        file("sim/b.rs", "#[cfg(test)]\nmod tests { use crate::sim::c; }"),
        file("sim/c.rs", "pub(in crate::sim) struct C;"),
    ]);
    let arrows = [("a", "b"), ("a", "c"), ("a", "sim")].map(|(from, to)| (from, to.to_owned()));
    assert_eq!(room.arrows(), BTreeSet::from(arrows));
}
