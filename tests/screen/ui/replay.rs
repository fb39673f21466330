//! A recorded flight on the screen, alone and beside a second one.

use std::sync::Arc;

use betadeck::events::{Event, ReplayNotice, SessionEvent};
use betadeck::geo::LatLon;
use betadeck::plan::FlightPlan;
use betadeck::replay::{Curve, CurvesRequest, Overview, Picture, Series};
use betadeck::session::command::Seek;
use betadeck::session::policy::RECORDED;
use betadeck::session::{Command, ReplayView, SessionView};
use betadeck::signals::SimTime;
use betadeck::telemetry::{EventKind, FirmwareEvent, Mode, ModeFlags, Snapshot};
use betadeck::timeline::{MarkKind, Marks, TimelineView};
use betadeck::ui::{AppState, Effect, Msg, Severity, update};

use crate::ui::fixture;
use crate::ui::hands::{keys, press, screen};

const SIZES: [(u16, u16); 4] = [(60, 20), (80, 24), (120, 40), (200, 60)];
/// The first and the last second of the flight.
const FROM_S: f64 = 35.0;
const TO_S: f64 = 155.0;

fn at(seconds: f64) -> SimTime {
    SimTime::from_secs_f64(seconds)
}

/// A recorded circle that begins at home and goes to the north, flown once in a minute.
#[derive(Clone, Copy)]
struct Circle {
    has_gps: bool,
    radius_m: f64,
    /// The altitude, m.
    alt_m: f64,
    /// The time of arming, s.
    armed_s: f64,
}

const CIRCLE: Circle = Circle { has_gps: true, radius_m: 40.0, alt_m: 30.0, armed_s: 40.0 };

impl Circle {
    fn picture(self, time_s: f64) -> Snapshot {
        let mut picture = Snapshot { time: at(time_s), ..Snapshot::default() };
        let flown_s = (time_s - self.armed_s).max(0.0);
        let turn = flown_s / 60.0 * std::f64::consts::TAU;
        let estimate = &mut picture.estimate;
        if self.has_gps {
            picture.origin = Some(fixture::HOME);
            picture.craft.home = Some(fixture::HOME);
            picture.craft.gps_fix = Some(true);
            picture.craft.sats = Some(14);
            (estimate.n, estimate.e) =
                (Some(self.radius_m * turn.sin()), Some(self.radius_m * (1.0 - turn.cos())));
            estimate.ground_speed_mps = Some(4.2);
        }
        estimate.alt = Some(self.alt_m.min(flown_s * 2.0));
        estimate.roll_deg = Some(12.0 * turn.sin());
        estimate.pitch_deg = Some(-8.0);
        estimate.heading_deg = Some(turn.to_degrees().rem_euclid(360.0));
        let mut modes = ModeFlags::NONE;
        modes.set(Mode::Arm, flown_s > 0.0);
        modes.set(Mode::Angle, flown_s > 20.0);
        let craft = &mut picture.craft;
        (craft.armed, craft.modes) = (Some(flown_s > 0.0), Some(modes));
        (craft.battery_v, craft.battery_cells) = (Some(15.2), Some(4));
        craft.motors = Some([0.4, 0.42, 0.38, 0.41]);
        let mut channels = [0; 16];
        channels[..4].copy_from_slice(&[1500, 1480, 1390, 1500]);
        craft.channels = Some(channels);
        picture
    }

    fn overview(self) -> Overview {
        let mut marks = Marks::default();
        marks.note(at(self.armed_s), &EventKind::Firmware(FirmwareEvent::Armed));
        let mut modes = ModeFlags::NONE;
        modes.set(Mode::Angle, true);
        marks.push(at(self.armed_s + 20.0), MarkKind::Modes(modes));
        let times = (0..=1200).map(|tenth| FROM_S + f64::from(tenth) / 10.0);
        let series = [("gyroADC[0]", "°/s"), ("debug[3]", "")];
        Overview {
            first: at(FROM_S),
            last: at(TO_S),
            frame_us: 1000,
            origin: self.has_gps.then_some(fixture::HOME),
            marks,
            pictures: times.map(|time_s| Picture::of(&self.picture(time_s))).collect(),
            series: series.map(|(name, unit)| Series::new(name, unit)).to_vec(),
            ..Overview::default()
        }
    }

    fn view(self, overview: &Arc<Overview>, time_s: f64) -> SessionView {
        let timeline = TimelineView {
            first: overview.first,
            head: overview.last,
            rewound: time_s < TO_S,
            cannot_continue: true,
            marks: overview.marks.all(),
            ..TimelineView::default()
        };
        let replay = ReplayView {
            file: "LOG00007.BFL".into(),
            number: 1,
            count: 3,
            reading: None,
            overview: Arc::clone(overview),
            values: Arc::new(vec![-12.5, f64::NAN]),
        };
        SessionView {
            vehicle: Arc::new(self.picture(time_s)),
            paused: true,
            speed_wanted: 1.0,
            timeline: Some(timeline),
            replay: Some(Arc::new(replay)),
            ..SessionView::default()
        }
    }
}

/// Returns the screen at an instant of a recorded flight.
fn replayed(size: (u16, u16), circle: Circle, time_s: f64) -> AppState {
    let mut state = fixture::state_with(size, fixture::colour(), FlightPlan::default());
    let overview = Arc::new(circle.overview());
    update(&mut state, Msg::View(circle.view(&overview, time_s)));
    hear(
        &mut state,
        FROM_S,
        SessionEvent::Replay(ReplayNotice::Begins("LOG00007.BFL, flight 2 of 3.".into())),
    );
    let damage = "2 damaged parts, 318 bytes, were skipped.".to_owned();
    hear(&mut state, FROM_S, SessionEvent::Replay(ReplayNotice::Warning(damage)));
    let armed = EventKind::Firmware(FirmwareEvent::Armed);
    hear(&mut state, circle.armed_s, SessionEvent::Vehicle(armed));
    state
}

fn hear(state: &mut AppState, time_s: f64, kind: SessionEvent) {
    update(state, Msg::Event(Event { time: at(time_s), kind }));
}

fn beside(state: &mut AppState, circle: Circle) {
    let result = Ok(Arc::new(circle.overview()));
    update(state, Msg::OtherFlight { name: "LOG00008.BFL".to_owned(), result });
}

#[test]
fn a_recorded_flight_at_four_sizes() {
    let seen = SIZES.map(|size| screen(&replayed(size, CIRCLE, 90.0))).join("\n");
    for shown in ["REPLAY 2/3", "LOG00007.BFL", "damaged parts"] {
        assert!(seen.contains(shown), "{shown}\n{seen}");
    }
    insta::assert_snapshot!(seen);
}

#[test]
fn every_panel_of_a_recorded_flight() {
    for (key, name) in [("3", "state"), ("4", "rc"), ("6", "graphs"), ("7", "world"), ("8", "log")] {
        let mut state = replayed((120, 40), CIRCLE, 90.0);
        keys(&mut state, key);
        keys(&mut state, "z");
        insta::assert_snapshot!(format!("replay_{name}"), screen(&state));
    }
}

#[test]
fn the_settings_of_a_recorded_flight_are_not_read_and_the_panel_says_why() {
    let mut state = replayed((80, 24), CIRCLE, 90.0);
    keys(&mut state, "9");
    let view = state.shared.view.clone();
    let effects = update(&mut state, Msg::View(view));
    assert!(effects.is_empty(), "{effects:?}");
    assert!(screen(&state).contains("This is a recorded flight: it can be looked at"), "{}", screen(&state));
}

#[test]
fn the_track_is_there_at_once_and_bright_up_to_the_shown_instant() {
    let state = replayed((120, 40), CIRCLE, 90.0);
    let points = state.shared.track.points();
    assert!(points.len() > 200, "{}", points.len());
    assert!(points.first().is_some_and(|point| point.time_s < 41.0));
    assert!(points.last().is_some_and(|point| point.time_s > 150.0));
}

#[test]
fn a_flight_without_a_gps_says_so() {
    let state = replayed((80, 24), Circle { has_gps: false, ..CIRCLE }, 90.0);
    assert!(state.shared.track.points().is_empty());
    let seen = screen(&state);
    assert!(seen.contains("No GPS in this flight: no track."), "{seen}");
    assert!(seen.contains("⊕ —   — sats"), "{seen}");
}

#[test]
fn another_flight_of_the_file_replaces_the_first() {
    let mut state = replayed((120, 40), CIRCLE, 90.0);
    let lower = Circle { alt_m: 10.0, ..CIRCLE };
    let overview = Arc::new(lower.overview());
    update(&mut state, Msg::View(lower.view(&overview, 36.0)));
    hear(&mut state, FROM_S, SessionEvent::Replay(ReplayNotice::Begins("flight 3 of 3.".into())));
    assert!(state.shared.track.points().iter().all(|point| point.alt_m < 11.0));
    assert_eq!(state.shared.log.len(), 1, "the events of the flight before are gone");
}

#[test]
fn keys_play_seek_and_change_the_flight() {
    let mut state = replayed((120, 40), CIRCLE, 90.0);
    let seek = |seek| Command::Seek(seek);
    for (key, expected) in [
        (",", seek(Seek::Back { states_only: false })),
        (";", seek(Seek::Forward { states_only: false })),
        ("{", seek(Seek::Back { states_only: true })),
        ("<", seek(Seek::Seconds(-10.0))),
        ("e", seek(Seek::Newest)),
        ("alt-right", Command::ShowFlight(1)),
        ("alt-left", Command::ShowFlight(-1)),
    ] {
        let sent = keys(&mut state, key);
        let [Effect::Send(command)] = &sent[..] else { panic!("{key}: {sent:?}") };
        assert_eq!(format!("{command:?}"), format!("{expected:?}"), "{key}");
    }
    let played = press(&mut state, ' ');
    assert!(matches!(played[..], [Effect::Send(Command::Pause(false))]), "{played:?}");
    let stepped = keys(&mut state, ".");
    assert!(matches!(stepped[..], [Effect::Send(Command::Step(10))]), "10 ms of 1 kHz: {stepped:?}");
}

#[test]
fn nothing_is_sent_to_the_craft_of_a_recorded_flight() {
    let mut state = replayed((120, 40), CIRCLE, 90.0);
    for key in ["F", "a", "t", "g", "H", "x", "U", "R", "b", "L", "w", "K"] {
        let sent = keys(&mut state, key);
        assert!(sent.is_empty(), "{key}: {sent:?}");
        let notice = state.shared.notice.take().map(|notice| (notice.severity, notice.text));
        assert_eq!(notice, Some((Severity::Warn, RECORDED.to_owned())), "{key}");
    }
    // The craft of the record may be armed, but nothing flies.
    assert!(matches!(keys(&mut state, "q")[..], [Effect::Quit]));
}

#[test]
fn series_are_found_by_their_names_and_drawn() {
    let mut state = replayed((120, 40), CIRCLE, 90.0);
    keys(&mut state, "6 /");
    let all = screen(&state);
    assert!(all.contains("gyroADC[0]") && all.contains("-12.50 °/s") && all.contains("—"), "{all}");
    assert!(keys(&mut state, "d b g").is_empty());
    let found = screen(&state);
    assert!(found.contains("debug[3]") && !found.contains("gyroADC[0]"), "{found}");
    let mut requests = keys(&mut state, "enter esc").into_iter().filter_map(|effect| match effect {
        Effect::Curves(request) => Some(request),
        _ => None,
    });
    let request: CurvesRequest = requests.next().expect("a request");
    assert_eq!((request.series.as_slice(), requests.next()), (&[1][..], None));
    assert!(request.from < at(90.0) && request.to > at(90.0), "{request:?}");
    let curve = Curve::new(request.from, request.to, vec![Some((-7.0, 31.0)); request.steps]);
    update(&mut state, Msg::Curves { request, result: Ok(vec![curve]) });
    let graphs = screen(&state);
    assert!(graphs.contains("debug[3]") && graphs.contains("32.5") && graphs.contains("-8.5"), "{graphs}");
    // A shorter time is read in more detail.
    let finer = keys(&mut state, "+");
    assert!(matches!(finer[..], [Effect::Curves(_)]), "{finer:?}");
}

#[test]
fn two_flights_are_on_the_map_and_in_the_graphs_with_their_difference() {
    let mut state = replayed((120, 40), CIRCLE, 90.0);
    beside(&mut state, Circle { radius_m: 31.0, alt_m: 22.0, armed_s: 43.0, ..CIRCLE });
    let notice = state.shared.notice.as_ref().map(|notice| notice.text.as_str());
    assert_eq!(notice, Some("LOG00008.BFL is aligned at arming."));
    insta::assert_snapshot!("replay_two_map", screen(&state));
    keys(&mut state, "6 z");
    let graphs = screen(&state);
    assert!(graphs.contains("Δ altitude m") && graphs.contains("shown − LOG00008.BFL    8.0"), "{graphs}");
    insta::assert_snapshot!("replay_two_graphs", graphs);
    keys(&mut state, "ctrl-right ctrl-right");
    let notice = state.shared.notice.as_ref().map(|notice| notice.text.as_str());
    assert_eq!(notice, Some("LOG00008.BFL is aligned at arming, and 0.2 s later."));
    keys(&mut state, "enter");
    assert!(screen(&state).contains("Δ speed"), "{}", screen(&state));
}

#[test]
fn a_second_flight_that_cannot_be_read_is_reported() {
    let mut state = replayed((80, 24), CIRCLE, 90.0);
    let result = Err("b.bbl has no frame.".to_owned());
    update(&mut state, Msg::OtherFlight { name: "b.bbl".to_owned(), result });
    assert!(screen(&state).contains("b.bbl has no frame."));
    keys(&mut state, "ctrl-right");
    assert!(screen(&state).contains("There is no second flight to shift"));
}

#[test]
fn any_size_draws_any_flight_without_a_panic() {
    let empty = Overview::default();
    for (width, height) in [(1, 1), (2, 40), (40, 2), (59, 19), (60, 20), (61, 21), (300, 90), (500, 20)] {
        for panel in ["1", "2", "3", "4", "5", "6", "7", "8"] {
            let mut state = replayed((80, 24), CIRCLE, 90.0);
            beside(&mut state, Circle { has_gps: false, ..CIRCLE });
            keys(&mut state, panel);
            keys(&mut state, "esc");
            update(&mut state, Msg::Resize(width, height));
            screen(&state);
            let empty = Arc::new(Overview { origin: Some(LatLon::default()), ..Overview::default() });
            update(&mut state, Msg::View(CIRCLE.view(&empty, 90.0)));
            screen(&state);
        }
    }
    assert!(empty.pictures.is_empty());
}

#[test]
fn a_hostile_name_is_shown_without_its_control_characters() {
    let mut state = replayed((80, 24), CIRCLE, 90.0);
    let overview = Arc::new(CIRCLE.overview());
    let mut view = CIRCLE.view(&overview, 91.0);
    if let Some(replay) = &mut view.replay {
        Arc::make_mut(replay).file = "\u{1b}[31mx\u{202e}y\u{7}".into();
    }
    update(&mut state, Msg::View(view));
    let seen = screen(&state);
    assert!(!seen.contains(['\u{1b}', '\u{202e}', '\u{7}']), "{seen:?}");
}
