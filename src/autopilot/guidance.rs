//! Pure geometry of legs, corners, hold patterns and landings. Metres and radians in the local frame (north, east),
//! altitudes above home.

mod corner;
mod l1;
mod landing;
mod pattern;
mod speed;

pub use corner::{PlaneCrossing, plane_crossing, turn_radius_m};
pub use l1::{CornerArc, L1Limits, L1Result, l1};
pub use landing::{Spiral, landing_setpoint_m, spiral_offset};
pub use pattern::{PatternPoint, figure8, hold_remaining_s, orbit, pattern_rate_rps};
pub use speed::{leg_speed_mps, stop_speed_mps};
