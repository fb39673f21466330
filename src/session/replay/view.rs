//! The published state of a replay.

use std::sync::Arc;

use super::player::Player;
use crate::session::command::SessionView;
use crate::session::replay_view::ReplayView;
use crate::timeline::TimelineView;

/// Returns the view of a player.
pub(super) fn of(player: &Player, (file, number, count): (&str, usize, usize)) -> SessionView {
    let overview = player.overview();
    let timeline = TimelineView {
        first: overview.first,
        head: overview.last,
        rewound: player.shown() < overview.last,
        cannot_continue: true,
        marks: overview.marks.all(),
        ..TimelineView::default()
    };
    let values = player.values();
    let replay = ReplayView { file: file.into(), number, count, reading: None, overview, values };
    SessionView {
        vehicle: player.picture(),
        paused: !player.is_playing(),
        speed_wanted: player.speed(),
        speed_achieved: player.speed_achieved(),
        timeline: Some(timeline),
        replay: Some(Arc::new(replay)),
        ..SessionView::default()
    }
}

/// Returns the view while a file is read.
pub(super) fn while_reading(file: &str, share: f64, speed: f64) -> SessionView {
    let replay = ReplayView { file: file.into(), reading: Some(share), ..ReplayView::default() };
    SessionView {
        paused: true,
        speed_wanted: speed,
        replay: Some(Arc::new(replay)),
        ..SessionView::default()
    }
}
