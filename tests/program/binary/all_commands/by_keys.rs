//! Commands by their first keys.

use betadeck::ui::action::ACTIONS;

use super::walk::Hand;
use crate::binary::pty::Terminal;

/// Gives every action by the first of its keys.
#[derive(Debug)]
pub(super) struct Keys;

impl Hand for Keys {
    fn act(&mut self, terminal: &mut Terminal, name: &'static str) {
        let spec = ACTIONS.iter().find(|spec| spec.name == name).expect(name);
        terminal.send(&bytes(spec.keys[0]));
    }

    fn close(&mut self, terminal: &mut Terminal, _: Option<&str>) {
        terminal.send("\x1b");
    }

    fn line(&mut self, terminal: &mut Terminal, name: &'static str) {
        terminal.send(&format!(":{name} "));
    }
}

/// Returns the bytes that a terminal sends for a key of the keymap.
fn bytes(key: &str) -> String {
    let (modifier, key) = match key.split_once('-') {
        Some((modifier @ ("shift" | "alt" | "ctrl"), key)) => (modifier, key),
        _ => ("", key),
    };
    let code = match modifier {
        "shift" => ";2",
        "alt" => ";3",
        "ctrl" => ";5",
        _ => "",
    };
    // An arrow with a modifier has a first parameter.
    let lettered = |letter: char| {
        if code.is_empty() { format!("\x1b[{letter}") } else { format!("\x1b[1{code}{letter}") }
    };
    match (modifier, key) {
        (_, "up") => lettered('A'),
        (_, "down") => lettered('B'),
        (_, "right") => lettered('C'),
        (_, "left") => lettered('D'),
        (_, "home") => lettered('H'),
        (_, "end") => lettered('F'),
        ("shift", "tab") => "\x1b[Z".to_owned(),
        ("", "pageup") => "\x1b[5~".to_owned(),
        ("", "pagedown") => "\x1b[6~".to_owned(),
        ("", "delete") => "\x1b[3~".to_owned(),
        ("", "f12") => "\x1b[24~".to_owned(),
        ("", "enter") => "\r".to_owned(),
        ("", "esc") => "\x1b".to_owned(),
        ("", "tab") => "\t".to_owned(),
        ("", "space") => " ".to_owned(),
        ("alt", key) if key.chars().count() == 1 => format!("\x1b{key}"),
        ("ctrl", key) if key.len() == 1 => char::from(key.as_bytes()[0] & 0x1f).to_string(),
        ("", key) if key.chars().count() == 1 => key.to_owned(),
        other => panic!("no bytes for {other:?}"),
    }
}
