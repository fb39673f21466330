//! The profile selectors.

use super::super::settings::Scope;
use super::session::{Session, integer};

pub(super) fn profile(session: &mut Session<'_>, rest: &str) {
    if !rest.is_empty() && session.refused_while_armed() {
        return;
    }
    select(session, rest, Scope::Profile, "PROFILE");
}

pub(super) fn rateprofile(session: &mut Session<'_>, rest: &str) {
    select(session, rest, Scope::RateProfile, "RATE PROFILE");
}

pub(super) fn battery_profile(session: &mut Session<'_>, rest: &str) {
    select(session, rest, Scope::BatteryProfile, "BATTERY PROFILE");
}

fn select(session: &mut Session<'_>, rest: &str, scope: Scope, title: &str) {
    if !rest.is_empty() {
        let Some(number) = session.understood(integer(rest)) else { return };
        let instance = u8::try_from(number).unwrap_or(u8::MAX);
        if !session.configuration.settings.select(scope, instance) {
            session.error(format_args!("{title} OUTSIDE OF [0..{}]", scope.instances() - 1));
            return;
        }
        session.interpreter.section = (scope, instance);
    }
    let active = session.configuration.settings.active(scope);
    session.line(format_args!("{} {active}", scope.word()));
}

/// `simplified_tuning apply | disable`: accepted, but the sliders have no effect here.
pub(super) fn simplified_tuning(session: &mut Session<'_>, word: &str) {
    let known = ["apply", "disable"].iter().any(|known| word.eq_ignore_ascii_case(known));
    if !known {
        session.not_understood();
    }
}
