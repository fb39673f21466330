//! The square: the guide's corners and settings, lower and with a shorter hold, so that a flight takes a minute and a
//! half; and the check of a flight.

use betadeck::geo::LocalFrame;
use nalgebra::Vector2;

/// Height of the flight, m.
pub(crate) const HEIGHT_M: f64 = 20.0;

/// Corners: latitude, longitude, degrees.
const CORNERS: [(f64, f64); 4] =
    [(40.4640, -79.5175), (40.4630, -79.5175), (40.4630, -79.5190), (40.4640, -79.5190)];

/// Returns the lines that are typed into the craft.
pub(crate) fn lines() -> String {
    let mut text = String::from(
        "aux 0 0 0 1700 2100 0 0\n\
         aux 1 56 1 1700 2100 0 0\n\
         aux 2 1 2 1700 2100 0 0\n\
         aux 3 3 2 1700 2100 0 0\n\
         aux 4 11 2 1700 2100 0 0\n\
         set ap_position_p = 40\n\
         set ap_position_i = 10\n\
         set ap_position_d = 30\n\
         set ap_position_a = 20\n\
         set ap_position_cutoff = 5\n\
         set ap_altitude_p = 50\n\
         set ap_altitude_i = 30\n\
         set ap_altitude_d = 20\n\
         set ap_altitude_f = 10\n\
         set ap_hover_throttle = 1500\n\
         set ap_max_angle = 25\n\
         set ap_l1_period = 20\n\
         set ap_l1_min_lookahead = 1000\n\
         set ap_landing_descent_rate = 100\n\
         waypoint clear\n",
    );
    let kinds = ["FLYOVER 0", "FLYBY 0", "HOLD 50", "LAND 0"];
    for (index, ((lat, lon), kind)) in std::iter::zip(CORNERS, kinds).enumerate() {
        let alt_cm = HEIGHT_M * 100.0;
        text += &format!("waypoint insert {index} {lat:.7} {lon:.7} {alt_cm} 0 {kind} ORBIT\n");
    }
    text + "save\n"
}

/// The true distances of the craft from the corners, and its height error on the way between them.
#[derive(Debug, Clone)]
pub(crate) struct Flown {
    corners: [Vector2<f64>; 4],
    /// The least distance to each corner, m.
    pub(crate) nearest_m: [f64; 4],
    /// The corners in the order in which the craft came near them.
    pub(crate) order: Vec<usize>,
    /// The greatest distance from the height of the plan between the second and the last corner, m.
    pub(crate) height_error_m: f64,
    /// The greatest distance from home, m.
    pub(crate) farthest_m: f64,
    /// The distance from the final position to the last corner, m.
    pub(crate) landed_m: f64,
    /// The speed at the touchdown, m/s.
    pub(crate) impact_mps: f64,
}

/// The distance below which a corner counts as visited, m. It is large because the turn of the FLYBY is cut.
const VISIT_M: f64 = 25.0;

impl Flown {
    /// Returns an empty record, in a world with this frame.
    pub(crate) fn new(frame: &LocalFrame) -> Self {
        let corners = CORNERS.map(|(lat, lon)| frame.to_enu(lat, lon, frame.alt_amsl_m).xy());
        Self {
            corners,
            nearest_m: [f64::INFINITY; 4],
            order: Vec::new(),
            height_error_m: 0.0,
            farthest_m: 0.0,
            landed_m: f64::INFINITY,
            impact_mps: 0.0,
        }
    }

    /// Records a position of the craft: east and north of home, and height above it, m.
    pub(crate) fn look(&mut self, place: Vector2<f64>, height_m: f64) {
        for (index, corner) in self.corners.iter().enumerate() {
            let distance = (place - corner).norm();
            self.nearest_m[index] = self.nearest_m[index].min(distance);
            if distance < VISIT_M && self.order.last() != Some(&index) {
                self.order.push(index);
            }
        }
        let between = self.order.contains(&1) && !self.order.contains(&3);
        if between {
            self.height_error_m = self.height_error_m.max((height_m - HEIGHT_M).abs());
        }
        self.farthest_m = self.farthest_m.max(place.norm());
        self.landed_m = (place - self.corners[3]).norm();
    }

    /// Asserts that the square was flown within these errors.
    #[track_caller]
    pub(crate) fn is_the_square(&self, bounds: &Bounds) {
        let [flyover, flyby, hold, _] = self.nearest_m;
        assert_eq!(self.order, [0, 1, 2, 3], "{self:?}");
        assert!(flyover <= bounds.flyover_m, "{self:?}");
        assert!(flyby <= VISIT_M, "{self:?}");
        assert!(hold <= bounds.hold_m, "{self:?}");
        assert!(self.landed_m <= bounds.land_m, "{self:?}");
        assert!(self.height_error_m <= bounds.height_m, "{self:?}");
        assert!(self.impact_mps <= bounds.impact_mps, "{self:?}");
        assert!(self.farthest_m <= 160.0, "{self:?}");
    }
}

/// The allowed errors of a flight.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Bounds {
    /// The distance at the FLYOVER, m.
    pub(crate) flyover_m: f64,
    /// The least distance to the HOLD, which is entered, m.
    pub(crate) hold_m: f64,
    /// The distance of the touchdown from the LAND, m.
    pub(crate) land_m: f64,
    /// The height on the legs, m.
    pub(crate) height_m: f64,
    /// The speed of the touchdown, m/s.
    pub(crate) impact_mps: f64,
}
