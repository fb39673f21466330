//! Places and directions on the earth and on the body.

use betadeck_core::autopilot::control::earth_to_body;
use betadeck_core::geo::{distance_bearing, local_offset, offset_to_latlon};
use nalgebra::Vector2;

use crate::autopilot::vectors::{cases, close, close_angle, close_place, num, point};

#[test]
fn distance_and_bearing() {
    for case in cases("distance_bearing", "cases") {
        let (distance, bearing) = distance_bearing(point(&case["from"]), point(&case["to"]));
        let want = num(&case, "distance_cm");
        close(distance * 100.0, want, (want * 5e-4).max(1.0), &case);
        if want > 0.0 {
            let tolerance = if want < 200.0 { 0.5 } else { 0.03 };
            close_angle(bearing.to_degrees(), num(&case, "bearing_cdeg") / 100.0, tolerance, &case);
        } else {
            assert!(distance.abs() + bearing.abs() < 1e-12);
        }
    }
}

#[test]
fn local_offsets() {
    for case in cases("local_offset", "cases") {
        let ne = local_offset(point(&case["origin"]), point(&case["point"])) * 100.0;
        for (got, key) in [(ne.x, "north_cm"), (ne.y, "east_cm")] {
            close(got, num(&case, key), (num(&case, key).abs() * 2e-4).max(1.0), &case);
        }
    }
}

#[test]
fn offsets_to_positions() {
    for case in cases("offset_to_latlon", "cases") {
        let origin = point(&case["origin"]);
        let offset = Vector2::new(num(&case, "north_cm"), num(&case, "east_cm")) / 100.0;
        close_place(offset_to_latlon(origin, offset), point(&case["point"]), origin, &case);
    }
}

#[test]
fn earth_and_body() {
    for case in cases("earth_to_body", "cases") {
        let ne = Vector2::new(num(&case, "north"), num(&case, "east"));
        let body = earth_to_body(ne, num(&case, "heading_deg").to_radians());
        close(body.x, num(&case, "forward"), 0.001, &case);
        close(body.y, num(&case, "right"), 0.001, &case);
    }
}
