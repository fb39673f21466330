//! The intent of an action, by which the session's policy allows it or refuses it.

use crate::fc::Impact;
use crate::session::policy::Intent;
use crate::ui::shared::Shared;

use crate::ui::model::action::{Action, EditAction, PanelAction};

/// Returns the intent of an action.
pub(in crate::ui) fn intent_of(state: &Shared, action: Action) -> Intent {
    match action {
        Action::Pause | Action::Step | Action::Tick | Action::Slower | Action::Faster | Action::RealTime => {
            Intent::Time
        }
        Action::EventBack
        | Action::EventForward
        | Action::StateBack
        | Action::StateForward
        | Action::Earlier
        | Action::Later
        | Action::Newest => Intent::Recording,
        Action::NextFlight | Action::PreviousFlight => Intent::OtherFlight,
        Action::FlyOn => Intent::FlyOn,
        Action::Fly => Intent::Fly,
        Action::Arm | Action::Throttle | Action::Autopilot | Action::ReturnHome | Action::CutRc => {
            Intent::Move
        }
        Action::GoTo | Action::HoldHere | Action::Resume => Intent::Order,
        Action::ResetCraft => Intent::Reset,
        Action::Upload => Intent::Upload,
        Action::Edit(EditAction::Download) => Intent::Download,
        Action::Edit(EditAction::SaveToFlash) => Intent::Save,
        // Ending it needs no flight.
        Action::LookAhead if state.forecast.looks_ahead() => Intent::Read,
        // So does ending the survey.
        Action::WhereMay if state.survey.sweep().is_some() => Intent::Read,
        Action::LookAhead | Action::WhatIf => Intent::FlyAhead,
        Action::WhereMay | Action::GoNoGo => Intent::Forecast,
        Action::Panel(action) => of_panel(action),
        _ => Intent::Read,
    }
}

fn of_panel(action: PanelAction) -> Intent {
    match action {
        PanelAction::Lower
        | PanelAction::Raise
        | PanelAction::LowerMuch
        | PanelAction::RaiseMuch
        | PanelAction::Flip
        | PanelAction::Record
        | PanelAction::Play => Intent::Move,
        PanelAction::KnobLess
        | PanelAction::KnobMore
        | PanelAction::KnobEnter
        | PanelAction::KnobEdit
        | PanelAction::KnobDefault => Intent::World,
        PanelAction::SettingMore
        | PanelAction::SettingLess
        | PanelAction::SettingMoreMuch
        | PanelAction::SettingLessMuch
        | PanelAction::SettingEdit
        | PanelAction::SettingType
        | PanelAction::SettingDefault
        | PanelAction::AllDefault
        | PanelAction::SettingUndo
        | PanelAction::SettingRedo => Intent::Line(Impact::Changes),
        PanelAction::ReadSettings => Intent::Line(Impact::Reads),
        PanelAction::SettingTry => Intent::Forecast,
        _ => Intent::Read,
    }
}
