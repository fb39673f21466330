//! Parts of the state of a craft, in SI units, which both sides use.

use super::value::GpsFix;

/// A position on the globe.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct GeoPosition {
    /// Latitude, degrees.
    pub lat_deg: f64,
    /// Longitude, degrees.
    pub lon_deg: f64,
    /// Altitude above sea level, m.
    pub alt_amsl: f64,
}

/// The solution of a satellite receiver.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GpsState {
    /// The kind of solution.
    pub fix: GpsFix,
    /// The position.
    pub position: GeoPosition,
    /// Horizontal dilution of precision.
    pub hdop: Option<f64>,
    /// Vertical dilution of precision.
    pub vdop: Option<f64>,
    /// Speed over ground, m/s.
    pub speed: Option<f64>,
    /// Course over ground from north over east, rad.
    pub course: Option<f64>,
    /// Satellites in use.
    pub satellites: Option<u8>,
}

/// A battery.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct BatteryState {
    /// Voltage, V.
    pub voltage: f64,
    /// Current, A.
    pub current: Option<f64>,
    /// Charge that was drawn, mAh.
    pub drawn_mah: Option<f64>,
    /// Charge that remains, 0…1.
    pub remaining: Option<f64>,
}

/// RC channels.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct RcState {
    /// The channels, µs.
    pub channels_us: [u16; 18],
    /// The number of channels that exist.
    pub count: u8,
    /// Signal strength, 0…1.
    pub rssi: Option<f64>,
}

/// The steering of a navigator.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct NavigationState {
    /// Distance to the target, m.
    pub distance: f64,
    /// Bearing of the target from north over east, rad.
    pub bearing: f64,
    /// Distance to the right of the leg, m.
    pub cross_track: f64,
    /// Altitude of the target above that of the craft, m.
    pub altitude_error: f64,
}
