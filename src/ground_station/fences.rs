//! The fence as mission items. The craft has one: a circle around home that it must stay in.

use super::parameters;
use crate::geo::{LatLon, distance_bearing};
use crate::mavlink::MissionItem;
use crate::mavlink::state::GeoPosition;
use crate::mavlink::value::position_frame;

/// The setting with the radius, m. 0 is no fence.
pub(super) const SETTING: &str = "ap_max_distance_from_home";
/// The greatest number of items of an upload, so that a polygon is refused by its name.
pub(super) const MAX_ITEMS: u16 = 100;
/// A circle around home has its centre within this distance of it, m. A position of GPS is not closer.
const AT_HOME_M: f64 = 10.0;

const RETURN_POINT: u16 = 5000;
const POLYGON_INCLUSION: u16 = 5001;
const POLYGON_EXCLUSION: u16 = 5002;
const CIRCLE_INCLUSION: u16 = 5003;
const CIRCLE_EXCLUSION: u16 = 5004;

/// Returns the fence of a craft as an item; `None` if it has none, or no home. A radius of 0 is no fence.
pub(super) fn item(radius_m: Option<f32>, home: Option<&GeoPosition>) -> Option<MissionItem> {
    let (radius_m, home) = radius_m.filter(|radius| *radius > 0.0).zip(home)?;
    let center = LatLon::from_degrees(home.lat_deg, home.lon_deg);
    Some(MissionItem {
        frame: position_frame::GLOBAL,
        command: CIRCLE_INCLUSION,
        params: [radius_m, 0.0, 0.0, 0.0],
        x: center.lat_e7,
        y: center.lon_e7,
        z: 0.0,
        is_current: false,
        autocontinue: true,
    })
}

/// Returns the radius of a fence from a ground station, m; 0 if there are no items.
///
/// # Errors
/// Fails with a sentence if the fence is not a circle around home that the craft must stay in.
pub(super) fn radius_m(items: &[MissionItem], home: Option<&GeoPosition>) -> Result<f32, String> {
    let name = match items {
        [] => return Ok(0.0),
        [first, ..] => match first.command {
            CIRCLE_INCLUSION if items.len() > 1 => "more than one item".to_owned(),
            CIRCLE_INCLUSION => return circle(first, home),
            RETURN_POINT => "a return point".to_owned(),
            POLYGON_INCLUSION | POLYGON_EXCLUSION => "a polygon".to_owned(),
            CIRCLE_EXCLUSION => "a circle to stay out of".to_owned(),
            other => format!("command {other}"),
        },
    };
    Err(format!(
        "The fence has {name}: the craft keeps to one circle around home, {}.",
        parameters::alias(SETTING)
    ))
}

fn circle(item: &MissionItem, home: Option<&GeoPosition>) -> Result<f32, String> {
    let home = home.ok_or("The craft has no home yet, around which its fence is: wait for its fix.")?;
    let home = LatLon::from_degrees(home.lat_deg, home.lon_deg);
    let away_m = distance_bearing(home, LatLon::new(item.x, item.y)).0;
    if away_m > AT_HOME_M {
        return Err(format!(
            "The centre of the fence is {away_m:.0} m from home: allowed are {AT_HOME_M:.0} m, because the craft keeps to a \
             circle around home."
        ));
    }
    match item.params[0].round() {
        radius if radius >= 1.0 => Ok(radius),
        _ => Err(format!("The radius of the fence is {} m: allowed are 1 m and more.", item.params[0])),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const HOME: GeoPosition = GeoPosition { lat_deg: 40.4635, lon_deg: -79.5182, alt_amsl: 300.0 };

    #[test]
    fn a_circle_around_home_comes_back_as_its_radius_and_no_item_is_no_fence() {
        let item = item(Some(80.0), Some(&HOME)).unwrap();
        assert_eq!(radius_m(&[item], Some(&HOME)), Ok(80.0));
        assert_eq!(radius_m(&[], None), Ok(0.0));
        assert_eq!(super::item(Some(0.0), Some(&HOME)), None);
        assert!(radius_m(&[item], None).unwrap_err().contains("no home yet"));
    }

    #[test]
    fn other_fences_are_refused_by_their_names() {
        let circle = item(Some(80.0), Some(&HOME)).unwrap();
        let refused = |items: &[MissionItem]| radius_m(items, Some(&HOME)).unwrap_err();
        for (command, name) in [
            (RETURN_POINT, "return point"),
            (POLYGON_INCLUSION, "polygon"),
            (CIRCLE_EXCLUSION, "stay out"),
            (16, "command 16"),
        ] {
            assert!(refused(&[MissionItem { command, ..circle }]).contains(name));
        }
        assert!(refused(&[circle, circle]).contains("more than one"));
        assert!(refused(&[MissionItem { x: circle.x + 10_000, ..circle }]).contains("111 m from home"));
        for radius in [0.0, -5.0, f32::NAN] {
            assert!(refused(&[MissionItem { params: [radius; 4], ..circle }]).contains("1 m and more"));
        }
    }
}
