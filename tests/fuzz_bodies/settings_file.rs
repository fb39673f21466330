//! A file of settings: `--settings`, `sitl --config`, a `diff all` of a real craft.

use betadeck::firmware::cli::{
    ApplyReport, CliContext, CliFacts, CliMode, Interpreter, MAX_LINE, advice, apply_lines, provision,
};
use betadeck::firmware::config::{Configuration, correct};

use super::craft;

/// Applies the file in every available way.
pub fn run(data: &[u8]) {
    let text = String::from_utf8_lossy(data);
    let facts = CliFacts::default();
    let mut checked = craft::Checked::default();
    for mode in [CliMode::File, CliMode::Interactive] {
        let mut applied = Configuration::default();
        let mut context = CliContext { configuration: &mut applied, facts: &facts };
        let report = apply_lines(text.lines(), &mut Interpreter::new(mode), &mut context, |line, reply| {
            assert!(reply.text.len() <= craft::MAX_TEXT, "{line}: {} bytes", reply.text.len());
            let _shown = advice(line, reply);
        });
        assert_sensible(&report, &text);
        checked.assert_sound(applied);

        let mut provisioned = Configuration::default();
        let mut context = CliContext { configuration: &mut provisioned, facts: &facts };
        let report = provision(&text, &mut Interpreter::new(mode), &mut context, |_| ());
        assert_sensible(&report, &text);
        if !report.batch_failed {
            let before = provisioned.clone();
            correct(&mut provisioned);
            assert_eq!(provisioned, before, "what is provisioned is ready to be stored");
        }
        checked.assert_sound(provisioned);
    }
}

fn assert_sensible(report: &ApplyReport, text: &str) {
    let lines: Vec<&str> = text.lines().collect();
    assert!(report.failed.len() <= report.commands && report.commands <= lines.len());
    assert!(report.failed.is_sorted_by_key(|failed| failed.number));
    for failed in &report.failed {
        assert!(lines[failed.number - 1].contains(&failed.line) || failed.line == "defaults nosave");
        assert!(failed.line.chars().count() <= MAX_LINE && !failed.reason.is_empty(), "{failed:?}");
    }
}
