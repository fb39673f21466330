//! Flights flown ahead of time on copies of the vehicle, in threads of their own: forecasts, sweeps of faults, go or no-go.

mod forecaster;
mod surveyor;
mod sweep_flights;

pub use forecaster::{ForecastJob, ForecastReply, ForecastRequest, Forecaster};
pub use surveyor::{SurveyJob, SurveyNews, SurveyReply, SurveyRequest, SurveyedPlan, Surveyor};
pub use sweep_flights::{SweepProblem, fly_sweep};

use crate::vehicle::Vehicle;

/// A copy of the vehicle for forecasts.
#[derive(Debug)]
pub struct VehicleCopy {
    pub vehicle: Box<Vehicle>,
    /// The altitude to which the scripted pilot climbs, m.
    pub takeoff_m: f64,
}
