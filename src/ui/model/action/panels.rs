//! The actions of single panels.

use super::Context;
use super::rows::actions;
use crate::ui::model::action::Context::In;
use crate::ui::model::panel_table::Panel;

const MAP: Context = In(Panel::Map);
const RC: Context = In(Panel::Rc);
const GRAPHS: Context = In(Panel::Graphs);
const WORLD: Context = In(Panel::World);
const STATE: Context = In(Panel::State);
const LOG: Context = In(Panel::Log);
const SETTINGS: Context = In(Panel::Settings);

actions! {
    /// An action of one panel.
    PanelAction {}
    ON_MAP {
        PanUp MAP "map.up" "up" "Pan up" ["up", "k"];
        PanDown MAP "map.down" "down" "Pan down" ["down", "j"];
        PanLeft MAP "map.left" "left" "Pan left" ["left", "h"];
        PanRight MAP "map.right" "right" "Pan right" ["right", "l"];
        ZoomIn MAP "map.zoom-in" "zoom in" "Zoom in (or the mouse wheel)" ["+", "="];
        ZoomOut MAP "map.zoom-out" "zoom out" "Zoom out" ["-"];
        Follow MAP "map.follow" "follow" "Keep the craft in the middle" ["f"];
        Fit MAP "map.fit" "fit" "Show the whole plan" ["0"];
        CourseUp MAP "map.course-up" "course up" "The course of the craft up, or north again" ["c"];
        NextWaypoint MAP "map.next" "next waypoint" "To the next waypoint: the cursor, or the map" ["n"];
        PreviousWaypoint MAP "map.previous" "waypoint before" "To the waypoint before it" ["N"];
        PastTracks MAP "map.past" "earlier flights" "Show or hide the tracks of earlier flights" ["v"];
        Measure MAP "map.measure" "measure" "Measure between two points (Enter or a click sets them), or end it" ["m"];
        Grid MAP "map.grid" "grid" "Show or hide the grid of coordinates" ["#"];
        Backdrop MAP "map.backdrop" "backdrop" "Show a file with fields, roads or zones under the plan" ["B"];
    }
    OTHERS {
        ChannelUp RC "rc.up" "channel above" "Select the channel above" ["up", "k"];
        ChannelDown RC "rc.down" "channel below" "Select the channel below" ["down", "j"];
        Lower RC "rc.lower" "lower" "Lower the channel by 10 µs" ["left", "h", "-"];
        Raise RC "rc.raise" "raise" "Raise the channel by 10 µs" ["right", "l", "+"];
        LowerMuch RC "rc.lower-much" "lower much" "Lower the channel by 100 µs" ["pagedown", "shift-left"];
        RaiseMuch RC "rc.raise-much" "raise much" "Raise the channel by 100 µs" ["pageup", "shift-right"];
        Flip RC "rc.flip" "flip" "Flip the switch, or centre the stick" ["enter"];
        Record RC "rc.record" "record" "Record the sticks, or end that" ["r"];
        Play RC "rc.play" "play" "Play the recorded sticks again, or stop" ["p"];
        CursorBack GRAPHS "graphs.earlier" "earlier" "The cursor to an earlier instant" ["left", "h"];
        CursorOn GRAPHS "graphs.later" "later" "The cursor to a later instant" ["right", "l"];
        SpanLess GRAPHS "graphs.shorter" "shorter" "A shorter time" ["+", "="];
        SpanMore GRAPHS "graphs.longer" "longer" "A longer time, up to two hours" ["-"];
        ChoosePlots GRAPHS "graphs.choose" "choose" "Choose what is shown" ["enter"];
        ChooseSignals GRAPHS "graphs.series" "find a signal" "Search the signals by name or meaning, and show them" ["/"];
        CursorOff GRAPHS "graphs.live" "live" "No cursor: the newest instant" ["0", "end"];
        KnobUp WORLD "world.up" "knob above" "Select the knob above" ["up", "k"];
        KnobDown WORLD "world.down" "knob below" "Select the knob below" ["down", "j"];
        KnobLess WORLD "world.less" "less" "Less of it, or end the fault" ["left", "h", "-"];
        KnobMore WORLD "world.more" "more" "More of it, or begin the fault" ["right", "l", "+"];
        KnobEnter WORLD "world.change" "change" "Type a number, change a level, begin or end a fault" ["enter"];
        KnobEdit WORLD "world.type" "type" "Type the value, of a fault SECONDS,VALUE" ["="];
        KnobDefault WORLD "world.default" "default" "Back to its default" ["delete", "backspace"];
        SearchTransitions STATE "state.search" "search" "Only transitions with these words: Enter keeps it, Esc ends it" ["/"];
        NextTransition STATE "state.next" "next match" "To the next older match" ["n"];
        PreviousTransition STATE "state.previous" "previous match" "To the next newer match" ["N"];
        ExplainGuards STATE "state.explain" "explain" "Explain the guards and the abbreviations" ["enter"];
        Search LOG "log.search" "search" "Only lines with a text: Enter keeps it, Esc shows all" ["/"];
        NextMatch LOG "log.next" "next match" "To the next older match" ["n"];
        PreviousMatch LOG "log.previous" "previous match" "To the next newer match" ["N"];
        Filter LOG "log.filter" "filter" "Everything, warnings and faults, faults" ["f"];
    }
    ON_SETTINGS {
        SettingSearch SETTINGS "settings.search" "search"
            "Search in names and descriptions: Enter keeps it, Esc leaves" ["/"];
        NextSetting SETTINGS "settings.next" "next match" "To the next match" ["n"];
        PreviousSetting SETTINGS "settings.previous" "previous match" "To the previous match" ["N"];
        NextGroup SETTINGS "settings.next-group" "next group" "To the next group" [")"];
        PreviousGroup SETTINGS "settings.previous-group" "previous group" "To the previous group" ["("];
        SettingEdit SETTINGS "settings.edit" "edit" "Type a value, as a digit does, or switch a switch" ["enter"];
        SettingType SETTINGS "settings.type" "type" "Type a value" ["="];
        SettingMore SETTINGS "settings.raise" "raise" "Raise the value, or take the next word" ["+", "right", "l"];
        SettingLess SETTINGS "settings.lower" "lower" "Lower the value, or take the word before" ["-", "left", "h"];
        SettingMoreMuch SETTINGS "settings.raise-much" "raise much" "Raise the value ten times as much"
            ["shift-up", "shift-right"];
        SettingLessMuch SETTINGS "settings.lower-much" "lower much" "Lower the value ten times as much"
            ["shift-down", "shift-left"];
        SettingDefault SETTINGS "settings.default" "default" "Back to its default" ["delete", "backspace"];
        AllDefault SETTINGS "settings.default-all" "all defaults" "All settings back to their defaults (asks)" ["X"];
        SettingTry SETTINGS "settings.try" "what it changes"
            "Fly ahead with another value and without it: both tracks, time, battery, cross-track" ["w"];
        SettingUndo SETTINGS "settings.undo" "undo" "Undo the last change of a setting" ["u"];
        SettingRedo SETTINGS "settings.redo" "redo" "Redo the change that was undone" ["ctrl-r"];
        SettingCompare SETTINGS "settings.compare" "differences"
            "Only what differs from the defaults, from the plan, from the craft's flash; all again" ["f"];
        SettingsBeside SETTINGS "settings.beside" "side by side"
            "The settings beside the defaults, the plan's or the craft's flash" ["V"];
        CopySettings SETTINGS "settings.copy" "copy" "Copy the changed or found settings as CLI lines" ["y"];
        SettingIntoPlan SETTINGS "settings.into-plan" "into plan" "The plan sets this one at its upload" ["p"];
        SettingsIntoPlan SETTINGS "settings.all-into-plan" "all into plan"
            "The plan sets the changed or found settings at its upload" ["P"];
        SettingsFile SETTINGS "settings.save" "save" "Save the changed settings in a file for --settings" ["s"];
        ReadSettings SETTINGS "settings.read" "read" "Read all settings of the craft again" ["r"];
    }
}
