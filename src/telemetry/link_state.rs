//! Whether an external simulator speaks.

/// State of the link to an external simulator.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, strum::Display)]
pub enum LinkState {
    #[strum(to_string = "waiting for a simulator")]
    Waiting,
    #[strum(to_string = "flying")]
    Flowing,
    /// It has not spoken for a second.
    #[strum(to_string = "no FDM")]
    Silent,
}
