//! The library of recorded flights: reads it, deletes from it, and shows a flight on this terminal.
#![allow(clippy::disallowed_methods, reason = "the shell of the user interface waits in wall-clock time")]

use std::io::Write as _;
use std::path::PathBuf;
use std::process::Stdio;
use std::sync::Arc;
use std::time::Duration;

use tokio::time::sleep;

use super::SessionLink;
use super::effects::Answers;
use crate::ui::model::flights::FlightShelf;
use crate::ui::model::message::Msg;

/// The reason for which there is no library.
pub(super) const NO_LIBRARY: &str = "This screen has no library of flights: it has no state directory.";

/// The end of a program that shows flights.
pub(super) enum Shown {
    /// The user left it. The error is a sentence.
    Left(Result<(), String>),
    /// A signal ended this program.
    Stopped,
}

/// Reads the list after a while.
pub(super) fn list(shelf: Option<Arc<dyn FlightShelf>>, after: Duration, answers: Answers) {
    let Some(shelf) = shelf else {
        answers.send(Msg::Flights(Err(NO_LIBRARY.to_owned())));
        return;
    };
    tokio::spawn(async move {
        sleep(after).await;
        // A disk may be slow.
        tokio::task::spawn_blocking(move || answers.send(Msg::Flights(shelf.list())));
    });
}

/// Deletes a flight.
pub(super) fn delete(shelf: Option<Arc<dyn FlightShelf>>, file: PathBuf, answers: Answers) {
    let Some(shelf) = shelf else { return };
    tokio::task::spawn_blocking(move || {
        let result = shelf.delete(&file);
        answers.send(Msg::FlightDeleted { file, result });
    });
}

/// Shows flights by a program of their own, which has the terminal until the user leaves it. The flight of this program goes
/// on.
pub(super) async fn show(
    shelf: Option<&Arc<dyn FlightShelf>>,
    files: &[PathBuf],
    again: bool,
    stop: impl Future<Output = ()>,
) -> Shown {
    let Some(shelf) = shelf else { return Shown::Left(Err(NO_LIBRARY.to_owned())) };
    let mut command = shelf.show(files, again);
    if again {
        let mut out = std::io::stdout();
        writeln!(out, "The recorded flight is flown again first.").and_then(|()| out.flush()).ok();
    }
    let child = match command.stderr(Stdio::piped()).spawn() {
        Ok(child) => child,
        Err(error) => return Shown::Left(Err(format!("The flight cannot be shown: {error}."))),
    };
    let id = rustix::process::Pid::from_child(&child);
    let end = tokio::task::spawn_blocking(move || child.wait_with_output());
    let mut end = std::pin::pin!(end);
    let ended = tokio::select! {
        ended = &mut end => ended,
        () = stop => {
            rustix::process::kill_process(id, rustix::process::Signal::TERM).ok();
            end.await.ok();
            return Shown::Stopped;
        }
    };
    let Ok(Ok(output)) = ended else { return Shown::Left(Ok(())) };
    if output.status.success() {
        return Shown::Left(Ok(()));
    }
    // Its last words are the reason.
    let said = String::from_utf8_lossy(&output.stderr);
    let last = said.lines().rfind(|line| !line.trim().is_empty()).map(str::trim);
    Shown::Left(last.map_or(Ok(()), |reason| Err(reason.to_owned())))
}

/// Returns a sentence with the command that shows flights.
pub(super) fn command(link: &SessionLink, files: &[PathBuf], again: bool) -> String {
    let Some(shelf) = &link.shelf else { return NO_LIBRARY.to_owned() };
    let words = shelf.show(files, again);
    let words: Vec<_> = words.get_args().map(|word| word.to_string_lossy().into_owned()).collect();
    format!("On a screen: betadeck {}", words.join(" "))
}
