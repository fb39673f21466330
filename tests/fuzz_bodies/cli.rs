//! The command line: the bytes are the lines of a session.

use std::time::Duration;

use betadeck::firmware::cli::{CliContext, CliFacts, CliMode, Interpreter, MAX_LINE, complete, hint};
use betadeck::firmware::config::Configuration;
use betadeck::link::proto::command_line::Completion;
use betadeck::link::proto::line_editor::LineEditor;

use super::craft;

/// The kinds of session.
const MODES: [CliMode; 4] = [CliMode::Interactive, CliMode::Framed, CliMode::Message, CliMode::File];

/// Types the lines in every kind of session, on the ground and in the air, and the bytes at a serial link.
pub fn run(data: &[u8]) {
    let text = String::from_utf8_lossy(data);
    let mut checked = craft::Checked::default();
    for mode in MODES {
        for armed in [false, true] {
            let facts = CliFacts { armed, ..CliFacts::default() };
            checked.assert_sound(session(&text, mode, &facts));
        }
    }
    link(data);
}

/// Runs one session and returns the resulting configuration of the craft.
fn session(text: &str, mode: CliMode, facts: &CliFacts) -> Configuration {
    let mut configuration = Configuration::default();
    let mut interpreter = Interpreter::new(mode);
    for line in text.lines() {
        let before = configuration.clone();
        let reply = interpreter.run(line, &mut CliContext { configuration: &mut configuration, facts });
        assert!(reply.text.len() <= craft::MAX_TEXT, "{line}: {} bytes", reply.text.len());
        assert!(!reply.failed || configuration == before, "{line} is refused and changes the craft");
        assert!(!reply.failed || reply.actions.is_empty(), "{line} is refused and asks for something");
        let completion = complete(line);
        assert!(line.is_char_boundary(completion.start), "{line}");
        assert!(completion.candidates.iter().all(|word| word.starts_with(&completion.common)), "{line}");
        let _shown = hint(line, Some(&configuration.settings));
    }
    configuration
}

/// Feeds the bytes as they come over a serial link, 60 ms apart.
fn link(data: &[u8]) {
    let mut configuration = Configuration::default();
    let mut interpreter = Interpreter::default();
    let mut editor = LineEditor::default();
    let facts = CliFacts::default();
    for (at, byte) in b"#".iter().chain(data).enumerate() {
        let now = Duration::from_millis(at as u64 * 60);
        let output = editor.feed(*byte, false, now);
        assert!(output.bytes.len() <= craft::MAX_TEXT);
        if output.completes {
            let found = complete(editor.line());
            let completion =
                Completion { tail: found.tail(editor.line()).to_owned(), words: found.candidates };
            assert!(editor.complete(completion).len() <= craft::MAX_TEXT);
        }
        if let Some(line) = output.line {
            assert!(line.len() <= MAX_LINE && line.bytes().all(|byte| (b' '..=b'~').contains(&byte)));
            let mut context = CliContext { configuration: &mut configuration, facts: &facts };
            editor.answer(&interpreter.run(&line, &mut context).into());
        }
        // A pause now and then lets a `#` open the command line.
        editor.poll(false, now + Duration::from_millis(if at % 4 == 0 { 100 } else { 50 }));
    }
}
