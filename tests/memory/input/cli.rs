//! Random input to the command line, the line editor and the stored image. It causes no panic, no endless
//! loop, and no reply or memory use out of proportion.

use std::time::Duration;

use crate::meter::measured;
use betadeck::firmware::cli::{COMMANDS, CliContext, CliFacts, CliMode, Interpreter, complete, hint};
use betadeck::firmware::config::{Configuration, correct};
use betadeck::firmware::settings::SETTINGS;
use betadeck::firmware::storage::{decode, encode};
use betadeck::link::proto::command_line::Completion;
use betadeck::link::proto::line_editor::LineEditor;
use proptest::prelude::*;

/// The longest allowed reply and the most memory that a line may take.
const MIB: usize = 1 << 20;

/// Runs lines in every mode, with completion and hints for each.
fn run_lines(lines: &[&str]) {
    for mode in [CliMode::Interactive, CliMode::Framed, CliMode::Message, CliMode::File] {
        let mut configuration = Configuration::default();
        let mut interpreter = Interpreter::new(mode);
        let facts = CliFacts::default();
        for line in lines {
            let mut context = CliContext { configuration: &mut configuration, facts: &facts };
            let (reply, taken) = measured(|| interpreter.run(line, &mut context));
            assert!(reply.text.len() <= MIB, "{line}: {} bytes", reply.text.len());
            assert!(taken.total <= MIB, "{line}: {taken:?}");
            let (completion, taken) = measured(|| complete(line));
            assert!(completion.start <= line.len());
            assert!(taken.total <= MIB, "{line}: {taken:?}");
            let _shown = hint(line, Some(&configuration.settings));
        }
        correct(&mut configuration);
        let (stored, findings) = decode(&encode(&configuration)).expect("a good image");
        assert_eq!((stored, findings), (configuration, Vec::new()));
    }
}

/// Feeds bytes to a link that is connected to a craft.
fn feed_editor(bytes: &[u8]) {
    let mut configuration = Configuration::default();
    let mut interpreter = Interpreter::default();
    let mut editor = LineEditor::default();
    let facts = CliFacts::default();
    for (at, byte) in bytes.iter().enumerate() {
        let now = Duration::from_millis(at as u64 * 60);
        let output = editor.feed(*byte, at % 7 == 3, now);
        assert!(output.bytes.len() <= MIB);
        if output.completes {
            let found = complete(editor.line());
            let completion =
                Completion { tail: found.tail(editor.line()).to_owned(), words: found.candidates };
            assert!(editor.complete(completion).len() <= MIB);
        }
        if let Some(line) = output.line {
            assert!(line.len() <= 255);
            let mut context = CliContext { configuration: &mut configuration, facts: &facts };
            editor.answer(&interpreter.run(&line, &mut context).into());
        }
        editor.poll(at % 5 == 0, now + Duration::from_millis(at as u64 % 200));
    }
}

/// Generates a word that some command may understand.
fn word() -> impl Strategy<Value = String> {
    prop_oneof![
        3 => prop::sample::select(COMMANDS.iter().map(|command| command.name).collect::<Vec<_>>()).prop_map(str::to_owned),
        3 => prop::sample::select(SETTINGS.iter().map(|setting| setting.name).collect::<Vec<_>>()).prop_map(str::to_owned),
        3 => prop::sample::select(vec!["=", "*", "insert", "update", "remove", "clear", "list", "status", "start", "end",
            "all", "bare", "defaults", "nosave", "noreboot", "reset", "load", "ON", "OFF", "NONE", "UART1", "UART9", "a",
            "h", "s", "HOLD", "ORBIT", "flyby", "group_id", "resource", "beeper", "dshot_bidir", "osd_vbat_pos", "-GPS",
            "AETR1234", "quadx", "#", "-"]).prop_map(str::to_owned),
        3 => any::<i16>().prop_map(|number| number.to_string()),
        1 => any::<i64>().prop_map(|number| number.to_string()),
        1 => any::<f64>().prop_map(|number| number.to_string()),
        1 => "[-+]?[0-9]{0,3}\\.?[0-9]{0,9}",
        1 => "\\PC{0,12}",
    ]
}

fn line() -> impl Strategy<Value = String> {
    prop_oneof![
        8 => prop::collection::vec(word(), 0..10).prop_map(|words| words.join(" ")),
        1 => (word(), word()).prop_map(|(name, value)| format!("set {name} = {value}")),
        1 => any::<String>(),
    ]
}

proptest! {
    // 500 runs of 50 lines in four modes: 100 000 lines.
    #![proptest_config(ProptestConfig { cases: 200, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn random_lines(lines in prop::collection::vec(line(), 50)) {
        run_lines(&lines.iter().map(String::as_str).collect::<Vec<_>>());
    }

    #[test]
    fn random_bytes_on_a_link(bytes in prop::collection::vec(any::<u8>(), 0..400)) {
        feed_editor(&bytes);
    }

    #[test]
    fn random_damage_to_an_image(at in any::<prop::sample::Index>(), change in 1..=255_u8, end in any::<prop::sample::Index>()) {
        let mut image = encode(&Configuration::default());
        let place = at.index(image.len());
        image[place] ^= change;
        prop_assert!(decode(&image).is_err(), "a change at {} went unnoticed", place);
        image[place] ^= change;
        image.truncate(end.index(image.len()));
        prop_assert!(decode(&image).is_err());
    }
}
