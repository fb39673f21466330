//! The revisions of a plan in time, in every branch.

use betadeck::ui::{AppState, Msg, update};

use crate::ui::editor::altitudes;
use crate::ui::fixture;
use crate::ui::hands::{journal_lines, keys, screen, state_with_fix as state};

#[test]
fn all_revisions_are_reached_in_the_order_in_which_they_were_made_in_any_branch() {
    let mut state = state((80, 24));
    let altitude = |state: &AppState| altitudes(state.shared.plan())[0];
    let said = |state: &AppState| state.shared.notice.as_ref().unwrap().text.clone();
    // 51 and 52 m, back to 51 m, then 41 m in another branch.
    keys(&mut state, "2 right right right + + u shift-down");
    assert_eq!(altitude(&state), 4100);
    keys(&mut state, "ctrl-r");
    assert_eq!(
        said(&state),
        "Nothing to redo here. Revision 2 is another branch: altitude of WP0. `Alt-u` goes back to it in time."
    );
    let mut seen = Vec::new();
    for _ in 0..4 {
        let effects = keys(&mut state, "alt-u");
        seen.push((altitude(&state), journal_lines(&effects)));
    }
    assert_eq!(seen, [(5200, 1), (5100, 1), (5000, 1), (5000, 0)]);
    assert!(said(&state).contains("as it was opened; 3 revisions follow"), "{}", said(&state));
    keys(&mut state, "alt-U alt-U");
    assert_eq!((altitude(&state), said(&state).starts_with("Revision 2 of 3: altitude of")), (5200, true));
    keys(&mut state, "alt-U alt-U");
    assert_eq!((altitude(&state), said(&state).as_str()), (4100, "This is the newest of 3 revisions."));
}

#[test]
fn while_another_plan_is_flown_the_map_shows_each_revision_for_a_moment() {
    let mut state = fixture::state((80, 24), fixture::colour());
    fixture::approach(&mut state);
    keys(&mut state, "2 n i i 1");
    assert!(screen(&state).contains("3 LAND"), "the flown plan: {}", screen(&state));
    keys(&mut state, "alt-u");
    assert!(!screen(&state).contains("3 LAND"), "the revision: {}", screen(&state));
    let later = state.shared.now + std::time::Duration::from_secs(9);
    update(&mut state, Msg::Clock(later));
    assert!(screen(&state).contains("3 LAND"), "{}", screen(&state));
}
