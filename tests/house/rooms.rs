//! The rooms of `docs/architecture.md` against the code: the allowed uses between them, and their sizes.
#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "a test may stop and say what it expects")]

mod circles;
mod front;
mod impls;
mod page;
mod paths;
mod portable;
mod rules;
mod size;
mod source;

use std::collections::BTreeSet;

use page::Room;
use source::SourceFile;

/// A room, the room that it uses and the first segment below it, and the file in which the use was found.
type Use = (String, (String, String), String);

fn uses(files: &[SourceFile]) -> BTreeSet<Use> {
    files
        .iter()
        .flat_map(|file| {
            let room = file.room();
            paths::rooms_used(file)
                .into_iter()
                .filter(move |(used, _)| *used != file.room())
                .map(move |used| (room.clone(), used, file.name.clone()))
        })
        .collect()
}

#[test]
fn every_room_is_on_the_page_and_uses_what_the_page_allows() {
    let (rooms, files) = (page::rooms(), source::files());
    let in_code: BTreeSet<_> = files.iter().map(SourceFile::room).filter(|room| room != "lib").collect();
    let on_page: BTreeSet<_> = rooms.iter().map(|room| room.name.clone()).collect();
    assert_eq!(in_code, on_page, "the rooms of src/ and those of docs/architecture.md");

    let allowed = |from: &str, (to, part): &(String, String)| {
        rooms.iter().any(|room| room.name == from && room.may_use(to, part))
    };
    let forbidden: Vec<_> = uses(&files).into_iter().filter(|(from, to, _)| !allowed(from, to)).collect();
    assert!(forbidden.is_empty(), "arrows that docs/architecture.md does not allow: {forbidden:#?}");
}

#[test]
fn what_the_page_allows_is_used() {
    let used = uses(&source::files());
    let is_used = |(from, to): &(String, String)| {
        used.iter().any(|(user, (room, part), _)| user == from && page::covers(to, room, part))
    };
    let idle: Vec<_> = page::rooms().iter().flat_map(Room::arrows).filter(|arrow| !is_used(arrow)).collect();
    assert!(idle.is_empty(), "arrows of docs/architecture.md that no code uses: {idle:?}");
}

#[test]
fn no_two_rooms_use_each_other_directly_or_on_a_detour() {
    // The page lists the rooms from the ground up: each uses only rooms above it in the table.
    let rooms = page::rooms();
    for (index, room) in rooms.iter().enumerate() {
        for (from, to) in room.arrows() {
            assert!(
                rooms[..index].iter().any(|lower| to.split("::").next() == Some(&lower.name)),
                "{from} uses {to}, which stands further down the table"
            );
        }
    }
}
