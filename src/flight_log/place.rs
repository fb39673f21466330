//! Home and the track of a log.

use crate::geo::LatLon;
use crate::signals::SimTime;

/// The home of a log.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LogHome {
    pub position: LatLon,
    /// Above mean sea level, m; `None` if neither the log's home nor a fix has an altitude.
    pub alt_amsl_m: Option<f64>,
}

/// One place of the track.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TrackFix {
    pub time: SimTime,
    pub position: LatLon,
    /// Above mean sea level, m, if the GPS reports it.
    pub alt_amsl_m: Option<f64>,
    /// Above home, m: by the barometer, else by the GPS.
    pub alt_m: Option<f64>,
    /// Speed over ground, m/s.
    pub ground_speed_mps: Option<f64>,
}
