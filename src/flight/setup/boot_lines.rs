//! Command lines that are applied at boot as if they were typed.

use super::{OF_PROFILE, replacement};
use crate::firmware::cli::{
    COMMANDS, CliContext, CliFacts, CliMode, CliReply, Interpreter, advice, apply_lines,
};
use crate::firmware::config::Configuration;
use crate::firmware::settings;
use crate::plan::format::{PlanError, Problems, SettingPart};
use crate::telemetry::FirmwareNotice;
use crate::text::did_you_mean;

/// The replacement for a line that is not a command.
const NOT_SHOWN: &str = "(not shown: this is no command)";

/// Command lines with their source.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct BootLines {
    /// File or option, for messages.
    pub source: String,
    /// The lines.
    pub text: String,
}

impl BootLines {
    /// Returns a `set` line for each `name = value`.
    pub fn settings(source: impl Into<String>, settings: &[String]) -> Self {
        let text = settings.iter().map(|setting| format!("set {setting}\n")).collect();
        Self { source: source.into(), text }
    }

    /// Returns the names of the settings that the lines set.
    pub fn setting_names(&self) -> impl Iterator<Item = &str> {
        self.text.lines().filter_map(|line| {
            let (word, rest) = line.trim().split_once(' ')?;
            let (name, _) = rest.split_once('=')?;
            word.eq_ignore_ascii_case("set").then(|| name.trim())
        })
    }

    /// Returns `true` if they choose the profile of the embedded firmware, which no other firmware has.
    pub fn choose_profile(&self) -> bool {
        self.source == OF_PROFILE
    }

    /// Replaces the settings of the guide with which master does not fly as expected.
    pub(super) fn replace_settings(&mut self) {
        let lines = self.text.lines().map(|line| {
            let setting = line.strip_prefix("set ").and_then(replacement);
            setting.map_or_else(|| line.to_owned(), |setting| format!("set {setting}"))
        });
        self.text = lines.map(|line| line + "\n").collect();
    }

    /// Applies the lines. Returns the notices for the pilot, or the lines that the firmware refuses with their
    /// places.
    pub(super) fn apply(
        &self,
        configuration: &mut Configuration,
        site_alt_m: f64,
    ) -> Result<Vec<FirmwareNotice>, Vec<PlanError>> {
        let facts = CliFacts { site_alt_m, ..CliFacts::default() };
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
        // The file may contain secrets instead of settings.
        let mut lines: Vec<&str> = self.text.lines().collect();
        for (failed, reason) in std::iter::zip(&report.failed, &mut reasons) {
            if let Some(line) =
                lines.get_mut(failed.number.saturating_sub(1)).filter(|line| !is_command(line))
            {
                *line = NOT_SHOWN;
                NOT_SHOWN.clone_into(&mut reason.0);
            }
        }
        let text = lines.join("\n");
        let mut problems = Problems::new(&self.source, &text);
        for (failed, (span, message, hint)) in std::iter::zip(&report.failed, reasons) {
            problems.add_line_part(failed.number, span, message, hint);
        }
        if problems.is_empty() { Ok(notices) } else { Err(problems.into_errors()) }
    }
}

/// Returns `true` if a line begins with the name of a command, or with a similar word.
fn is_command(line: &str) -> bool {
    let word = line.split_whitespace().next().unwrap_or_default();
    let mut names = COMMANDS.iter().map(|command| command.name);
    names.clone().any(|name| name.eq_ignore_ascii_case(word))
        || did_you_mean::closest(word, &mut names).is_some()
}

/// Returns the wrong part of a refused line, the problem, and the permitted values.
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
