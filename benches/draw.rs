//! The time of a frame, and the time from a key or the mouse to the frame that shows the effect.
//!
//! `cargo bench --bench draw`. Goals: a frame at 200x60 with a track of 20 000 points below 2 ms, also with three past
//! tracks and six graphs, with a backdrop of
//! 200 000 vertices below 4 ms, input to frame below 25 ms.

use betadeck::geo::GroundPlane;
use betadeck::plan::feature::{Feature, Shape, Vertex, Zone};
use betadeck::replay::{Overview, Picture};
use betadeck::session::{ReplayView, SessionView};
use betadeck::signals::SimTime;
use betadeck::telemetry::{NavState, Snapshot};
use betadeck::timeline::TimelineView;
use betadeck::ui::backdrop::BackdropLayer;
use betadeck::ui::files::FileReply;
use betadeck::ui::{AppState, MapMode, Msg, draw, update};
use crossterm::event::{KeyCode, KeyEvent, KeyModifiers, MouseButton, MouseEvent, MouseEventKind};
use divan::Bencher;
use nalgebra::Vector2;
use ratatui::Terminal;
use ratatui::backend::TestBackend;
use std::sync::Arc;

#[path = "../tests/screen/ui/fixture.rs"]
mod fixture;

/// The number of points of the long track.
const POINTS: u32 = 20_000;
/// Metres and seconds from one point to the next.
const STEP: (f64, f64) = (0.5, 0.1);

fn main() {
    divan::main();
}

fn terminal((columns, rows): (u16, u16)) -> Terminal<TestBackend> {
    Terminal::new(TestBackend::new(columns, rows)).expect("a test terminal")
}

fn orbiting(size: (u16, u16)) -> AppState {
    let mut state = fixture::state(size, fixture::colour());
    fixture::orbit(&mut state);
    state
}

/// Returns a craft that has flown ten kilometres on a widening spiral, with the whole track recorded.
fn with_long_track(size: (u16, u16)) -> AppState {
    let mut state = orbiting(size);
    fly_a_spiral(&mut state, 0.0);
    state
}

/// Returns a craft after four such flights, the last one in full and the others faintly, with six graphs.
fn with_past_tracks_and_six_graphs(size: (u16, u16)) -> AppState {
    let mut state = orbiting(size);
    for flight in 0..4 {
        fly_a_spiral(&mut state, 30.0 * f64::from(flight));
    }
    press(&mut state, '6');
    let down = std::iter::repeat_n(KeyCode::Down, 5);
    for code in std::iter::once(KeyCode::Enter).chain(down).chain([KeyCode::Char(' '), KeyCode::Esc]) {
        update(&mut state, Msg::Key(KeyEvent::new(code, KeyModifiers::NONE)));
    }
    let long = state.shared.past_flights.tracks().iter().filter(|track| track.len() > POINTS as usize / 2);
    assert_eq!(long.count(), 3);
    state
}

/// Flies a widening spiral around a point so far east, m. The jump to its beginning ends the flight before.
fn fly_a_spiral(state: &mut AppState, east_m: f64) {
    let started_s = state.shared.view.vehicle.time.as_secs_f64();
    let mut angle = 0.0_f64;
    for point in 0..POINTS {
        let radius_m = 20.0 + 0.005 * f64::from(point);
        angle += STEP.0 / radius_m;
        let flight = fixture::SimpleFlight {
            time_s: started_s + STEP.1 * f64::from(point),
            n: radius_m * angle.cos(),
            e: radius_m * angle.sin() + east_m,
            alt: 50.0,
            speed: STEP.0 / STEP.1,
            armed: true,
            fix: true,
            state: NavState::Orbiting,
            wp: 2,
            ..fixture::SimpleFlight::default()
        };
        update(state, Msg::View(fixture::view(&flight)));
    }
    let points = state.shared.track.points().len();
    assert!(points >= POINTS as usize - 100, "{points}");
}

fn press(state: &mut AppState, key: char) {
    update(state, Msg::Key(KeyEvent::new(KeyCode::Char(key), KeyModifiers::NONE)));
}

fn mouse(state: &mut AppState, kind: MouseEventKind, (column, row): (u16, u16)) {
    update(state, Msg::Mouse(MouseEvent { kind, column, row, modifiers: KeyModifiers::NONE }));
}

/// Draws every cell again and again.
fn redraw(bencher: Bencher<'_, '_>, state: &AppState, size: (u16, u16)) {
    let mut terminal = terminal(size);
    bencher.bench_local(|| {
        terminal.clear()?;
        terminal.draw(|frame| draw(state, frame)).map(|_| ())
    });
}

/// A whole frame: draw and compare with the frame before.
#[divan::bench(args = [(80, 24), (120, 40), (200, 60)])]
fn frame(bencher: Bencher<'_, '_>, size: (u16, u16)) {
    let state = orbiting(size);
    let mut terminal = terminal(size);
    bencher.bench_local(|| terminal.draw(|frame| draw(&state, frame)).map(|_| ()));
}

/// Every cell drawn again, after half an hour of flight.
#[divan::bench(args = [(80, 24), (120, 40), (200, 60)])]
fn full_redraw_with_a_long_track(bencher: Bencher<'_, '_>, size: (u16, u16)) {
    let state = with_long_track(size);
    redraw(bencher, &state, size);
}

/// The same after three more flights, whose tracks are shown faintly, with six graphs.
#[divan::bench(args = [(120, 40), (200, 60)])]
fn full_redraw_with_past_tracks_and_six_graphs(bencher: Bencher<'_, '_>, size: (u16, u16)) {
    let state = with_past_tracks_and_six_graphs(size);
    redraw(bencher, &state, size);
}

/// The same with the map on the whole screen, so near that no two points of the track fall together.
#[divan::bench(args = [(200, 60)])]
fn zoomed_map_with_a_long_track(bencher: Bencher<'_, '_>, size: (u16, u16)) {
    let mut state = with_long_track(size);
    press(&mut state, '1');
    press(&mut state, 'z');
    press(&mut state, '+');
    press(&mut state, '+');
    redraw(bencher, &state, size);
}

/// Returns two recorded flights of some 20 000 places each.
fn with_two_recorded_flights(size: (u16, u16)) -> AppState {
    let overview = |shift_m: f64| {
        let pictures = (0..POINTS).map(|point| {
            let angle = f64::from(point) / 500.0;
            let radius_m = 20.0 + 0.02 * f64::from(point);
            let time = SimTime::from_secs_f64(f64::from(point) * STEP.1);
            let mut snapshot = Snapshot { time, ..Snapshot::default() };
            snapshot.estimate.n = Some(radius_m * angle.cos() + shift_m);
            snapshot.estimate.e = Some(radius_m * angle.sin());
            snapshot.estimate.alt = Some(50.0 + angle.sin());
            Picture::of(&snapshot)
        });
        let last = SimTime::from_secs_f64(f64::from(POINTS) * STEP.1);
        Arc::new(Overview { last, frame_us: 1000, pictures: pictures.collect(), ..Overview::default() })
    };
    let mut state = fixture::state(size, fixture::colour());
    let shown = overview(0.0);
    let timeline = TimelineView { head: shown.last, rewound: true, ..TimelineView::default() };
    let time = SimTime(shown.last.0 / 2);
    let view = SessionView {
        vehicle: Arc::new(Snapshot { time, ..Snapshot::default() }),
        timeline: Some(timeline),
        replay: Some(Arc::new(ReplayView { count: 1, overview: shown, ..ReplayView::default() })),
        ..SessionView::default()
    };
    update(&mut state, Msg::View(view));
    let result = Ok(overview(3.0));
    update(&mut state, Msg::OtherFlight { name: "b.bbl".to_owned(), result });
    assert!(state.shared.track.points().len() > POINTS as usize / 2, "{}", state.shared.track.points().len());
    state
}

/// Every cell of the screen with two recorded flights drawn again.
#[divan::bench(args = [(80, 24), (200, 60)])]
fn full_redraw_with_two_recorded_flights(bencher: Bencher<'_, '_>, size: (u16, u16)) {
    let state = with_two_recorded_flights(size);
    redraw(bencher, &state, size);
}

/// Returns a plan over a town: 200 000 vertices in 2000 winding lines and areas, a tenth of them with names.
fn over_a_town(size: (u16, u16)) -> AppState {
    let mut state = orbiting(size);
    let plane = GroundPlane::new(fixture::HOME);
    let features = (0..2000_u32).map(|number| {
        // A number that looks random, the same at each start.
        let mut seed = number.wrapping_mul(2_654_435_761);
        let mut random = || {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from(seed >> 8) / f64::from(1 << 24)
        };
        let mut place = Vector2::new(2000.0 * random() - 1000.0, 2000.0 * random() - 1000.0);
        let mut course = std::f64::consts::TAU * random();
        let vertices = (0..100).map(|_| {
            course += 0.6 * (random() - 0.5);
            place += 3.0 * Vector2::new(course.cos(), course.sin());
            Vertex { position: plane.to_position(place), altitude_m: f32::NAN }
        });
        let vertices = vertices.collect();
        Feature {
            name: if number % 10 == 0 { format!("Street {number}") } else { String::new() },
            shape: if number % 4 == 0 { Shape::Area(vec![vertices]) } else { Shape::Line(vertices) },
            zone: (number % 400 == 0).then_some(Zone::Exclusion),
        }
    });
    let layer = BackdropLayer::new("town.geojson".into(), features.collect());
    assert_eq!(layer.vertices(), 200_000);
    let id = state.shared.editor.plan().id();
    update(&mut state, Msg::Files(FileReply::Backdrop { id, layer, is_new: false }));
    press(&mut state, '1');
    state
}

/// Every cell drawn again with 200 000 vertices under the plan, the map on the whole screen: near, with the plan in the
/// window, and so wide that the window shows all of them.
#[divan::bench(args = [0.2, 1.0, 10.0, 100.0])]
fn full_redraw_with_a_backdrop(bencher: Bencher<'_, '_>, metres_per_column: f64) {
    let mut state = over_a_town((200, 60));
    press(&mut state, 'z');
    state.shared.map.mode = MapMode::Free { n: 0.0, e: 0.0, scale: metres_per_column };
    redraw(bencher, &state, (200, 60));
}

/// A key moves the focus, and the frame shows it.
#[divan::bench(args = [(80, 24), (200, 60)])]
fn key_to_frame(bencher: Bencher<'_, '_>, size: (u16, u16)) {
    let mut state = with_long_track(size);
    let mut terminal = terminal(size);
    let mut keys = "123458".chars().cycle();
    bencher.bench_local(|| {
        press(&mut state, keys.next().unwrap_or('1'));
        terminal.draw(|frame| draw(&state, frame)).map(|_| ())
    });
}

/// A waypoint is inserted or removed again, and the plan is reviewed and estimated again.
#[divan::bench(args = [(80, 24), (200, 60)])]
fn plan_edit_to_frame(bencher: Bencher<'_, '_>, size: (u16, u16)) {
    let mut state = with_long_track(size);
    press(&mut state, '2');
    let mut terminal = terminal(size);
    let mut keys = "iu".chars().cycle();
    bencher.bench_local(|| {
        press(&mut state, keys.next().unwrap_or('u'));
        terminal.draw(|frame| draw(&state, frame)).map(|_| ())
    });
}

/// The map is dragged by a cell, back and forth.
#[divan::bench(args = [(80, 24), (200, 60)])]
fn map_drag_to_frame(bencher: Bencher<'_, '_>, size: (u16, u16)) {
    let mut state = with_long_track(size);
    let mut terminal = terminal(size);
    mouse(&mut state, MouseEventKind::Down(MouseButton::Left), (10, 5));
    let mut columns = [11, 12, 11, 10].into_iter().cycle();
    bencher.bench_local(|| {
        let column = columns.next().unwrap_or(10);
        mouse(&mut state, MouseEventKind::Drag(MouseButton::Left), (column, 5));
        terminal.draw(|frame| draw(&state, frame)).map(|_| ())
    });
}
