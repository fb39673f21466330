//! The table of rooms in `docs/architecture.md`.

const PAGE: &str = include_str!("../../../docs/architecture.md");

/// A row of the table.
#[derive(Debug)]
pub(crate) struct Room {
    /// The name of the module.
    pub(crate) name: String,
    /// The rooms it may use; `None` for all of them.
    uses: Option<Vec<String>>,
}

impl Room {
    /// Returns `true` if the room may use this part of another one.
    pub(crate) fn may_use(&self, other: &str, part: &str) -> bool {
        self.uses.as_ref().is_none_or(|uses| uses.iter().any(|used| covers(used, other, part)))
    }

    /// Returns the arrows that the page lists one by one.
    pub(crate) fn arrows(&self) -> Vec<(String, String)> {
        self.uses.iter().flatten().map(|used| (self.name.clone(), used.clone())).collect()
    }
}

/// Returns `true` if an entry of the table, `room` or `room::part`, is for this part of a room.
pub(crate) fn covers(entry: &str, room: &str, part: &str) -> bool {
    entry == room || entry.split_once("::") == Some((room, part))
}

/// Returns the rooms in the order of the table. A row may name several rooms with the same arrows.
pub(crate) fn rooms() -> Vec<Room> {
    let table = PAGE.split("| room | is | may use |").nth(1).expect("the table of rooms");
    let mut rooms = Vec::new();
    for row in table.lines().skip(2).take_while(|line| line.starts_with('|')) {
        let [_, names, _, uses, ..] = row.split('|').collect::<Vec<_>>()[..] else { panic!("{row}") };
        let uses = match uses.trim() {
            "everything" => None,
            uses => Some(words(uses)),
        };
        rooms.extend(words(names).into_iter().map(|name| Room { name, uses: uses.clone() }));
    }
    assert!(rooms.len() > 10, "{rooms:?}");
    rooms
}

/// Returns the words in backticks.
fn words(cell: &str) -> Vec<String> {
    cell.split('`').skip(1).step_by(2).map(str::to_owned).collect()
}
