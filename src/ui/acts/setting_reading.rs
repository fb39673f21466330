//! Reads the settings of the craft: those of an embedded one again and again while they are shown, those of a remote one
//! once, because that takes its command line a while.

use std::time::Duration;

use super::screen_layout;
use crate::fc::{CraftSettings, Impact, RemoteState};
use crate::session::policy::{self, Facts, Intent};
use crate::ui::formatting::within;
use crate::ui::model::effect::Effect;
use crate::ui::model::event_log::Severity;
use crate::ui::model::panel_table::Panel;
use crate::ui::model::settings::SettingsState;
use crate::ui::shared::Shared;

/// The time between two readings of an embedded firmware, whose settings a door, a rewind or a plan can change.
const EMBEDDED: Duration = Duration::from_secs(1);
/// The time after a refusal before a remote firmware is asked again.
const AGAIN: Duration = Duration::from_secs(10);

/// Requests the settings if they are shown, and unknown or possibly outdated. Discards the settings of an earlier
/// connection.
pub(in crate::ui) fn follow(state: &mut Shared) -> Option<Effect> {
    let connection = state.view.remote.as_ref().map(|remote| remote.connection);
    if state.settings.connection != connection {
        let given = std::mem::take(&mut state.settings.given);
        state.settings = SettingsState { connection, ..SettingsState::new(given) };
    }
    let is_shown = screen_layout::screen(state).is_some_and(|screen| screen.panel(Panel::Settings).is_some());
    if is_shown { refresh(state) } else { None }
}

/// Requests the settings if they are unknown or may be outdated.
pub(in crate::ui) fn refresh(state: &mut Shared) -> Option<Effect> {
    if !is_due(state) {
        return None;
    }
    if let Err(why) = can_read(state) {
        state.settings.refusal = Some(why);
        return None;
    }
    Some(ask(state))
}

/// Requests the settings again, because the user asked for them.
pub(in crate::ui) fn read_again(state: &mut Shared) -> Vec<Effect> {
    state.settings.is_reported = true;
    if state.settings.is_asked {
        return Vec::new();
    }
    vec![ask(state)]
}

fn ask(state: &mut Shared) -> Effect {
    state.settings.is_asked = true;
    state.settings.is_outdated = false;
    Effect::ReadSettings
}

fn is_due(state: &Shared) -> bool {
    let SettingsState { craft, refusal, is_asked, read_at, is_outdated, steps, .. } = &state.settings;
    if *is_asked || steps.pending() > 0 {
        return false;
    }
    let since = |span| read_at.is_none_or(|at| !within(state.now, at, span));
    match (&state.view.remote, refusal) {
        (None, _) => *is_outdated || since(EMBEDDED),
        (Some(_), Some(_)) => since(AGAIN),
        (Some(_), None) => craft.is_none() || *is_outdated,
    }
}

/// Returns the reason, as a sentence, for which the settings cannot be read now without a question to the user.
fn can_read(state: &Shared) -> Result<(), String> {
    let remote = state.view.remote.as_ref();
    if remote.is_some_and(|remote| remote.state != RemoteState::Ready) {
        return Err("The settings are read as soon as the firmware answers.".to_owned());
    }
    if remote.is_some() && state.view.vehicle.craft.is_armed() && state.settings.craft.is_none() {
        return Err(
            "The command line of this firmware does not open in flight: its settings are read once it is \
                    disarmed."
                .to_owned(),
        );
    }
    policy::check(&Facts::from(&state.view), Intent::Line(Impact::Reads))
        .map_err(|refusal| state.keymap.in_force(&refusal.to_string()))
}

/// Takes the settings, or the reason why they could not be read.
pub(in crate::ui) fn take(state: &mut Shared, reply: Result<Box<CraftSettings>, String>) {
    let now = state.now;
    let settings = &mut state.settings;
    settings.is_asked = false;
    settings.read_at = Some(now);
    match reply {
        // Values that the craft has not confirmed would be taken back for a moment.
        Ok(_) if settings.steps.pending() > 0 => settings.is_outdated = true,
        Ok(mut craft) => {
            if settings.connection.is_some() {
                with_first(&mut settings.first, &mut craft);
            }
            settings.refusal = None;
            let count = craft.all.len();
            settings.craft = Some(craft);
            if std::mem::take(&mut settings.is_reported) {
                state.say(Severity::Good, format!("All {count} settings of the craft were read."));
            }
        }
        Err(sentence) => {
            let sentence = state.keymap.in_force(&sentence);
            let is_asked_for = std::mem::take(&mut state.settings.is_reported);
            let is_new = is_asked_for || state.settings.refusal.as_ref() != Some(&sentence);
            state.settings.refusal = Some(sentence.clone());
            if is_new {
                state.notify(Severity::Warn, sentence);
            }
        }
    }
}

/// Fills in what was read first, in place of what is saved.
fn with_first(first: &mut Vec<(String, String)>, craft: &mut CraftSettings) {
    if first.is_empty() {
        *first = craft.all.iter().map(|setting| (setting.name.clone(), setting.value.clone())).collect();
        first.sort();
    }
    for setting in &mut craft.all {
        let at = first.binary_search_by(|(name, _)| name.cmp(&setting.name)).ok();
        setting.saved = at.and_then(|at| first.get(at)).map(|(_, value)| value.clone());
    }
}
