//! The backdrop of the map, its zones, the grid of coordinates, the measure tool, and the arrows at the edge.

use betadeck::flight::forecast::{FlightResult, Forecast, ForecastEnd, ForecastKind, LegTime, PathPoint};
use betadeck::geo::{GroundPlane, LatLon};
use betadeck::lookahead::ForecastReply;
use betadeck::plan::feature::{Feature, Shape, Vertex, Zone};
use betadeck::ui::backdrop::BackdropLayer;
use betadeck::ui::files::{Entry, FileReply, FileRequest, Listing};
use betadeck::ui::{AppState, Effect, MapMode, Msg, run_line, update};
use crossterm::event::MouseEventKind;
use nalgebra::Vector2;

use crate::ui::fixture::{self, HOME};
use crate::ui::hands::{keys, mouse, mouse_button, place_of, screen, state_with_fix};

const SIZES: [(u16, u16); 4] = [(60, 20), (80, 24), (120, 40), (200, 60)];

fn at(n: f64, e: f64) -> LatLon {
    GroundPlane::new(HOME).to_position(Vector2::new(n, e))
}

fn vertices(places: &[(f64, f64)]) -> Vec<Vertex> {
    places.iter().map(|&(n, e)| Vertex { position: at(n, e), altitude_m: f32::NAN }).collect()
}

fn feature(name: &str, shape: Shape, zone: Option<Zone>) -> Feature {
    Feature { name: name.to_owned(), shape, zone }
}

/// Returns a road, a field, a mast and a no-fly zone that the leg to waypoint 2 crosses.
fn farm() -> Vec<Feature> {
    let field = vertices(&[(-90.0, -110.0), (95.0, -110.0), (95.0, 110.0), (-90.0, 100.0)]);
    let road = vertices(&[(20.0, -400.0), (5.0, -40.0), (-15.0, 30.0), (10.0, 400.0)]);
    let mast = Vertex { position: at(30.0, -20.0), altitude_m: f32::NAN };
    let stable = vertices(&[(-80.0, -40.0), (-30.0, -40.0), (-30.0, 10.0), (-80.0, 10.0)]);
    vec![
        feature("Long field", Shape::Area(vec![field]), None),
        feature("Mill Road", Shape::Line(road), None),
        feature("mast", Shape::Point(mast), None),
        feature("stable", Shape::Area(vec![stable]), Some(Zone::Exclusion)),
    ]
}

fn show(state: &mut AppState, path: &str, features: Vec<Feature>) {
    let id = state.shared.editor.plan().id();
    let layer = BackdropLayer::new(path.into(), features);
    update(state, Msg::Files(FileReply::Backdrop { id, layer, is_new: true }));
}

fn on_the_farm(size: (u16, u16)) -> AppState {
    let mut state = state_with_fix(size);
    show(&mut state, "/maps/farm.geojson", farm());
    state
}

#[test]
fn a_backdrop_is_under_plan_and_track() {
    let seen = SIZES.map(|size| {
        let mut state = on_the_farm(size);
        assert!(screen(&state).contains("farm.geojson is under the plan: 13 vertices."));
        keys(&mut state, "1 z");
        screen(&state)
    });
    insta::assert_snapshot!("backdrop_at_four_sizes", seen.join("\n"));
}

#[test]
fn a_backdrop_in_seven_bits() {
    let mut state = on_the_farm((80, 24));
    state.shared.theme = fixture::plain();
    keys(&mut state, "1 z");
    let seen = screen(&state);
    assert!(seen.is_ascii(), "{seen}");
    assert!(seen.contains("Mill Road") || seen.contains("mast"), "{seen}");
}

#[test]
fn zones_are_findings_of_the_plan() {
    let mut state = on_the_farm((120, 40));
    keys(&mut state, "2 z");
    let seen = screen(&state);
    assert!(seen.contains("the leg to waypoint 2 crosses the no-fly zone stable"), "{seen}");
    let field = vertices(&[(-300.0, -300.0), (300.0, -300.0), (300.0, 20.0), (-300.0, 20.0)]);
    show(&mut state, "/maps/fence.kml", vec![feature("", Shape::Area(vec![field]), Some(Zone::Inclusion))]);
    keys(&mut state, "up up up");
    let seen = screen(&state);
    assert!(
        seen.contains("waypoint 0 is outside the zone that the flight must not leave"),
        "the finding about the waypoint under the cursor is shown\n{seen}"
    );
    keys(&mut state, "f");
    assert!(screen(&state).contains("No edit fixes this"));
    let effects = run_line(&mut state, "backdrop off").expect("a backdrop");
    assert!(matches!(effects[..], [Effect::Files(FileRequest::NoBackdrop(_))]), "{effects:?}");
    keys(&mut state, "down up");
    assert!(!screen(&state).contains("no-fly"), "the findings went with it");
}

#[test]
fn the_flown_estimate_is_judged_by_the_zones() {
    let mut state = fixture::state((120, 40), fixture::colour());
    let standing = fixture::SimpleFlight { time_s: 8.0, fix: true, ..fixture::SimpleFlight::default() };
    let effects = update(&mut state, Msg::View(fixture::view(&standing)));
    let revision = effects.iter().find_map(|effect| match effect {
        Effect::Forecast(job) => Some(job.revision),
        _ => None,
    });
    let path = (0..40).map(|step| {
        let n = f64::from(step) * 2.0;
        PathPoint { n, e: 0.0, alt: 20.0, along_m: n, time_s: n }
    });
    let forecast = Forecast {
        kind: ForecastKind::PlanEstimate,
        end: ForecastEnd::Flight(FlightResult::Complete),
        reason: "flown".to_owned(),
        time_s: 80.0,
        battery_used_pct: 20.0,
        worst_xte: None,
        fence_margin_m: None,
        legs: vec![LegTime { wp: 1, time_s: 40.0, battery_used_pct: 12.4 }],
        moved_m: 0.0,
        path: path.collect(),
        unchanged: None,
    };
    let reply = ForecastReply {
        revision: revision.expect("an estimate"),
        kind: ForecastKind::PlanEstimate,
        forecast: Ok(Box::new(forecast)),
    };
    update(&mut state, Msg::Forecast(reply));
    let island = vertices(&[(30.0, -5.0), (34.0, -5.0), (34.0, 5.0), (30.0, 5.0)]);
    show(
        &mut state,
        "/maps/zone.kml",
        vec![feature("Nest", Shape::Area(vec![island]), Some(Zone::Exclusion))],
    );
    keys(&mut state, "2 z down down");
    let seen = screen(&state);
    assert!(seen.contains("the flown estimate enters the no-fly zone Nest after 30 m"), "{seen}");
    let row = seen.lines().find(|line| line.contains("FLYBY")).expect("waypoint 1");
    assert!(row.contains("0:39") && row.contains("12 %"), "{row}");
}

#[test]
fn b_lists_maps_and_shows_the_chosen_one() {
    let mut state = state_with_fix((80, 24));
    let effects = keys(&mut state, "1 B");
    assert!(
        effects.iter().any(|effect| matches!(effect, Effect::Files(FileRequest::List(_)))),
        "{effects:?}"
    );
    let entry = |name: &str, is_directory| Entry { name: name.to_owned(), is_directory };
    let entries = vec![entry("old", true), entry("farm.geojson", false), entry("square.toml", false)];
    update(&mut state, Msg::Files(FileReply::Listed(Listing { directory: "/maps".into(), entries })));
    let seen = screen(&state);
    assert!(
        seen.contains("farm.geojson") && !seen.contains("square.toml") && seen.contains("Show a file"),
        "{seen}"
    );
    let effects = keys(&mut state, "'farm enter");
    let is_farm = |effect: &Effect| matches!(effect, Effect::Files(FileRequest::Backdrop(_, path)) if path.ends_with("maps/farm.geojson"));
    assert!(effects.iter().any(is_farm), "{effects:?}");
    let effects = run_line(&mut state, "backdrop /maps/zones.kmz").expect("a path");
    assert!(
        matches!(&effects[..], [Effect::Files(FileRequest::Backdrop(_, path))] if path.ends_with("zones.kmz"))
    );
}

#[test]
fn the_grid_has_round_coordinates() {
    let seen = SIZES.map(|size| {
        let mut state = state_with_fix(size);
        keys(&mut state, "1 z #");
        screen(&state)
    });
    insta::assert_snapshot!("grid_at_four_sizes", seen.join("\n"));
    let mut state = state_with_fix((120, 40));
    let before = screen(&state);
    keys(&mut state, "1 # #");
    assert_eq!(screen(&state), before);
}

#[test]
fn two_points_give_distance_and_bearing() {
    let mut state = state_with_fix((120, 40));
    keys(&mut state, "1 z m");
    assert!(screen(&state).contains("measure · Enter sets the first point"), "{}", screen(&state));
    keys(&mut state, "enter right right right right right right right right right right");
    let seen = screen(&state);
    assert!(seen.contains("090°"), "the line follows the cursor\n{seen}");
    keys(&mut state, "enter up up up");
    let set = screen(&state);
    assert!(set.contains("090°"), "the second point stays\n{set}");
    insta::assert_snapshot!("measure_120x40", set);
    keys(&mut state, "enter");
    assert!(screen(&state).contains("measure · 0.0 m"), "a new line begins");
    keys(&mut state, "esc");
    assert!(!screen(&state).contains("measure ·"));
}

#[test]
fn the_mouse_measures_by_clicks_and_by_a_drag() {
    let mut state = state_with_fix((120, 40));
    keys(&mut state, "1 z m");
    mouse(&mut state, MouseEventKind::Down, (30, 20));
    mouse(&mut state, MouseEventKind::Up, (30, 20));
    mouse(&mut state, MouseEventKind::Down, (30, 10));
    mouse(&mut state, MouseEventKind::Up, (30, 10));
    let seen = screen(&state);
    assert!(seen.contains("000°"), "{seen}");
    mouse(&mut state, MouseEventKind::Down, (40, 20));
    mouse(&mut state, MouseEventKind::Drag, (45, 20));
    mouse(&mut state, MouseEventKind::Drag, (60, 20));
    mouse(&mut state, MouseEventKind::Up, (60, 20));
    let seen = screen(&state);
    assert!(seen.contains("090°"), "{seen}");
    assert_eq!(state.shared.editor.plan().history().at(), 0, "nothing of the plan was moved");
    keys(&mut state, "m");
    mouse_button(&mut state, MouseEventKind::Down(crossterm::event::MouseButton::Right), (30, 30));
    keys(&mut state, "m right");
    assert!(screen(&state).contains("measure ·"), "{}", screen(&state));
}

#[test]
fn arrows_at_the_edge_lead_to_craft_and_home() {
    let mut state = state_with_fix((80, 24));
    state.shared.map.mode = MapMode::Free { n: 900.0, e: 0.0, scale: 1.0 };
    keys(&mut state, "1 z");
    let seen = screen(&state);
    assert!(seen.contains("craft 900 m") && seen.contains("home 900 m"), "{seen}");
    assert!(seen.contains("craft 900 m↓↓home 900 m"), "neither arrow hides the other\n{seen}");
    assert_eq!(place_of(&state, "↓").1, 20, "above the line with the scale\n{seen}");
    state.shared.map.mode = MapMode::Free { n: 0.0, e: -5000.0, scale: 1.0 };
    let seen = screen(&state);
    assert!(seen.contains("→") && seen.contains("5000 m"), "{seen}");
}

#[test]
fn the_generator_shows_its_result_on_the_map_beside_its_form() {
    let seen = SIZES.map(|size| {
        let mut state = state_with_fix(size);
        keys(&mut state, "2 P right right right");
        let seen = screen(&state);
        assert!(
            seen.contains("Generate a pattern") && seen.contains("▸ shape") && seen.contains("survey"),
            "{seen}"
        );
        seen
    });
    insta::assert_snapshot!("generator_preview", seen.join("\n"));
    let mut state = state_with_fix((120, 40));
    keys(&mut state, "2 P down 5 0 0");
    let wide = screen(&state);
    keys(&mut state, "esc");
    assert!(!screen(&state).contains("Generate a pattern"));
    assert_ne!(wide, screen(&state));
}

#[test]
fn the_zoomed_plan_table_has_the_legs() {
    let seen = SIZES.map(|size| {
        let mut state = state_with_fix(size);
        keys(&mut state, "2 z down");
        screen(&state)
    });
    assert!(seen[2].contains("leg m") && seen[2].contains("bearing"), "{}", seen[2]);
    assert!(seen[1].contains("leg to WP1:"), "{}", seen[1]);
    insta::assert_snapshot!("zoomed_plan_with_legs", seen.join("\n"));
}
