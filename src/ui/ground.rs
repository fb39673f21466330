//! The ground of the elevation tiles, as the screen knows it.

mod under;

use std::sync::Arc;

use super::config::GroundConfig;
use crate::geo::LatLon;
use crate::plan::FlightPlan;
use crate::plan::estimate::Assumptions;
use crate::plan::review::Finding;
use crate::terrain::{Relief, Tiles};
pub(super) use under::{above_home_m, agl_m, follow_clearance, follow_plan, read, relief};

/// The tiles that were read.
#[derive(Debug, Default)]
pub struct GroundState {
    /// Clearance above the ground below which a leg gets a warning, m.
    pub clearance_m: f64,
    tiles: Option<Arc<Tiles>>,
    can_read: bool,
    /// The home and the plan for which tiles were requested last.
    asked: Option<(LatLon, FlightPlan)>,
    /// The findings about low clearances, and their input. A look at the ground is too slow for each picture.
    low: Vec<Finding>,
    low_basis: Option<LowBasis>,
    /// The notice about unknown ground at home was given.
    is_home_unknown: bool,
}

/// The input of the findings about low clearances.
#[derive(Debug, Clone, PartialEq)]
struct LowBasis {
    home: LatLon,
    plan: FlightPlan,
    assumptions: Assumptions,
    clearance_m: f64,
    tiles: usize,
    /// The number of points and the time of the flown estimate, s.
    estimate: Option<(usize, f64)>,
}

impl GroundState {
    pub(super) fn new(config: GroundConfig) -> Self {
        let GroundConfig { clearance_m, tiles, can_read } = config;
        Self { clearance_m, tiles, can_read, ..Self::default() }
    }

    /// Returns the findings about low clearances of the open plan.
    pub(super) fn low(&self) -> &[Finding] {
        &self.low
    }

    /// Returns the ground as seen from home, if the tiles know its height.
    pub(super) fn relief(&self, home: LatLon) -> Option<Relief> {
        Relief::new(Arc::clone(self.tiles.as_ref()?), home)
    }
}
