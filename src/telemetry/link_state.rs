//! The state of the link to an external simulator.

/// The state of the link to an external simulator.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, strum::Display)]
pub enum LinkState {
    /// No packet has arrived.
    #[strum(to_string = "waiting for a simulator")]
    Waiting,
    /// Packets arrive.
    #[strum(to_string = "flying")]
    Flowing,
    /// It has sent nothing for a second.
    #[strum(to_string = "no FDM")]
    Silent,
}
