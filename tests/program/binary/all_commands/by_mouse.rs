//! Commands by the mouse alone: a click on the status lines opens the palette, the wheel scrolls it, a click chooses.

use betadeck::ui::action::ACTIONS;
use betadeck::ui::command;

use super::walk::Hand;
use crate::binary::pty::Terminal;
use crate::binary::settings::{click, place};

const LEFT: u8 = 0;
const WHEEL_DOWN: u8 = 65;
/// The number of rows of the palette.
const ROWS: usize = 14;
/// The most names that the palette puts in front.
const MAX_USED: usize = 50;
const PALETTE: &str = "Commands — Enter runs";

/// Chooses every command in the palette.
#[derive(Debug, Default)]
pub(super) struct Mouse {
    /// The names chosen before, the newest last. The palette begins with them.
    used: Vec<&'static str>,
}

impl Mouse {
    /// Chooses a row of the palette.
    fn choose(&mut self, terminal: &mut Terminal, name: &'static str) {
        click(terminal, LEFT, (4, 0));
        let prompt = place(terminal, "│> ");
        let actions = ACTIONS.iter().map(|spec| spec.name).filter(|name| *name != "app.palette");
        let others = actions.chain(command::all().map(|command| command.name));
        let others = others.filter(|other| !self.used.contains(other));
        let order: Vec<&str> = self.used.iter().rev().copied().chain(others).collect();
        let at = order.iter().position(|other| *other == name).expect(name);
        let row = prompt.1 + 1 + at.min(ROWS - 1);
        let wheel = format!("\x1b[<{WHEEL_DOWN};{};{}M", prompt.0 + 5, prompt.1 + 3);
        terminal.send(&wheel.repeat(at));
        let shown: String = format!(" {name} ").chars().take(21).collect();
        terminal.until(&format!("{name} in the palette"), |terminal| terminal.row(row).contains(&shown));
        click(terminal, LEFT, (prompt.0 + 5, row));
        terminal.until("no palette", |terminal| !terminal.screen().contains(PALETTE));
        self.used.retain(|used| *used != name);
        self.used.push(name);
        if self.used.len() > MAX_USED {
            self.used.remove(0);
        }
    }
}

impl Hand for Mouse {
    fn act(&mut self, terminal: &mut Terminal, name: &'static str) {
        match name {
            "app.palette" => click(terminal, LEFT, (4, 0)),
            name => self.choose(terminal, name),
        }
    }

    fn close(&mut self, terminal: &mut Terminal, text: Option<&str>) {
        let at = text.map_or((1, 3), |text| place(terminal, text));
        click(terminal, LEFT, (at.0 + 1, at.1));
    }

    fn line(&mut self, terminal: &mut Terminal, name: &'static str) {
        self.choose(terminal, name);
        let line = format!(":{name} ");
        terminal.until("the line", |terminal| terminal.row(59).starts_with(&line));
    }
}
