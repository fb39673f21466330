//! A walk through one program, step by step.

use super::seen::Seen;
use crate::binary::pty::Terminal;
use crate::binary::support::{PROGRAM, Sandbox};

/// A step of a walk.
#[derive(Debug, Clone, Copy)]
pub(super) enum Step {
    /// An action by its name, which this step proves.
    Act(&'static str, Seen),
    /// An action that another step proves.
    Again(&'static str, Seen),
    /// A command of the `:` line and its value.
    Line(&'static str, &'static str, Seen),
    /// Leaves a popup: by Esc, or by a click on a text, or outside of it if there is no such text.
    Close(Option<&'static str>, Seen),
    /// Typed text.
    Type(&'static str, Seen),
    /// Waits for the craft.
    Wait(&'static str),
}

/// A program and the steps through it.
#[derive(Debug)]
pub(super) struct Group {
    pub(super) name: &'static str,
    pub(super) steps: &'static [Step],
}

/// How commands are given: by keys or by the mouse.
pub(super) trait Hand {
    /// Gives an action by its name.
    fn act(&mut self, terminal: &mut Terminal, name: &'static str);
    /// Closes a popup.
    fn close(&mut self, terminal: &mut Terminal, text: Option<&str>);
    /// Opens the `:` line with a command.
    fn line(&mut self, terminal: &mut Terminal, name: &'static str);
}

/// A plan whose first leg takes ten minutes, so that no step depends on the speed of the machine.
const PLAN: &str = r#"
name = "slow"

[[waypoint]]
type = "FLYOVER"
lat_deg = 40.4680000
lon_deg = -79.5182000
alt_m = 50
speed_mps = 1

[[waypoint]]
type = "LAND"
lat_deg = 40.4635000
lon_deg = -79.5182000
alt_m = 0
"#;

/// Starts a program and makes the steps of a group.
pub(super) fn walk(group: &Group, size: (u16, u16), hand: &mut dyn Hand) {
    let sandbox = Sandbox::new();
    sandbox.write("slow.toml", PLAN);
    let plan = sandbox.path("slow.toml").display().to_string();
    let arguments: &[&str] = if matches!(group.name, "flight" | "time") { &[&plan] } else { &[] };
    let arguments = [&["--fresh", "--no-ports"], arguments].concat();
    let mut terminal = Terminal::start_in(sandbox, size.0, size.1, PROGRAM, &arguments);
    terminal.until("a screen", |terminal| {
        terminal.row(0).contains("DISARMED") && terminal.row(usize::from(size.1) - 1).contains("q quit")
    });
    for step in group.steps {
        let label = format!("{} at {}x{}: {step:?}", group.name, size.0, size.1);
        take(&mut terminal, step, &label, hand);
    }
}

fn take(terminal: &mut Terminal, step: &Step, label: &str, hand: &mut dyn Hand) {
    let seen = match *step {
        Step::Wait(text) => return terminal.until(label, |terminal| terminal.screen().contains(text)),
        Step::Act(_, seen) | Step::Again(_, seen) | Step::Line(_, _, seen) => seen,
        Step::Close(_, seen) | Step::Type(_, seen) => seen,
    };
    let before = seen.before(terminal, label);
    match *step {
        Step::Act(name, _) | Step::Again(name, _) => hand.act(terminal, name),
        Step::Line(name, value, _) => {
            hand.line(terminal, name);
            terminal.send(&format!("{value}\r"));
            terminal.until(label, |terminal| !terminal.screen().contains("Enter runs  Tab completes"));
        }
        Step::Close(text, _) => hand.close(terminal, text),
        Step::Type(text, _) => terminal.send(text),
        Step::Wait(_) => {}
    }
    terminal.until(label, |terminal| seen.is_seen(terminal, &before));
}
