//! The table of messages: its order, its copy in the manual, and any payload for any row.

use betadeck_core::firmware::msp::{MESSAGES, handle};
use betadeck_core::msp::{Access, Form, Frame};
use proptest::prelude::*;

use super::{craft, facts};

#[test]
fn the_table_is_sorted_and_every_reading_message_answers() {
    assert!(MESSAGES.is_sorted_by_key(|message| message.kind.code));
    for message in MESSAGES.iter().filter(|message| message.kind.access == Access::Read) {
        let mut configuration = craft();
        let outcome = handle(message.kind.code, &[], &mut configuration, &facts());
        assert!(outcome.reply.is_some(), "{}", message.kind.name);
        assert_eq!(outcome.action, None, "{}", message.kind.name);
        assert_eq!(configuration, craft(), "{}", message.kind.name);
    }
}

/// Returns the rows of the manual's table of messages.
fn manual_rows() -> String {
    use std::fmt::Write;
    let mut rows = "| code | message | |\n| --- | --- | --- |\n".to_owned();
    for message in MESSAGES {
        writeln!(rows, "| {} | {} | {} |", message.kind.code, message.kind.name, message.kind.access)
            .unwrap();
    }
    rows
}

#[test]
fn the_manual_lists_every_message() {
    let path = test_support::path("docs/links.md");
    let manual = std::fs::read_to_string(&path).unwrap();
    let marks = ["`the_manual_lists_every_message` -->\n", "<!-- end of messages -->"];
    let start = manual.find(marks[0]).unwrap() + marks[0].len();
    let end = manual.find(marks[1]).unwrap();
    if std::env::var_os("UPDATE_MANUAL").is_some() {
        let updated = format!("{}{}{}", &manual[..start], manual_rows(), &manual[end..]);
        return std::fs::write(path, updated).unwrap();
    }
    assert_eq!(&manual[start..end], manual_rows(), "run this test with UPDATE_MANUAL=1");
}

proptest! {
    #[test]
    fn no_payload_does_harm(index in 0..MESSAGES.len(), payload in prop::collection::vec(any::<u8>(), 0..192)) {
        let mut configuration = craft();
        let message = &MESSAGES[index];
        let outcome = handle(message.kind.code, &payload, &mut configuration, &facts());
        if let Some(reply) = outcome.reply {
            let frame = Frame::request(Form::V2, message.kind.code, &[]).answer(Some(reply));
            prop_assert!(frame.payload.len() <= 4096);
        }
        // After any message, the craft still answers every reading message.
        for message in MESSAGES.iter().filter(|message| message.kind.access == Access::Read) {
            prop_assert!(handle(message.kind.code, &[], &mut configuration, &facts()).reply.is_some());
        }
    }
}
