//! The ground of the elevation tiles, as the screen knows it.

mod under;

use std::sync::Arc;

use super::config::GroundConfig;
use crate::geo::LatLon;
use crate::plan::FlightPlan;
use crate::terrain::{Relief, Tiles};
pub(super) use under::{above_home_m, agl_m, follow_plan, read, relief};

/// The tiles that were read.
#[derive(Debug, Default)]
pub struct GroundState {
    /// Clearance above the ground below which a leg gets a warning, m.
    pub clearance_m: f64,
    tiles: Option<Arc<Tiles>>,
    can_read: bool,
    /// The home and the plan for which tiles were requested last.
    asked: Option<(LatLon, FlightPlan)>,
}

impl GroundState {
    pub(super) fn new(config: GroundConfig) -> Self {
        let GroundConfig { clearance_m, tiles, can_read } = config;
        Self { clearance_m, tiles, can_read, asked: None }
    }

    /// Returns the ground as seen from home, if the tiles know its height.
    pub(super) fn relief(&self, home: LatLon) -> Option<Relief> {
        Relief::new(Arc::clone(self.tiles.as_ref()?), home)
    }
}
