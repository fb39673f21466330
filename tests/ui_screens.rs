//! What the user interface shows: whole screens, and that no size and no picture breaks it.

use betadeck::ui::picture::svg;
use betadeck::ui::{AppState, Msg, Pane, Theme, draw, update};
use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};
use ratatui::Terminal;
use ratatui::backend::TestBackend;

#[path = "ui/fixture.rs"]
mod fixture;

fn screen(state: &AppState) -> TestBackend {
    let (width, height) = state.size;
    let mut terminal = Terminal::new(TestBackend::new(width, height)).expect("a test terminal");
    terminal.draw(|frame| draw(state, frame)).expect("drawing in memory");
    terminal.backend().clone()
}

fn text(state: &AppState) -> String {
    screen(state).to_string()
}

fn press(state: &mut AppState, key: char) {
    update(state, Msg::Key(KeyEvent::new(KeyCode::Char(key), KeyModifiers::NONE)));
}

#[test]
fn at_start_80x24() {
    let state = fixture::state((80, 24), fixture::colour());
    insta::assert_snapshot!(screen(&state));
}

#[test]
fn approaching_80x24() {
    let mut state = fixture::state((80, 24), fixture::colour());
    fixture::approach(&mut state);
    insta::assert_snapshot!(screen(&state));
}

#[test]
fn approaching_120x40() {
    let mut state = fixture::state((120, 40), fixture::colour());
    fixture::approach(&mut state);
    insta::assert_snapshot!(screen(&state));
}

#[test]
fn orbiting_200x60() {
    let mut state = fixture::state((200, 60), fixture::colour());
    fixture::orbit(&mut state);
    insta::assert_snapshot!(screen(&state));
}

#[test]
fn complete_60x20_shows_the_focused_panel_alone() {
    let mut state = fixture::state((60, 20), fixture::colour());
    fixture::complete(&mut state);
    press(&mut state, '3');
    insta::assert_snapshot!(screen(&state));
}

#[test]
fn rc_80x24() {
    let mut state = fixture::state((80, 24), fixture::colour());
    fixture::approach(&mut state);
    press(&mut state, '4');
    insta::assert_snapshot!(screen(&state));
}

#[test]
fn help_80x24() {
    let mut state = fixture::state((80, 24), fixture::colour());
    press(&mut state, '?');
    insta::assert_snapshot!(screen(&state));
}

#[test]
fn in_ascii_every_cell_is_ascii_and_the_words_are_all_there() {
    for fly in [fixture::approach, fixture::orbit, fixture::complete] {
        let mut rich = fixture::state((200, 60), fixture::colour());
        let mut plain = fixture::state((200, 60), fixture::plain());
        fly(&mut rich);
        fly(&mut plain);
        let plain = text(&plain);
        assert!(plain.is_ascii(), "{plain}");
        assert!(!plain.contains('?') || text(&rich).contains('?'), "a character has no replacement\n{plain}");
        for word in ["ARRIVED", "COMPLETE", "WP", "2 Plan", "5 CLI", "square.toml"] {
            assert!(plain.contains(word), "{word} missing in\n{plain}");
        }
    }
}

#[test]
fn help_and_quit_are_always_offered() {
    for size in [(60, 20), (80, 24), (200, 60)] {
        let mut state = fixture::state(size, fixture::colour());
        fixture::approach(&mut state);
        for pane in Pane::ALL {
            state.focus = pane;
            let screen = text(&state);
            let words: &[&str] = if pane == Pane::Cli { &["Esc leave"] } else { &["? help", "q quit"] };
            for word in words {
                assert!(screen.contains(word), "{word} missing at {size:?} in {pane:?}\n{screen}");
            }
        }
    }
}

#[test]
fn a_small_screen_says_what_it_needs() {
    let mut state = fixture::state((52, 18), fixture::colour());
    fixture::approach(&mut state);
    assert!(text(&state).contains("at least 60x20, now 52x18"), "{}", text(&state));
}

#[test]
fn no_size_panics_with_any_focus_zoom_or_popup() {
    let themes: [Theme; 2] = [fixture::colour(), fixture::plain()];
    let mut state = fixture::state((80, 24), themes[0]);
    fixture::orbit(&mut state);
    press(&mut state, '?');
    let popup = std::mem::take(&mut state.layers);
    for width in (1..=250).step_by(3) {
        for height in (1..=85).step_by(2) {
            update(&mut state, Msg::Resize(width, height));
            state.focus = Pane::ALL[usize::from(width + height) % Pane::ALL.len()];
            state.slots.visit(state.focus);
            state.zoomed = (width / 3 + height) % 3 == 0;
            state.layers = if width % 5 == 0 { popup.clone() } else { Vec::new() };
            state.theme = themes[usize::from(height % 2)];
            screen(&state);
        }
    }
}

#[test]
fn a_picture_with_nonsense_numbers_is_drawn() {
    let mut state = fixture::state((120, 40), fixture::colour());
    fixture::approach(&mut state);
    for nonsense in [f64::NAN, f64::INFINITY, -1e300] {
        let mut view = state.view.clone();
        let vehicle = std::sync::Arc::make_mut(&mut view.vehicle);
        let truth = vehicle.truth.as_mut().expect("the fixture tells the truth");
        truth.n = nonsense;
        truth.lat_deg = nonsense;
        truth.heading_deg = nonsense;
        vehicle.nav.distance_m = Some(nonsense);
        vehicle.nav.aim_ne = Some(nalgebra::Vector2::new(nonsense, 0.0));
        vehicle.settings.fence_m = Some(nonsense);
        vehicle.settings.orbit_radius_m = nonsense;
        vehicle.craft.battery_v = Some(nonsense);
        update(&mut state, Msg::View(view));
        assert!(text(&state).contains("APPROACHING"));
    }
}

#[test]
fn the_screen_becomes_a_picture() {
    let mut state = fixture::state((120, 40), fixture::colour());
    fixture::approach(&mut state);
    let picture = svg(screen(&state).buffer());
    assert!(picture.contains("APPROACHING") && picture.contains("1 Map"));
    assert_eq!(picture.matches("<text").count(), picture.matches("</text>").count());
}
