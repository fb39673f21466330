//! The effects of mistyped values: messages in, screen and effects out.

use betadeck::plan::FlightPlan;
use betadeck::ui::files::FileRequest;
use betadeck::ui::{Effect, Msg, update};

use crate::ui::hands::{keys, screen, state_with_fix as state};

fn altitudes(plan: &FlightPlan) -> Vec<i32> {
    plan.records().iter().map(|wp| wp.alt_cm).collect()
}

#[test]
fn the_first_typed_character_replaces_a_value_and_an_arrow_keeps_it() {
    let mut state = state((120, 40));
    keys(&mut state, "2 right right right enter '35 enter");
    assert_eq!(altitudes(state.shared.plan()), [3500, 5000, 5000, 5000], "not 5035 m");
    keys(&mut state, "down enter left '2 enter");
    assert_eq!(altitudes(state.shared.plan()), [3500, 52_000, 5000, 5000], "an arrow edits 50 to 520");
    keys(&mut state, "u enter");
    update(&mut state, Msg::Paste("61".to_owned()));
    keys(&mut state, "enter");
    assert_eq!(altitudes(state.shared.plan()), [3500, 6100, 5000, 5000], "pasted text replaces, too");
}

#[test]
fn the_first_typed_character_replaces_each_value_of_a_form() {
    let mut state = state((120, 40));
    keys(&mut state, "2 P down '200");
    let seen = screen(&state);
    assert!(seen.contains("200") && !seen.contains("80200"), "{seen}");
    keys(&mut state, "down '30 up '40");
    let seen = screen(&state);
    assert!(
        !seen.contains("20040") && !seen.contains("200 "),
        "a value that is reached again is selected: {seen}"
    );
}

#[test]
fn the_first_typed_character_replaces_the_name_of_save_as() {
    let mut state = state((120, 40));
    keys(&mut state, "2 S 'mine");
    let effects = keys(&mut state, "enter");
    let saved = effects.iter().find_map(|effect| match effect {
        Effect::Files(FileRequest::Save { path, .. }) => Some(path),
        _ => None,
    });
    let path = saved.unwrap_or_else(|| panic!("{effects:?}"));
    assert_eq!(path.file_name().and_then(|name| name.to_str()), Some("mine.toml"));
}
