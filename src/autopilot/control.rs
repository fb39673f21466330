//! Altitude, position and yaw control, shared by the autopilot and the firmware's hold modes.

mod altitude;
mod bumpless;
mod disturbance;
mod flight_controllers;
mod hover_throttle;
mod position;
mod spool_up;
mod tilt_limit;
mod yaw;

pub use altitude::{
    AltitudeController, AltitudeMeasurement, AltitudeTarget, THROTTLE_SLEW_US_PER_S, ThrottleTerms,
    throttle_share,
};
pub use bumpless::BumplessTransfer;
pub use disturbance::DisturbanceObserver;
pub use flight_controllers::FlightControllers;
pub use hover_throttle::{HOVER_MAX_US, HOVER_MIN_US, HoverMeasurement, HoverThrottleEstimator};
pub use position::{
    PositionController, PositionLaw, PositionMeasurement, PositionTarget, TILT_SLEW_RPS, earth_to_body,
};
pub use yaw::{YAW_SLEW_DPS2, YawController, YawFacts, desired_heading, yaw_rate_dps};
