//! The closest approach to a waypoint on the way to it.

use nalgebra::Vector2;

use super::craft::CraftTruth;
use crate::signals::SimTime;

/// The closest approach so far; `None` while the pilot flew or the craft climbed on the spot.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct ClosestApproach(Option<(f64, SimTime)>);

impl ClosestApproach {
    pub(super) fn look(&mut self, craft: &CraftTruth, target_ne: Vector2<f64>) {
        if craft.stick_override || craft.climbing {
            return;
        }
        let distance = (craft.ne - target_ne).norm();
        if self.0.is_none_or(|(closest, _)| distance < closest) {
            self.0 = Some((distance, craft.time));
        }
    }

    /// Returns the distance, m, and its time.
    pub(super) fn get(self) -> Option<(f64, SimTime)> {
        self.0
    }
}
