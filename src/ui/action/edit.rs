//! The actions of the plan editor.

/// An action of the plan editor.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, strum::EnumIter)]
pub enum EditAction {
    /// Undo the last edit.
    #[default]
    Undo,
    /// Redo the edit.
    Redo,
    /// Choose a file to open.
    Open,
    /// Write the plan to its file.
    Save,
    /// Write the plan to another file.
    SaveAs,
    /// Begin a new plan.
    New,
    Close,
    /// Show the next open plan.
    NextPlan,
    /// Show the previous open plan.
    PreviousPlan,
    /// Download the plan of the craft.
    Download,
    /// Save the configuration of the craft.
    SaveToFlash,
    /// Move one column to the left.
    Left,
    /// Move one column to the right.
    Right,
    /// Type the value, or choose the next name.
    Cell,
    /// Raise the value a little.
    Raise,
    /// Lower the value a little.
    Lower,
    /// Raise the value a lot.
    RaiseMuch,
    /// Lower the value a lot.
    LowerMuch,
    Insert,
    Duplicate,
    /// Delete the selected waypoints.
    Delete,
    /// Move the selected waypoints up.
    MoveUp,
    /// Move the selected waypoints down.
    MoveDown,
    /// Begin or end a selection.
    Select,
    SelectAll,
    /// Copy the selected waypoints.
    Copy,
    /// Insert the copied waypoints.
    Paste,
    /// Change all selected waypoints at once.
    Bulk,
    Generate,
    /// Edit name, description, home and settings of the plan.
    Properties,
    /// Apply the offered fix.
    Fix,
    /// Edit on the map, or stop it.
    OnMap,
    /// Pick up or put down a waypoint on the map.
    Pick,
    /// Add a waypoint at the map's cursor.
    AddOnMap,
    /// Delete the waypoint at the map's cursor.
    DeleteOnMap,
}
