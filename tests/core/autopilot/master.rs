//! The profile `master` in flight, in the simulated world.

use betadeck_core::autopilot::Params;
use betadeck_core::flight::{Flight, FlightOptions, FlightResult, FlightSetup};
use betadeck_core::telemetry::FirmwareProfile;
