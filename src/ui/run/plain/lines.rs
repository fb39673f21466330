//! The output: one sentence per line.

use crate::ui::acts::{ghost_path, surveys};
use std::io::{self, Write};

use crate::flight::forecast::ForecastKind;
use crate::text::printable;
use crate::ui::app_state::AppState;
use crate::ui::model::action::{Action, Context, EditAction, spec_of};
use crate::ui::model::effect::Effect;
use crate::ui::model::message::Msg;
use crate::ui::model::panel_table::Panel;
use crate::ui::popup::Popup;
use crate::ui::update::{self, run_line, update};
use crate::ui::{command, prompt, status_bar};

mod help;

/// The output, and the question written last.
#[derive(Debug)]
pub(super) struct Lines<W> {
    output: W,
    asked: Option<Vec<String>>,
    /// `true` while the settings that a line requested are being read.
    reads: bool,
}

impl<W: Write> Lines<W> {
    pub(super) fn new(output: W) -> Self {
        Self { output, asked: None, reads: false }
    }

    pub(super) fn write(&mut self, text: &str) -> io::Result<()> {
        writeln!(self.output, "{}", printable::line(text))?;
        self.output.flush()
    }

    /// Handles a line of input: as the answer to the question if there is one, else as a command. Writes the panel that
    /// it names, and the lines of a panel that it changes.
    pub(super) fn enter(&mut self, state: &mut AppState, line: &str) -> io::Result<Vec<Effect>> {
        if !prompt::is_open(state)
            && let Some(line) = command::for_firmware(&state.shared, line)
        {
            return self.said(state, |state| run_line(state, &format!("cli {line}")));
        }
        if !prompt::is_open(state)
            && let Some(topic) = help::topic(line)
        {
            for line in help::lines(topic) {
                self.write(&line)?;
            }
            return Ok(Vec::new());
        }
        if !prompt::is_open(state) && command::arranges(line) {
            self.write("A layout arranges the panels of the screen, and there is none here.")?;
            return Ok(Vec::new());
        }
        let named = if prompt::is_open(state) { None } else { command::named(&state.shared, line) };
        let panel = named.and_then(panel_of);
        let mut effects = match named.and_then(spec_of).map(|spec| spec.context) {
            // Its short names then mean this panel.
            Some(Context::In(panel)) => update::perform(state, Action::Show(panel)),
            _ => Vec::new(),
        };
        let panel = panel.unwrap_or(state.shared.focus);
        let before = lines_of(state, panel);
        effects.extend(self.carry_out(state, line)?);
        let is_shown = matches!(named, Some(Action::Show(_)));
        if is_shown {
            if panel == Panel::State {
                self.write_status(state)?;
            }
            self.write(&state.panels.of(panel).title(&state.shared))?;
            self.reads = panel == Panel::Settings && state.shared.settings.craft().is_none();
        }
        // The question about an open field shows its text.
        let is_typed = prompt::is_open(state) && !is_shown;
        let after = if is_typed { Vec::new() } else { lines_of(state, panel) };
        for line in after.iter().filter(|line| is_shown || !before.contains(line)) {
            self.write(line)?;
        }
        Ok(effects)
    }

    /// Writes the two lines at the top of the screen.
    fn write_status(&mut self, state: &AppState) -> io::Result<()> {
        status_bar::in_words::lines(&state.shared).iter().try_for_each(|line| self.write(line))
    }

    fn carry_out(&mut self, state: &mut AppState, line: &str) -> io::Result<Vec<Effect>> {
        if !prompt::is_open(state) {
            let effects = self.said(state, |state| run_line(state, line))?;
            return Ok(update::hold(state, effects));
        }
        let answered = self.said(state, |state| prompt::answer(state, line))?;
        if let Some(reported) = answered.reported {
            self.write(&reported)?;
            // The question is not written again.
            self.asked = prompt::question(state);
        }
        Ok(answered.effects)
    }

    /// Writes the refusal, with the names of commands in it.
    fn said<T: Default>(
        &mut self,
        state: &mut AppState,
        act: impl FnOnce(&mut AppState) -> Result<T, String>,
    ) -> io::Result<T> {
        act(state).or_else(|sentence| {
            self.write(&state.shared.keymap.in_force(&sentence))?;
            Ok(T::default())
        })
    }

    /// Passes an answer on, and writes the parts that no notice reports: the firmware's own words, and the end of a
    /// flight ahead.
    pub(super) fn answer(&mut self, state: &mut AppState, msg: Msg) -> io::Result<Vec<Effect>> {
        match msg {
            Msg::CliReply(Some(output)) => {
                for line in output.text.trim_end().lines().chain(output.advice.as_deref()) {
                    self.write(line.trim_end())?;
                }
                let effects = update(state, Msg::CliReply(Some(output)));
                state.shared.notice = None;
                Ok(effects)
            }
            Msg::Forecast(reply) if reply.kind == ForecastKind::LookAhead => {
                let effects = update(state, Msg::Forecast(reply));
                if let Some(ghost) =
                    ghost_path::ghost(&state.shared).filter(|_| state.shared.forecast.looks_ahead())
                {
                    self.write(&ghost.line)?;
                    // Once for each request.
                    state.shared.forecast.dismiss();
                }
                Ok(effects)
            }
            // The list is written once.
            Msg::Flights(list) => {
                update(state, Msg::Flights(list));
                state.shared.flights.rest();
                Ok(Vec::new())
            }
            Msg::Survey(reply) => {
                let is_last = reply.news.is_last();
                let effects = update(state, Msg::Survey(reply));
                if let Some(line) = state.shared.survey.completed_line() {
                    self.write(&line)?;
                }
                if is_last {
                    // Once for each request.
                    surveys::dismiss(&mut state.shared);
                }
                Ok(effects)
            }
            msg => Ok(update(state, msg)),
        }
    }

    /// Writes the newest notice, and the question if it has changed.
    pub(super) fn follow(&mut self, state: &mut AppState) -> io::Result<()> {
        if let Some(notice) = state.shared.notice.take() {
            self.write(&notice.text)?;
        }
        match state.popups.last() {
            Some(Popup::Help(_) | Popup::Palette(_) | Popup::CommandLine) => {
                state.popups.clear();
                for line in help::lines("") {
                    self.write(&line)?;
                }
            }
            Some(Popup::Guards { .. }) => {
                state.popups.clear();
                let guards = state.shared.view.vehicle.nav.iter().flat_map(|nav| &nav.guards);
                for guard in guards.map(|guard| guard.name).collect::<Vec<_>>() {
                    self.write(&format!("{guard}: {}", guard.explanation()))?;
                }
            }
            _ => {}
        }
        if self.reads && state.shared.settings.craft().is_some() {
            self.reads = false;
            for line in lines_of(state, Panel::Settings) {
                self.write(&line)?;
            }
        }
        let asked = prompt::question(state);
        if asked != self.asked {
            for line in asked.iter().flatten() {
                self.write(line)?;
            }
            self.asked = asked;
        }
        Ok(())
    }
}

/// Returns the panel that an action shows or changes.
fn panel_of(action: Action) -> Option<Panel> {
    match (action, spec_of(action)?.context) {
        (Action::Show(panel), _) | (_, Context::In(panel)) => Some(panel),
        (Action::Edit(EditAction::Undo | EditAction::Redo | EditAction::Download), _) => Some(Panel::Plan),
        _ => None,
    }
}

fn lines_of(state: &AppState, panel: Panel) -> Vec<String> {
    state.panels.of(panel).in_words(&state.shared)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::session::SessionView;

    #[test]
    fn every_line_about_layouts_is_answered_by_one_sentence_and_changes_nothing() {
        for line in ["layout flying", "layout", ":layout save mine", "view.layout"] {
            let mut state = AppState::bare((80, 24), SessionView::default());
            let mut lines = Lines::new(Vec::new());
            assert!(lines.enter(&mut state, line).unwrap().is_empty());
            lines.follow(&mut state).unwrap();
            assert_eq!(
                String::from_utf8(lines.output).unwrap(),
                "A layout arranges the panels of the screen, and there is none here.\n",
                "{line}"
            );
            assert_eq!(state.shared.layouts.names().count(), 0);
        }
    }
}
