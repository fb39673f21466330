//! The ground: its tangent plane below the craft, legs as springs and dampers, static friction.
//!
//! A point at a distance d below the plane is pushed along its normal by `max(0, k·d − c·v)`, where v is its speed
//! out of the ground. Along the plane it slides with Coulomb friction, regularised below a small speed. A point that
//! has become slow is latched at its place. The same spring and damper hold it there until the pull exceeds the
//! friction, so that a craft at rest does not creep in the wind.
//!
//! The hull is the four rotor hubs. It carries load like the legs, and ground contact of the hull is a crash.

use arrayvec::ArrayVec;
use nalgebra::{Matrix3, Vector2, Vector3};

use super::airframe::{Airframe, MAX_LEGS, ROTORS};
use super::body::{BodyState, Loads};
use super::landform::Landform;
use super::surface::TangentPlane;

/// The maximum number of contact points: legs first, then the hull.
const MAX_POINTS: usize = MAX_LEGS + ROTORS;
/// An upside-down craft with its centre of mass below this height is on its hull, m.
const INVERTED_HULL_M: f64 = 0.05;

/// The places at which the contact points are latched to the ground, metres east and north; `None` while a point
/// slides or is in the air.
pub(super) type ContactAnchors = [Option<Vector2<f64>>; MAX_POINTS];

/// The anchors of a craft that friction does not hold at any point.
pub(super) const NO_ANCHORS: ContactAnchors = [None; MAX_POINTS];

/// The contact model of one airframe.
#[derive(Debug, Clone)]
pub struct Ground {
    points: ArrayVec<Vector3<f64>, MAX_POINTS>,
    legs: usize,
    stiffness: f64,
    damping: f64,
    friction: f64,
    full_friction_mps: f64,
    reach: f64,
    landform: Landform,
}

/// The points that are on the ground.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GroundContact {
    /// `true` if at least one leg carries load.
    pub any_leg: bool,
    /// `true` if every leg carries load.
    pub all_legs: bool,
    /// `true` if the body touches the ground.
    pub hull: bool,
    /// Distance of the lowest point from the ground, m; high up, a lower bound.
    pub clearance_m: f64,
    /// The ground below the craft.
    pub plane: TangentPlane,
}

/// The heights of the contact points above the ground, m; high up, lower bounds.
struct Heights {
    lowest_leg: f64,
    highest_leg: f64,
    lowest_hull: f64,
    /// `true` if the craft lies on its back.
    is_inverted: bool,
}

/// Place and velocity of one contact point, ENU, and its distance from the ground.
struct Point {
    place: Vector3<f64>,
    vel: Vector3<f64>,
    distance_m: f64,
}

impl Ground {
    /// Returns the contact model of an airframe.
    pub fn new(airframe: &Airframe) -> Self {
        let points: ArrayVec<_, MAX_POINTS> =
            airframe.legs_m.iter().chain(&airframe.rotor_positions_m).copied().collect();
        let reach = points.iter().map(Vector3::norm).fold(0.0, f64::max);
        Self {
            points,
            legs: airframe.legs_m.len(),
            stiffness: airframe.leg_stiffness,
            damping: airframe.leg_damping,
            friction: airframe.friction,
            full_friction_mps: airframe.friction_full_mps,
            reach,
            landform: Landform::FLAT,
        }
    }

    pub(super) fn set_landform(&mut self, landform: Landform) {
        self.landform = landform;
    }

    #[doc(hidden)]
    pub fn landform(&self) -> &Landform {
        &self.landform
    }

    /// Returns the distance of the centre of mass from the ground above which no contact is possible, m.
    pub fn reach_m(&self) -> f64 {
        self.reach
    }

    /// Returns the contact force and torque on the body.
    pub(super) fn loads(
        &self,
        pos: &Vector3<f64>,
        vel: &Vector3<f64>,
        r: &Matrix3<f64>,
        rate: &Vector3<f64>,
        anchors: &ContactAnchors,
    ) -> Loads {
        let rate_enu = r * rate;
        let plane = self.landform.tangent_at(pos);
        let mut force = Vector3::zeros();
        let mut torque = Vector3::zeros();
        for (arm, anchor) in self.points.iter().zip(anchors) {
            let arm = r * arm;
            let place = pos + arm;
            let distance_m = plane.distance_m(&place);
            if distance_m >= 0.0 {
                continue;
            }
            let point = Point { place, vel: vel + rate_enu.cross(&arm), distance_m };
            let normal = self.normal_force(&plane, &point);
            let along = self.friction_force(&plane, &point, normal, anchor.as_ref());
            let push = plane.normal() * normal + along;
            force += push;
            torque += arm.cross(&push);
        }
        Loads { force_flu: r.tr_mul(&force), torque_flu: r.tr_mul(&torque) }
    }

    /// Latches points that have come to rest, and frees those that are pulled too hard or have left the ground.
    pub(super) fn update_anchors(&self, state: &BodyState, anchors: &mut ContactAnchors) {
        let plane = self.landform.tangent_at(&state.pos_enu);
        if plane.distance_m(&state.pos_enu) >= self.reach {
            return;
        }
        let r = state.attitude.to_rotation_matrix();
        let rate_enu = r * state.rate_flu;
        for (arm, anchor) in self.points.iter().zip(anchors) {
            let arm = r * arm;
            let place = state.pos_enu + arm;
            let distance_m = plane.distance_m(&place);
            let point = Point { place, vel: state.vel_enu + rate_enu.cross(&arm), distance_m };
            let limit = self.friction * self.normal_force(&plane, &point);
            *anchor = match *anchor {
                _ if limit <= 0.0 => None,
                Some(anchor) if self.holding_force(&plane, &point, &anchor).norm() <= limit => Some(anchor),
                None if plane.along(&point.vel).norm() < self.full_friction_mps => Some(point.place.xy()),
                Some(_) | None => None,
            };
        }
    }

    /// Returns the ground contact in a state.
    // Inlined, because the result would otherwise be copied through memory in every step.
    #[inline(always)]
    pub fn contact(&self, state: &BodyState) -> GroundContact {
        let plane = self.landform.tangent_at(&state.pos_enu);
        let centre_m = plane.distance_m(&state.pos_enu);
        let heights = if centre_m >= 2.0 * self.reach {
            let lowest = centre_m - self.reach;
            Heights { lowest_leg: lowest, highest_leg: lowest, lowest_hull: lowest, is_inverted: false }
        } else {
            self.heights(state, &plane, centre_m)
        };
        GroundContact {
            any_leg: heights.lowest_leg < 0.0,
            all_legs: heights.highest_leg < 0.0,
            hull: heights.is_inverted || heights.lowest_hull < 0.0,
            clearance_m: heights.lowest_leg.min(heights.lowest_hull),
            plane,
        }
    }

    /// Returns the heights of a craft whose centre of mass is `centre_m` above the plane.
    #[inline(never)]
    fn heights(&self, state: &BodyState, plane: &TangentPlane, centre_m: f64) -> Heights {
        let up = state.attitude.inverse_transform_vector(plane.normal());
        let height = |arm: &Vector3<f64>| centre_m + up.dot(arm);
        let (legs, hull) = self.points.split_at(self.legs);
        let lowest_hull = hull.iter().map(height).fold(f64::INFINITY, f64::min);
        let (mut lowest_leg, mut highest_leg) = (f64::INFINITY, f64::NEG_INFINITY);
        for height in legs.iter().map(height) {
            lowest_leg = height.min(lowest_leg);
            highest_leg = height.max(highest_leg);
        }
        let is_inverted = up.z < 0.0 && centre_m <= INVERTED_HULL_M;
        Heights { lowest_leg, highest_leg, lowest_hull, is_inverted }
    }

    fn normal_force(&self, plane: &TangentPlane, point: &Point) -> f64 {
        if point.distance_m >= 0.0 {
            return 0.0;
        }
        let speed = point.vel.dot(plane.normal());
        (-self.stiffness * point.distance_m - self.damping * speed).max(0.0)
    }

    fn friction_force(
        &self,
        plane: &TangentPlane,
        point: &Point,
        normal: f64,
        anchor: Option<&Vector2<f64>>,
    ) -> Vector3<f64> {
        let limit = self.friction * normal;
        if let Some(anchor) = anchor {
            return self.holding_force(plane, point, anchor).cap_magnitude(limit);
        }
        let vel = plane.along(&point.vel);
        // This is min(1, v/v_full) / v, without a division by zero.
        vel * (-limit / vel.norm().max(self.full_friction_mps))
    }

    fn holding_force(&self, plane: &TangentPlane, point: &Point, anchor: &Vector2<f64>) -> Vector3<f64> {
        let pull = plane.along(&(plane.point_at(anchor) - point.place));
        pull * self.stiffness - plane.along(&point.vel) * self.damping
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sim::body::AirSample;
    use crate::sim::plant::{Craft, Plant};
    use nalgebra::UnitQuaternion;
    use std::f64::consts::PI;

    /// Returns a craft at rest with its centre of mass at this height, m, rolled by this angle, rad.
    fn at(height_m: f64, roll_rad: f64) -> BodyState {
        BodyState {
            pos_enu: Vector3::new(0.0, 0.0, height_m),
            vel_enu: Vector3::zeros(),
            attitude: UnitQuaternion::from_axis_angle(&Vector3::x_axis(), roll_rad),
            rate_flu: Vector3::zeros(),
        }
    }

    /// One step of the simulation, s.
    const STEP_S: f64 = 0.000_5;
    const CALM: AirSample = AirSample { wind_enu: Vector3::new(0.0, 0.0, 0.0), density_ratio: 1.0 };

    /// An Iris with stopped rotors that rests on its legs.
    struct Resting {
        plant: Plant,
        craft: Craft,
    }

    impl Resting {
        fn new() -> Self {
            let airframe = Airframe::iris();
            let state = BodyState {
                pos_enu: Vector3::new(0.0, 0.0, 0.1985),
                vel_enu: Vector3::zeros(),
                attitude: UnitQuaternion::identity(),
                rate_flu: Vector3::zeros(),
            };
            let plant = Plant::new(&airframe, STEP_S);
            let mut resting = Self { plant, craft: Craft::new(state) };
            resting.run(1.0);
            resting
        }

        /// Simulates some seconds. Returns the largest turn from the heading at rest, rad.
        fn run(&mut self, seconds: f64) -> f64 {
            let mut largest_turn_rad = 0.0_f64;
            for _ in 0..(seconds / STEP_S).round() as usize {
                let Self { plant, craft } = self;
                let present = plant.present(craft, &CALM);
                plant.step(craft, &[0.0; ROTORS], &CALM, &present);
                largest_turn_rad = largest_turn_rad.max(craft.body().attitude.euler_angles().2.abs());
            }
            largest_turn_rad
        }

        /// Returns the number of points that friction holds.
        fn held(&self) -> usize {
            self.craft.anchors.iter().flatten().count()
        }
    }

    #[test]
    fn a_craft_on_its_back_is_on_its_hull_and_one_on_its_legs_is_not() {
        for airframe in [Airframe::iris(), Airframe::five_inch()] {
            let ground = Ground::new(&airframe);
            let standing = ground.contact(&at(airframe.standing_height_m(), 0.0));
            assert!(standing.all_legs && !standing.hull, "{}", airframe.name);
            // The rotors and the battery keep the centre of mass off the ground.
            let on_its_back = ground.contact(&at(0.03, PI));
            assert!(on_its_back.hull && !on_its_back.any_leg, "{}", airframe.name);
            let above = ground.contact(&at(0.1, PI));
            assert!(!above.hull && !above.any_leg, "{}", airframe.name);
        }
    }

    #[test]
    fn a_craft_dropped_on_its_back_comes_to_rest_on_its_rotors() {
        let airframe = Airframe::iris();
        let plant = Plant::new(&airframe, 0.001);
        let air = AirSample { wind_enu: Vector3::zeros(), density_ratio: 1.0 };
        let mut craft = Craft::new(at(0.1, PI));
        for _ in 0..2000 {
            let present = plant.present(&craft, &air);
            plant.step(&mut craft, &[0.0; ROTORS], &air, &present);
        }
        let state = *craft.body();
        let height_m = state.pos_enu.z;
        assert!((0.01..0.02).contains(&height_m), "{height_m} m");
        assert!(state.vel_enu.norm() < 0.01 && state.rate_flu.norm() < 0.01, "{state:?}");
        assert!((state.attitude * Vector3::z()).z < -0.99);
        assert!(plant.ground().contact(&state).hull);
    }

    #[test]
    fn a_craft_twisted_on_its_legs_comes_to_rest() {
        let mut craft = Resting::new();
        assert_eq!(craft.held(), 4, "friction holds every leg");
        // A third of a millimetre at each leg, which friction can hold.
        let twist_rad = 0.001;
        let mut twisted = *craft.craft.body();
        twisted.attitude = UnitQuaternion::from_euler_angles(0.0, 0.0, twist_rad) * twisted.attitude;
        craft.craft.set_body(twisted);
        craft.run(0.1);
        assert_eq!(craft.held(), 4, "no leg has slid");
        let rocking_rad = craft.run(0.1);
        assert!(rocking_rad < 0.1 * twist_rad, "the legs damp it: {rocking_rad}");
    }

    #[test]
    fn a_craft_high_up_is_no_nearer_to_the_ground_than_its_clearance() {
        for airframe in [Airframe::iris(), Airframe::five_inch()] {
            let ground = Ground::new(&airframe);
            for height_m in [1.0, 10.0, 100.0] {
                for roll_rad in [0.0, 0.5, PI] {
                    let contact = ground.contact(&at(height_m, roll_rad));
                    assert!(!contact.any_leg && !contact.all_legs && !contact.hull);
                    let below_m = height_m - contact.clearance_m;
                    assert!((0.0..1.0).contains(&below_m), "{} at {height_m} m: {below_m}", airframe.name);
                }
                let level = ground.contact(&at(height_m, 0.0)).clearance_m;
                assert!(level <= height_m - airframe.standing_height_m() + 1e-9, "{level}");
            }
        }
    }
}
