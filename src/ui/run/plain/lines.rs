//! The output: one sentence per line.

use std::io::{self, Write};

use crate::flight::forecast::ForecastKind;
use crate::text::printable;
use crate::ui::action::{ACTIONS, Context};
use crate::ui::app_state::AppState;
use crate::ui::message::{Effect, Msg};
use crate::ui::popup::Popup;
use crate::ui::update::{self, run_line, update};
use crate::ui::{command, forecast, prompt};

/// The output, and the question written last.
#[derive(Debug)]
pub(super) struct Lines<W> {
    output: W,
    asked: Option<Vec<String>>,
}

impl<W: Write> Lines<W> {
    pub(super) fn new(output: W) -> Self {
        Self { output, asked: None }
    }

    pub(super) fn write(&mut self, text: &str) -> io::Result<()> {
        writeln!(self.output, "{}", printable::line(text))?;
        self.output.flush()
    }

    /// Handles a line of input: as the answer to the question if there is one, else as a command.
    pub(super) fn enter(&mut self, state: &mut AppState, line: &str) -> io::Result<Vec<Effect>> {
        let is_asked = state.shared.editor.popup.is_some() || !state.popups.is_empty();
        if !is_asked {
            let effects = self.said(run_line(state, line))?;
            return Ok(update::hold(state, effects));
        }
        let answered = self.said(prompt::answer(state, line))?;
        if let Some(reported) = answered.reported {
            self.write(&reported)?;
            // The question is not written again.
            self.asked = prompt::question(state);
        }
        Ok(answered.effects)
    }

    fn said<T: Default>(&mut self, result: Result<T, String>) -> io::Result<T> {
        result.or_else(|sentence| {
            self.write(&sentence)?;
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
                    forecast::ghost(&state.shared).filter(|_| state.shared.forecast.looks_ahead())
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
                self.list_commands()?;
            }
            Some(Popup::Guards { .. }) => {
                state.popups.clear();
                let guards = state.shared.view.vehicle.nav.iter().flat_map(|nav| &nav.guards);
                for guard in guards.map(|guard| guard.name).collect::<Vec<_>>() {
                    self.write(&format!("{guard}: {}", guard.explanation()))?;
                }
            }
            Some(Popup::Plots { .. }) => {
                state.popups.clear();
                self.write("Graphs are drawn on the screen: start without --plain.")?;
            }
            _ => {}
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

    fn list_commands(&mut self) -> io::Result<()> {
        for command in command::all() {
            self.write(&format!("{} {} — {}", command.name, command.argument, command.help))?;
        }
        for spec in ACTIONS.iter().filter(|spec| spec.context == Context::Global) {
            self.write(&format!("{} — {}", spec.name, spec.help))?;
        }
        Ok(())
    }
}
