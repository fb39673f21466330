//! Command lines that are applied at boot as if typed.

use crate::firmware::cli::{CliContext, CliFacts, CliMode, CliReply, Interpreter, advice, apply_lines};
use crate::firmware::config::Configuration;
use crate::firmware::settings;
use crate::plan::format::{PlanError, Problems, SettingPart};
use crate::telemetry::FirmwareNotice;

/// Command lines and where they come from.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct BootLines {
    /// The file or option, for messages.
    pub source: String,
    /// The lines.
    pub text: String,
}

impl BootLines {
    /// A `set` line for each `name = value`.
    pub fn settings(source: impl Into<String>, settings: &[String]) -> Self {
        let text = settings.iter().map(|setting| format!("set {setting}\n")).collect();
        Self { source: source.into(), text }
    }

    /// Carries out the lines; returns what the pilot should read about them, or those that the firmware refuses with their
    /// places.
    pub(super) fn apply(
        &self,
        configuration: &mut Configuration,
    ) -> Result<Vec<FirmwareNotice>, Vec<PlanError>> {
        let facts = CliFacts::default();
        let mut context = CliContext { configuration, facts: &facts };
        let mut interpreter = Interpreter::new(CliMode::File);
        let mut reasons = Vec::new();
        let mut notices = Vec::new();
        let report = apply_lines(self.text.lines(), &mut interpreter, &mut context, |line, reply| {
            notices.extend(&reply.notices);
            if reply.failed {
                reasons.push(refusal(line, reply));
            }
        });
        let mut problems = Problems::new(&self.source, &self.text);
        for (failed, (span, message, hint)) in std::iter::zip(&report.failed, reasons) {
            problems.add_line_part(failed.number, span, message, hint);
        }
        if problems.is_empty() { Ok(notices) } else { Err(problems.into_errors()) }
    }
}

/// The part of a refused line that is wrong, what is wrong with it, and what is allowed.
fn refusal(line: &str, reply: &CliReply) -> (String, String, String) {
    let setting =
        line.split_once(' ').filter(|(word, _)| word.eq_ignore_ascii_case("set")).map(|(_, rest)| rest);
    if let Some((name, value)) = setting.and_then(|rest| rest.split_once('='))
        && let Err(fault) = settings::judge(name.trim(), value.trim())
    {
        let part = if fault.part == SettingPart::Name { name } else { value };
        return (part.trim().to_owned(), fault.message, fault.hint);
    }
    let mut said = reply.text.lines().filter(|line| !line.is_empty());
    let message = said.next().unwrap_or("refused").trim_matches('#').to_owned();
    let hint = said.map(str::to_owned).chain(advice(line, reply)).collect::<Vec<_>>().join(" ");
    (line.to_owned(), message, hint)
}
