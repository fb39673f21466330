//! Keys of the user's own: every sentence names the current key, never the one that it replaced.

use std::sync::Arc;

use betadeck::events::{Event, SessionEvent};
use betadeck::plan::{Altitude, FlightPlan};
use betadeck::session::SessionView;
use betadeck::signals::SimTime;
use betadeck::telemetry::snapshot::Snapshot;
use betadeck::telemetry::{ArmingFlag, Refusal};
use betadeck::timeline::TimelineView;
use betadeck::ui::action::ACTIONS;
use betadeck::ui::keymap::{KeyLine, Keymap};
use betadeck::ui::{AppState, Msg, run_line, status_message, update};

use crate::ui::fixture;
use crate::ui::hands::{keys, screen};

/// Returns a keymap with Alt before every key that is a character.
fn with_alt() -> Keymap {
    let is_character = |key: &str| key.chars().count() == 1 || key == "space";
    let own = |key: &&str| if is_character(key) { format!("alt-{key}") } else { (*key).to_owned() };
    let lines = ACTIONS.iter().filter(|spec| spec.keys.iter().any(|key| is_character(key))).map(|spec| {
        KeyLine { line: 1, action: spec.name.to_owned(), keys: spec.keys.iter().map(own).collect() }
    });
    // Actions that already use Alt get other keys.
    let moved = [
        ("plan.move-up", "ctrl-up"),
        ("plan.move-down", "ctrl-down"),
        ("sim.tick", "ctrl-y"),
        ("plan.earlier", "ctrl-b"),
        ("plan.later", "ctrl-n"),
    ];
    let moved =
        moved.map(|(action, key)| KeyLine { line: 1, action: action.to_owned(), keys: vec![key.to_owned()] });
    let remapped: Vec<KeyLine> = lines.chain(moved).collect();
    Keymap::remapped(&remapped).expect("no conflict")
}

fn changed(view: &mut SessionView, change: impl FnOnce(&mut Snapshot)) {
    change(Arc::make_mut(&mut view.vehicle));
}

type Situation = (&'static str, fn(&mut SessionView));

const SITUATIONS: [Situation; 14] = [
    ("no fix", |view| changed(view, |vehicle| vehicle.craft.gps_fix = Some(false))),
    ("ready", |_| {}),
    ("no plan on the craft", |view| changed(view, |v| v.stored_plan = Some(FlightPlan::default()))),
    ("throttle not low", |view| {
        changed(view, |v| v.craft.arming_blocked_by.get_or_insert_default().set(ArmingFlag::Throttle, true));
    }),
    ("link lost", |view| {
        changed(view, |v| v.craft.arming_blocked_by.get_or_insert_default().set(ArmingFlag::RxLoss, true));
    }),
    ("link cut", |view| view.rc_cut = true),
    ("armed", |view| changed(view, |v| v.craft.armed = Some(true))),
    ("flown by hand", |view| {
        changed(view, |v| {
            v.craft.armed = Some(true);
            v.truth.as_mut().expect("truth").on_ground = false;
        });
    }),
    ("refused", |view| {
        changed(view, |v| {
            v.craft.armed = Some(true);
            v.nav.as_mut().expect("nav").refusal = Some(Refusal::NoPlan);
            if let Some(channels) = &mut v.craft.channels {
                channels[5] = 1900;
            }
        });
    }),
    ("held", |view| {
        changed(view, |v| {
            v.craft.armed = Some(true);
            let nav = v.nav.as_mut().expect("nav");
            (nav.engaged, nav.held_by_command) = (true, true);
            v.active_plan = v.stored_plan.clone();
        });
    }),
    ("engaged on an older plan", |view| {
        changed(view, |v| {
            v.craft.armed = Some(true);
            v.nav.as_mut().expect("nav").engaged = true;
            let mut older = fixture::square();
            older.waypoints[0].altitude = Altitude::above_home(10.0);
            v.active_plan = Some(older);
        });
    }),
    ("crashed", |view| changed(view, |v| v.truth.as_mut().expect("truth").crashed = true)),
    ("in the air, disarmed", |view| {
        changed(view, |v| {
            let truth = v.truth.as_mut().expect("truth");
            (truth.alt, truth.on_ground) = (20.0, false);
        });
    }),
    ("rewound", |view| view.timeline = Some(TimelineView { rewound: true, ..TimelineView::default() })),
];

fn in_situation(keymap: &Keymap, change: fn(&mut SessionView)) -> AppState {
    let mut state = fixture::state((120, 40), fixture::colour());
    state.shared.keymap = keymap.clone();
    let flight = fixture::SimpleFlight { time_s: 8.0, fix: true, ..fixture::SimpleFlight::default() };
    let mut view = fixture::view(&flight);
    change(&mut view);
    update(&mut state, Msg::View(view));
    state
}

/// Returns the single characters in backquotes or before a verb, as in a sentence that names a key.
fn old_keys(text: &str) -> Vec<String> {
    let quoted = text.split('`').skip(1).step_by(2).filter(|part| part.chars().count() == 1);
    let before_verb = |pair: &[&str]| {
        let word = pair[0].trim_matches(|c: char| ",;.:(".contains(c));
        let is_key = word.chars().count() == 1 && word.chars().all(char::is_alphanumeric) && word != "a";
        (is_key && pair[1].chars().all(char::is_alphabetic) && pair[1].ends_with('s') && pair[1] != "s")
            .then(|| word.to_owned())
    };
    let words: Vec<&str> = text.split_whitespace().collect();
    quoted.map(str::to_owned).chain(words.windows(2).filter_map(before_verb)).collect()
}

#[test]
fn the_search_for_old_keys_finds_them() {
    assert_eq!(old_keys("R puts it back; `a` arms, Alt-t raises it, `save` keeps it"), ["a", "R"]);
}

#[test]
fn a_sentence_names_the_keys_as_they_were_remapped_everywhere() {
    let keymap = with_alt();
    let mut seen_keys = 0;
    for (name, situation) in SITUATIONS {
        if let Some(message) = status_message::current(&in_situation(&keymap, situation).shared) {
            assert_eq!(old_keys(&message.action), [""; 0], "{name}: {}", message.action);
            seen_keys += message.action.matches("Alt-").count();
        }
        for spec in ACTIONS {
            let mut state = in_situation(&keymap, situation);
            let said = match run_line(&mut state, spec.name) {
                Err(sentence) => sentence,
                Ok(_) => state.shared.notice.as_ref().map_or_else(String::new, |notice| notice.text.clone()),
            };
            assert_eq!(old_keys(&said), [""; 0], "{name}, {}: {said}", spec.name);
            seen_keys += said.matches("Alt-").count();
        }
    }
    assert!(seen_keys > 100, "the sentences name keys: {seen_keys}");
}

#[test]
fn empty_panels_and_titles_name_the_keys_in_force() {
    let mut state = in_situation(&with_alt(), |view| view.rc_cut = true);
    keys(&mut state, "f2 ctrl-a");
    run_line(&mut state, "plan.delete").expect("deleted");
    let seen = screen(&state);
    assert!(seen.contains("`Alt-i` inserts one, `Alt-P` generates"), "{seen}");
    assert!(seen.contains("→ Alt-x restores it"), "{seen}");
    assert!(seen.contains("▸Alt-2 Plan") && seen.contains("Alt-1 Map"), "{seen}");
    keys(&mut state, "f4");
    assert!(screen(&state).contains("CUT, Alt-x restores it"), "{}", screen(&state));
    keys(&mut state, "f1 left");
    assert!(screen(&state).contains("Alt-0 fits"), "{}", screen(&state));
    for panel in 1..=8 {
        keys(&mut state, &format!("f{panel}"));
        let seen = screen(&state);
        assert!(!seen.contains(" q quit") && seen.contains("Alt-q quit") || panel == 5, "{seen}");
    }
}

#[test]
fn notices_of_the_session_name_the_keys_in_force_too() {
    let mut state = in_situation(&with_alt(), |_| {});
    state.sentence = |event| match &event.kind {
        SessionEvent::Notice(text) => text.clone(),
        other => format!("{other:?}"),
    };
    let kind = SessionEvent::Notice("RC now comes from another program: `x` takes it back.".to_owned());
    update(&mut state, Msg::Event(Event { time: SimTime(0), kind }));
    keys(&mut state, "f8");
    assert!(screen(&state).contains("another program: `Alt-x`"), "{}", screen(&state));
    let kind = SessionEvent::Notice("Edits are back: `u` undoes them.".to_owned());
    update(&mut state, Msg::Event(Event { time: SimTime(0), kind }));
    assert!(screen(&state).contains("back: `Alt-u` undoes them"), "{}", screen(&state));
    update(&mut state, Msg::SaveReply(Err("Not saved while armed: `a` disarms it.".to_owned())));
    assert!(screen(&state).contains("`Alt-a` disarms it"), "{}", screen(&state));
    let result = Err("an earlier instant is shown: `b` flies on.".to_owned());
    let id = state.shared.editor.plan().id();
    update(&mut state, Msg::UploadReply { id, count: 4, result });
    assert!(screen(&state).contains("`Alt-b` flies on"), "{}", screen(&state));
}
