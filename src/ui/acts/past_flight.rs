//! The recorded flight on the screen: its track and its graphs, all at once.

use std::sync::Arc;

use crate::ui::model::track::{Track, TrackPoint};
use crate::ui::shared::Shared;

/// Shows the recorded flight of the newest view, unless it is shown already.
pub(in crate::ui) fn follow(state: &mut Shared) {
    let Some(overview) = state.view.replay.as_ref().map(|replay| Arc::clone(&replay.overview)) else {
        return;
    };
    if state.past.as_ref().is_some_and(|past| Arc::ptr_eq(past, &overview)) {
        return;
    }
    state.track = Track::from_past(overview.pictures.iter().filter_map(TrackPoint::of));
    state.graphs.load(&overview);
    state.past = Some(overview);
}

/// Returns the reason why the map shows no track of a recorded flight.
pub(in crate::ui) fn without_track(state: &Shared) -> Option<&'static str> {
    let replay = state.view.replay.as_ref()?;
    if replay.reading.is_some() && replay.overview.pictures.is_empty() {
        return Some("Reading the file…");
    }
    state.track.points().is_empty().then_some("No GPS in this flight: no track.")
}

/// Returns a word or two about the file and the flight of a replay, for the status line.
pub(in crate::ui) fn label(state: &Shared) -> Option<String> {
    let replay = state.view.replay.as_ref()?;
    if let Some(share) = replay.reading {
        return Some(format!("READING {:.0} %", share * 100.0));
    }
    Some(match replay.count {
        0 | 1 => "REPLAY".to_owned(),
        count => format!("REPLAY {}/{count}", replay.number + 1),
    })
}
