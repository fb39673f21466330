//! Values that an update computes once from inputs, plan and leg.

use nalgebra::Vector2;

use super::cursor::PlanCursor;
use super::leg::{CO_LOCATED_M, Leg};
use crate::autopilot::io::NavInputs;
use crate::autopilot::params::Params;
use crate::geo::local_offset;

/// The inputs of an update, and the position of the craft relative to its leg and to home; north, east, m.
#[derive(Debug, Clone, Copy)]
pub(super) struct Observed<'a> {
    pub now: &'a NavInputs,
    pub params: &'a Params,
    /// Waypoint of the leg.
    pub waypoint_ne: Vector2<f64>,
    /// Start of the leg.
    pub start_ne: Vector2<f64>,
    /// Offset from the craft to the waypoint.
    pub to_waypoint: Vector2<f64>,
    /// Distance to the waypoint.
    pub distance_m: f64,
    /// Ground speed, m/s.
    pub ground_speed_mps: f64,
    /// Distance from home, if home is known.
    pub home_distance_m: Option<f64>,
    /// `true` if no positional waypoint follows.
    pub is_last: bool,
    /// `true` if the next positional waypoint is at the place of the current one.
    pub is_co_located: bool,
    /// `true` if the pilot moves roll or pitch.
    pub stick_override: bool,
}

impl<'a> Observed<'a> {
    pub(super) fn new(now: &'a NavInputs, params: &'a Params, cursor: &PlanCursor, leg: &Leg) -> Self {
        let waypoint_ne = local_offset(now.origin, leg.waypoint);
        let to_waypoint = waypoint_ne - now.pos_ne;
        let following = cursor.following();
        let deadband = f64::from(params.stick_deadband);
        Self {
            now,
            params,
            waypoint_ne,
            start_ne: local_offset(now.origin, leg.start),
            to_waypoint,
            distance_m: to_waypoint.norm(),
            ground_speed_mps: now.vel_ne.norm(),
            home_distance_m: now.home.map(|home| (local_offset(now.origin, home) - now.pos_ne).norm()),
            is_last: following.is_none(),
            is_co_located: following.and_then(|index| cursor.waypoint(index)).is_some_and(|next| {
                let position = if next.kind.uses_position() { next.position } else { leg.waypoint };
                local_offset(leg.waypoint, position).norm() < CO_LOCATED_M
            }),
            stick_override: now.stick_roll.abs() > deadband || now.stick_pitch.abs() > deadband,
        }
    }
}
