//! The question before a file is opened or saved that differs from the plan.

use betadeck::ui::files::{Conversion, ConversionLosses, FileReply, FileRequest};
use betadeck::ui::{Effect, Msg, update};

use crate::ui::editor::save_of;
use crate::ui::hands::{keys, screen, state_with_fix as state};

#[test]
fn a_file_that_cannot_hold_the_plan_is_written_after_the_losses_were_read() {
    let mut state = state((80, 24));
    let FileRequest::Save { id, .. } = save_of(keys(&mut state, "2 + S down enter")) else { unreachable!() };
    let lines: Vec<String> =
        (0..40).map(|n| format!("lost     WP {n} pattern: FIGURE8 → HOLD: none")).collect();
    let path: std::path::PathBuf = "/plans/a.mission".into();
    let conversion = Conversion::Save { id, path: path.clone(), replace: true };
    let losses = ConversionLosses { conversion, lines, summary: "40 lost".to_owned() };
    update(&mut state, Msg::Files(FileReply::Losses(Box::new(losses.clone()))));
    let seen = screen(&state);
    assert!(seen.contains("Save a.mission? 40 lost.") && seen.contains("WP 0 pattern"), "{seen}");
    keys(&mut state, "down down");
    let seen = screen(&state);
    assert!(!seen.contains("WP 1 pattern") && seen.contains("WP 2 pattern"), "{seen}");
    assert!(keys(&mut state, "n").is_empty());
    update(&mut state, Msg::Files(FileReply::Losses(Box::new(losses.clone()))));
    let asked = save_of(keys(&mut state, "y"));
    assert!(matches!(asked, FileRequest::Save { replace: true, accepted: true, .. }), "{asked:?}");
    let open = ConversionLosses { conversion: Conversion::Open(path), ..losses };
    update(&mut state, Msg::Files(FileReply::Losses(Box::new(open))));
    assert!(screen(&state).contains("Open a.mission? 40 lost."));
    let effects = keys(&mut state, "enter");
    assert!(matches!(&effects[..], [Effect::Files(FileRequest::Open { accepted: true, .. })]), "{effects:?}");
}
