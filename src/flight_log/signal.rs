//! The named numbers of a log.

/// A number of a log that changes in flight.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LogSignal {
    /// The written name: of a derived signal that of `telemetry`'s signals or a similar one, of a field that of the header,
    /// for example `gyroADC[0]`.
    pub name: String,
    /// The unit, for example `°/s`; empty for a number without a unit, and for a field with an unknown one.
    pub unit: &'static str,
    /// The frame that has the field; `None` if the value is derived.
    pub frame: Option<SignalFrame>,
}

/// The kinds of frames with fields that change in flight.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SignalFrame {
    Main,
    Slow,
    Gps,
}

/// The smallest and the greatest value in a part of a log.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Extent {
    pub min: f64,
    pub max: f64,
}
