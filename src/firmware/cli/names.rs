//! The names of a real board. They are stored but have no effect.

use super::super::config::{BOARD_NAME_MAX, MANUFACTURER_ID_MAX};
use super::session::Session;

pub(super) fn board_name(session: &mut Session<'_>, value: &str) {
    if let Some(name) = identity(value, BOARD_NAME_MAX) {
        session.configuration.board_name = name;
    }
    let name = session.configuration.board_name.clone();
    session.line(format_args!("board_name {name}"));
}

pub(super) fn manufacturer_id(session: &mut Session<'_>, value: &str) {
    if let Some(id) = identity(value, MANUFACTURER_ID_MAX) {
        session.configuration.manufacturer_id = id;
    }
    let id = session.configuration.manufacturer_id.clone();
    session.line(format_args!("manufacturer_id {id}"));
}

/// Returns the printable ASCII characters of `value`, at most `max` of them, without blanks at the ends; `None` if
/// nothing is left.
fn identity(value: &str, max: usize) -> Option<String> {
    let printable = value.chars().filter(|letter| (' '..='~').contains(letter));
    let name: String = printable.take(max).collect::<String>().trim().to_owned();
    (!name.is_empty()).then_some(name)
}

/// Prints an empty signature. The signature of a real board has no meaning here and is never stored.
pub(super) fn signature(session: &mut Session<'_>, _value: &str) {
    session.line("signature ");
}
