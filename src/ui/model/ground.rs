//! The ground of the elevation tiles, as the screen knows it.

use std::sync::Arc;

use crate::geo::LatLon;
use crate::plan::FlightPlan;
use crate::plan::estimate::Assumptions;
use crate::plan::review::Finding;
use crate::terrain::{Relief, Tiles};
use crate::ui::model::config::GroundConfig;

/// The tiles that were read.
#[derive(Debug, Default)]
pub struct GroundState {
    /// Clearance above the ground below which a leg gets a warning, m.
    pub clearance_m: f64,
    pub(in crate::ui) tiles: Option<Arc<Tiles>>,
    pub(in crate::ui) can_read: bool,
    /// The home and the plan for which tiles were requested last.
    pub(in crate::ui) asked: Option<(LatLon, FlightPlan)>,
    /// The findings about low clearances, and their input. A look at the ground is too slow for each picture.
    pub(in crate::ui) low: Vec<Finding>,
    pub(in crate::ui) low_basis: Option<LowBasis>,
    /// The notice about unknown ground at home was given.
    pub(in crate::ui) is_home_unknown: bool,
}

/// The input of the findings about low clearances.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::ui) struct LowBasis {
    pub(in crate::ui) home: LatLon,
    pub(in crate::ui) plan: FlightPlan,
    pub(in crate::ui) assumptions: Assumptions,
    pub(in crate::ui) clearance_m: f64,
    pub(in crate::ui) tiles: usize,
    /// The number of points and the time of the flown estimate, s.
    pub(in crate::ui) estimate: Option<(usize, f64)>,
}

impl GroundState {
    pub(in crate::ui) fn new(config: GroundConfig) -> Self {
        let GroundConfig { clearance_m, tiles, can_read } = config;
        Self { clearance_m, tiles, can_read, ..Self::default() }
    }

    /// Returns the findings about low clearances of the open plan.
    pub(in crate::ui) fn low(&self) -> &[Finding] {
        &self.low
    }

    /// Returns the ground as seen from home, if the tiles know its height.
    pub(in crate::ui) fn relief(&self, home: LatLon) -> Option<Relief> {
        Relief::new(Arc::clone(self.tiles.as_ref()?), home)
    }
}
