//! Keys in, screen out: the ground of elevation tiles under the plan and the craft.

use std::sync::Arc;

use betadeck::plan::Altitude;
use betadeck::telemetry::NavState;
use betadeck::terrain::{Grid, Samples, Square, Tiles};
use betadeck::ui::files::FileReply;
use betadeck::ui::{AppState, Msg, update};

use crate::ui::fixture;
use crate::ui::fixture::SimpleFlight;
use crate::ui::hands::{keys, screen, state_with_fix};

const SIDE: usize = 1201;

/// Returns ground at 300 m above sea level with a ridge of 60 m under WP2 and WP3 of the square, west of home.
fn ridge() -> Arc<Tiles> {
    let mut metres = vec![300_i16; SIDE * SIDE];
    for row in metres.chunks_mut(SIDE) {
        row[577] += 60;
    }
    let step_deg = 1.0 / 1200.0;
    let grid = Grid {
        rows: SIDE,
        cols: SIDE,
        north_deg: 41.0,
        west_deg: -80.0,
        lat_step_deg: step_deg,
        lon_step_deg: step_deg,
        samples: Samples::Metres(metres),
    };
    let mut tiles = Tiles::default();
    tiles.insert(Square { lat_deg: 40, lon_deg: -80 }, grid);
    Arc::new(tiles)
}

fn read(state: &mut AppState, problems: &[&str]) {
    state.shared.ground.clearance_m = 15.0;
    let problems = problems.iter().map(|problem| (*problem).to_owned()).collect();
    update(state, Msg::Files(FileReply::Ground { tiles: Some(ridge()), problems }));
}

#[test]
fn a_low_leg_is_reported_and_one_key_raises_it() {
    let mut state = state_with_fix((120, 40));
    keys(&mut state, "2 z");
    assert!(!screen(&state).contains("▒▒ ground"), "{}", screen(&state));
    read(&mut state, &[]);
    keys(&mut state, "down down");
    let seen = screen(&state);
    assert!(seen.contains("the leg to waypoint 2 is 2 m above the ground"), "{seen}");
    assert!(seen.contains("▒▒ ground"), "{seen}");
    for _ in 0..6 {
        if screen(&state).contains("above the ground") {
            keys(&mut state, "f");
        }
    }
    let seen = screen(&state);
    assert!(!seen.contains("above the ground"), "{seen}");
    let altitudes: Vec<_> = state.shared.plan().waypoints.iter().map(|wp| wp.altitude).collect();
    assert!(
        altitudes[2] >= Altitude::above_home(63.0) && altitudes[3] >= Altitude::above_home(63.0),
        "{altitudes:?}"
    );
}

#[test]
fn the_status_line_shows_the_height_above_the_ground() {
    let mut state = state_with_fix((160, 40));
    let flight = |e| SimpleFlight {
        time_s: 60.0,
        alt: 50.0,
        e,
        armed: true,
        fix: true,
        state: NavState::Approaching,
        wp: 2,
        ..SimpleFlight::default()
    };
    update(&mut state, Msg::View(fixture::view(&flight(59.0))));
    assert!(!screen(&state).contains("agl"));
    read(&mut state, &["No elevation tile N40W079.hgt."]);
    let seen = screen(&state);
    assert!(seen.contains("agl  50.0 m") && seen.contains("No elevation tile N40W079.hgt."), "{seen}");
    update(&mut state, Msg::View(fixture::view(&flight(-82.0))));
    let seen = screen(&state);
    assert!(seen.contains("agl -10.0 m") || seen.contains("agl  -9."), "on the crest of the ridge: {seen}");
}
