//! The sentences for ground stations about what happens to the craft.

use crate::mavlink::value::Severity;
use crate::session::SessionView;
use crate::telemetry::{NavState, Refusal};

/// The part of the view that the last sentences were about.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Texts {
    armed: Option<bool>,
    nav: Option<(NavState, u8)>,
    refusal: Option<Refusal>,
    is_failsafe: bool,
    crashed: bool,
}

impl Texts {
    /// Takes a view. Returns the sentences about its changes.
    pub(super) fn follow(&mut self, view: &SessionView) -> Vec<(Severity, String)> {
        let vehicle = &*view.vehicle;
        let nav = vehicle.nav.as_ref();
        let now = Self {
            armed: vehicle.craft.armed,
            nav: nav.map(|nav| (nav.state, nav.wp)),
            refusal: nav.and_then(|nav| nav.refusal),
            is_failsafe: vehicle.craft.failsafe_stage.is_some_and(|stage| stage > 1),
            crashed: vehicle.truth.as_ref().is_some_and(|truth| truth.crashed),
        };
        let before = std::mem::replace(self, now.clone());
        let mut texts = Vec::new();
        match (before.armed, now.armed) {
            (Some(false), Some(true)) => texts.push((Severity::Info, "Armed.".to_owned())),
            (Some(true), Some(false)) => texts.push((Severity::Info, "Disarmed.".to_owned())),
            _ => {}
        }
        if let (Some(was), Some(is)) = (before.nav, now.nav)
            && was != is
            && (is.0 != NavState::Idle || was.0 != NavState::Idle)
        {
            let reason = nav.and_then(|nav| nav.reason).filter(|_| was.0 != is.0);
            let reason = reason.map_or_else(String::new, |reason| format!(" ({reason})"));
            texts.push((Severity::Info, format!("Autopilot: {} {}{reason}", is.0, is.1)));
        }
        if let Some(refusal) = now.refusal.filter(|_| now.refusal != before.refusal) {
            texts.push((Severity::Warning, format!("Autopilot refused: {refusal}")));
        }
        if now.is_failsafe && !before.is_failsafe {
            texts.push((Severity::Critical, "Failsafe: the RC link is lost.".to_owned()));
        }
        if now.crashed && !before.crashed {
            texts.push((Severity::Emergency, "The craft crashed.".to_owned()));
        }
        texts
    }
}

/// Returns a sentence in the letters that all ground stations show.
pub(super) fn ascii(sentence: &str) -> String {
    let mut text = String::with_capacity(sentence.len());
    for letter in sentence.chars() {
        match letter {
            '→' => text.push_str("->"),
            '°' => text.push_str(" deg"),
            '≤' => text.push_str("<="),
            '≥' => text.push_str(">="),
            '±' => text.push_str("+-"),
            'µ' => text.push('u'),
            '²' => text.push('2'),
            letter if letter.is_ascii() && !letter.is_ascii_control() => text.push(letter),
            _ => text.push('?'),
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::telemetry::snapshot::{CraftView, Snapshot};

    #[test]
    fn sentences_have_plain_letters() {
        assert_eq!(ascii("0 m → 12 m ≤ 5° ä"), "0 m -> 12 m <= 5 deg ?");
    }

    #[test]
    fn arming_is_said_once_and_not_at_the_first_view() {
        let view = |armed| {
            let craft = CraftView { armed: Some(armed), ..CraftView::default() };
            SessionView {
                vehicle: Arc::new(Snapshot { craft, ..Snapshot::default() }),
                ..SessionView::default()
            }
        };
        let mut texts = Texts::default();
        assert!(texts.follow(&view(true)).is_empty(), "it was armed before");
        assert!(texts.follow(&view(true)).is_empty());
        assert_eq!(texts.follow(&view(false)), [(Severity::Info, "Disarmed.".to_owned())]);
    }
}
