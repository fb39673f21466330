//! The actions of the plan editor.

use super::Context;
use super::rows::actions;
use crate::ui::model::action::Context::{Global, In};
use crate::ui::model::panel_table::Panel;

const MAP_PANEL: Context = In(Panel::Map);
const PLAN_PANEL: Context = In(Panel::Plan);

actions! {
    /// An action of the plan editor.
    EditAction {}
    EVERYWHERE {
        Download Global "plan.download" "download" "Load the plan of the craft into the editor" ["D"];
        SaveToFlash Global "plan.flash" "flash" "Save plan and settings in the craft's flash" ["W"];
        Undo Global "plan.undo" "undo" "Undo the last edit of the plan" ["u"];
        Redo Global "plan.redo" "redo" "Redo the edit that was undone" ["ctrl-r"];
        Earlier Global "plan.earlier" "earlier revision"
            "The revision made before this one, in any branch" ["alt-u"];
        Later Global "plan.later" "later revision"
            "The revision made after this one, in any branch" ["alt-U"];
        Compare Global "plan.compare" "differences"
            "The plan beside the craft's, its file or a revision, with a map" ["V"];
        Open Global "plan.open" "open" "Open a plan file" ["o"];
        Save Global "plan.save" "save" "Save the plan in its file" ["s"];
    }
    MAP {
        OnMap MAP_PANEL "map.edit" "edit" "Edit waypoints on the map with a cursor, or stop it" ["p"];
        Pick MAP_PANEL "map.pick" "pick" "Pick up the waypoint at the cursor, or put it down" ["enter"];
        AddOnMap MAP_PANEL "map.insert" "insert" "Add a waypoint at the cursor" ["i"];
        DeleteOnMap MAP_PANEL "map.delete" "delete" "Delete the waypoint at the cursor" ["d", "delete"];
    }
    PLAN {
        Left PLAN_PANEL "plan.left" "left" "The value to the left" ["left", "h"];
        Right PLAN_PANEL "plan.right" "right" "The value to the right" ["right", "l"];
        Cell PLAN_PANEL "plan.edit" "edit" "Type the value, as a digit does; a type or pattern goes on to the next" ["enter"];
        Raise PLAN_PANEL "plan.raise" "raise" "Raise the value: 1 m, 0.5 m/s, 1 s (1 ft, 1 mph)" ["+", "="];
        Lower PLAN_PANEL "plan.lower" "lower" "Lower the value" ["-"];
        RaiseMuch PLAN_PANEL "plan.raise-much" "raise much" "Raise the value ten times as much" ["shift-up"];
        LowerMuch PLAN_PANEL "plan.lower-much" "lower much" "Lower the value ten times as much" ["shift-down"];
        Insert PLAN_PANEL "plan.insert" "insert" "Insert a waypoint after this one" ["i"];
        Duplicate PLAN_PANEL "plan.duplicate" "duplicate" "Repeat this waypoint" ["c"];
        Delete PLAN_PANEL "plan.delete" "delete" "Delete the selected waypoints" ["d", "delete"];
        MoveUp PLAN_PANEL "plan.move-up" "move up"
            "Move the selected waypoints up in the order of flight" ["alt-up", "alt-k"];
        MoveDown PLAN_PANEL "plan.move-down" "move down"
            "Move the selected waypoints down in the order of flight" ["alt-down", "alt-j"];
        Select PLAN_PANEL "plan.select" "select" "Begin a selection here, or end it" ["v"];
        SelectAll PLAN_PANEL "plan.select-all" "select all" "Select all waypoints" ["ctrl-a"];
        Copy PLAN_PANEL "plan.copy" "copy" "Copy the selected waypoints, to the terminal's clipboard too" ["y"];
        Paste PLAN_PANEL "plan.paste" "paste" "Insert the copies" ["p"];
        Bulk PLAN_PANEL "plan.change" "change"
            "Change the selected waypoints: altitude, speed, move, rotate, mirror, reverse" ["m"];
        Generate PLAN_PANEL "plan.generate" "generate" "Generate a square, circle, zig-zag or survey" ["P"];
        Properties PLAN_PANEL "plan.properties" "properties" "Name, description, home and settings of the plan" ["E"];
        Fix PLAN_PANEL "plan.fix" "fix" "Apply the suggested edit" ["f"];
        SaveAs PLAN_PANEL "plan.save-as" "save as" "Save the plan in another file" ["S"];
        New PLAN_PANEL "plan.new" "new" "Begin a new plan" ["n"];
        Close PLAN_PANEL "plan.close" "close" "Close the plan (asks while it has unsaved edits)" ["ctrl-w"];
        NextPlan PLAN_PANEL "plan.next" "next plan" "Show the next open plan" [")"];
        PreviousPlan PLAN_PANEL "plan.previous" "previous plan" "Show the previous open plan" ["("];
    }
}
