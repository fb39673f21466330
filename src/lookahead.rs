//! Flights flown ahead of time on copies of the vehicle, in threads of their own: forecasts, sweeps of faults, go or no-go.

mod fly_again;
mod forecaster;
mod surveyor;
mod sweep_flights;

pub use fly_again::{FlownAgain, FlyAgain, FlyingAgain, Progress};
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
    /// Flies its flight controller to the same instant, if that is an executable in simulated time.
    pub again: Option<FlyAgain>,
}
