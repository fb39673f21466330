//! The forms of the editor: their fields, and the edits that their values make.

use nalgebra::Vector2;
use strum::IntoEnumIterator as _;

use crate::geo::LatLon;
use crate::plan::edit::PlanDocument;
use crate::plan::edit::transform::{Transform, transform};
use crate::plan::format::{SettingCheck, setting_line};
use crate::plan::generate::{Pattern, Shape, split};
use crate::plan::{Altitude, FlightPlan, LegSpeed, MAX_WAYPOINTS, Waypoint, WaypointType};
use crate::ui::model::editor::column::shortest;
use crate::ui::model::editor::form::{Form, FormField, FormKind};
use crate::ui::units::Units;

const MIRRORS: &[&str] = &["no", "north-south", "east-west"];
const SHAPES: &[&str] = &["square", "circle", "zig-zag", "survey"];
const KINDS: &[&str] = &["FLYOVER", "FLYBY"];
const WHERE: &[&str] = &["replace the plan", "append to it"];
const TOO_MANY: &[&str] = &["wider spacing", "several plans"];

/// Returns the form that edits many waypoints at once. Empty fields change nothing.
pub(super) fn bulk(units: Units) -> Form {
    let length = units.length_unit();
    Form::new(
        FormKind::Bulk,
        units,
        vec![
            FormField::typed("altitude", format!("{length} above home"), ""),
            FormField::typed("altitude by", length, ""),
            FormField::typed("speed", format!("{}, 0 = default", units.speed_unit()), ""),
            FormField::typed("move north", length, ""),
            FormField::typed("move east", length, ""),
            FormField::typed("rotate", "° clockwise", ""),
            FormField::choice("mirror", MIRRORS),
            FormField::choice("reverse", &["no", "yes"]),
        ],
    )
}

/// Applies a bulk form to the selected waypoints.
///
/// # Errors
/// Returns the problem with a value, as a sentence.
pub(super) fn take_bulk(
    form: &Form,
    document: &mut PlanDocument,
    selected: std::ops::RangeInclusive<usize>,
) -> Result<(), String> {
    let mut edits = Vec::new();
    if let Some(metres) = form.metres("altitude")? {
        edits.push(Transform::Altitude(altitude(metres, form.units)?));
    }
    if let Some(metres) = form.metres("altitude by")? {
        edits.push(Transform::AltitudeBy(altitude(metres, form.units)?.above_home_m()));
    }
    if let Some(speed) = form.metres_per_second("speed")? {
        edits.push(Transform::Speed(leg_speed(speed, form.units)?));
    }
    let moved = Vector2::new(
        form.metres("move north")?.unwrap_or_default(),
        form.metres("move east")?.unwrap_or_default(),
    );
    if moved != Vector2::zeros() {
        edits.push(Transform::Move(moved));
    }
    if let Some(degrees) = form.number("rotate")? {
        edits.push(Transform::Rotate(degrees.to_radians()));
    }
    match form.value("mirror") {
        "north-south" => edits.push(Transform::MirrorNorthSouth),
        "east-west" => edits.push(Transform::MirrorEastWest),
        _ => {}
    }
    if form.value("reverse") == "yes" {
        edits.push(Transform::Reverse);
    }
    for edit in edits {
        transform(&mut document.plan, selected.clone(), edit);
    }
    Ok(())
}

/// Returns the form that generates a plan from a shape.
pub(super) fn generate(is_empty: bool, units: Units) -> Form {
    let usual = Pattern::default();
    let length = units.length_unit();
    let shown = |metres: f64| match units {
        Units::Metric => shortest(metres),
        Units::Imperial => shortest(units.length(metres).round()),
    };
    let mut form = Form::new(
        FormKind::Generate,
        units,
        vec![
            FormField::choice("shape", SHAPES),
            FormField::typed("length", length, shown(usual.length_m)),
            FormField::typed("width", length, shown(usual.width_m)),
            FormField::typed("spacing", length, shown(usual.spacing_m)),
            FormField::typed("heading", "°", "0"),
            FormField::typed(
                "altitude",
                format!("{length} above home"),
                shown(usual.altitude.above_home_m()),
            ),
            FormField::typed("speed", format!("{}, 0 = default", units.speed_unit()), "0"),
            FormField::choice("type", KINDS),
            FormField::choice("result", WHERE),
            FormField::choice("beyond 30", TOO_MANY),
        ],
    );
    if is_empty {
        form.fields.retain(|field| field.label != "result");
    }
    form
}

/// Reads the pattern from a generator form.
fn pattern(form: &Form) -> Result<Pattern, String> {
    let missing = |label: &str| format!("{label}: a number is needed.");
    let metres = |label: &str| form.metres(label)?.ok_or_else(|| missing(label));
    let speed_mps = form.metres_per_second("speed")?.ok_or_else(|| missing("speed"))?;
    let shape = Shape::iter().find(|shape| shape.to_string() == form.value("shape")).unwrap_or_default();
    Ok(Pattern {
        shape,
        length_m: metres("length")?,
        width_m: metres("width")?,
        spacing_m: metres("spacing")?,
        heading_deg: form.number("heading")?.ok_or_else(|| missing("heading"))?,
        altitude: altitude(metres("altitude")?, form.units)?,
        speed: leg_speed(speed_mps, form.units)?,
        kind: form.value("type").parse().unwrap_or(WaypointType::Flyover),
    })
}

/// The result of a generator form.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Generated {
    /// One plan, or several, each of which continues the one before.
    pub(super) plans: Vec<Vec<Waypoint>>,
    /// A summary for the line under the form.
    pub(super) reported: String,
}

/// Generates the result of the form for a plan that has `taken` waypoints already.
///
/// # Errors
/// Returns the problem with a value, as a sentence.
pub(super) fn generated(form: &Form, middle: LatLon, taken: usize) -> Result<Generated, String> {
    let pattern = pattern(form)?;
    let taken = if form.value("result") == WHERE[1] { taken } else { 0 };
    let room = MAX_WAYPOINTS - taken.min(MAX_WAYPOINTS);
    let waypoints = pattern.waypoints(middle)?;
    let count = waypoints.len();
    if count <= room {
        return Ok(Generated { plans: vec![waypoints], reported: format!("{count} waypoints.") });
    }
    if form.value("beyond 30") == TOO_MANY[1] && taken == 0 {
        let plans = split(&waypoints);
        let reported = format!("{count} waypoints, a plan holds {MAX_WAYPOINTS}: {} plans.", plans.len());
        return Ok(Generated { plans, reported });
    }
    let Some(spacing_m) = pattern.spacing_that_fits(room) else {
        return Err(format!("{count} waypoints, there is room for {room}: no spacing makes it fit."));
    };
    let wider = Pattern { spacing_m, ..pattern }.waypoints(middle)?;
    let reported = format!(
        "{count} waypoints, there is room for {room}: a spacing of {} {} makes {}.",
        shortest(form.units.length(spacing_m)),
        form.units.length_unit(),
        wider.len()
    );
    Ok(Generated { plans: vec![wider], reported })
}

/// Returns the form for name, description, home and settings of a plan.
pub(super) fn properties(document: &PlanDocument, units: Units) -> Form {
    let home = document.home.map_or_else(String::new, |home| home.to_string());
    let mut fields = vec![
        FormField::typed("name", "", &document.name),
        FormField::typed("description", "", &document.description),
        FormField::typed("home", "LAT,LON[,AMSL in m]; empty = none", home),
    ];
    let settings = document.settings.iter().map(String::as_str).chain(["", ""]);
    fields.extend(settings.map(|line| FormField::typed("setting", "name = value; empty = none", line)));
    Form::new(FormKind::Properties, units, fields)
}

/// Applies the values of a properties form.
///
/// # Errors
/// Returns the problem with a value, as a sentence.
pub(super) fn take_properties(
    form: &Form,
    document: &mut PlanDocument,
    check: SettingCheck,
) -> Result<(), String> {
    let home = form.value("home");
    document.home = match home {
        "" => None,
        text => Some(text.parse().map_err(|error| format!("home: {error}."))?),
    };
    let texts =
        form.fields.iter().filter(|field| field.label == "setting").map(|field| field.text.value().trim());
    document.settings = texts
        .filter(|text| !text.is_empty())
        .map(|text| checked_setting(text, check))
        .collect::<Result<_, _>>()?;
    document.name = form.value("name").to_owned();
    document.description = form.value("description").to_owned();
    Ok(())
}

/// Checks a setting and returns it as a line that can be read back from the plan's file.
fn checked_setting(text: &str, check: SettingCheck) -> Result<String, String> {
    let line = setting_line(text).ok_or_else(|| format!("{text} is not a setting: write name = value."))?;
    if let Some((name, value)) = line.split_once(" = ") {
        check(name, value).map_err(|fault| format!("{fault}."))?;
    }
    Ok(line)
}

/// Returns a plan of these waypoints, or of as many as fit.
pub(super) fn plan_of(waypoints: &[Waypoint]) -> FlightPlan {
    FlightPlan { waypoints: waypoints.iter().copied().take(MAX_WAYPOINTS).collect() }
}

fn altitude(metres: f64, units: Units) -> Result<Altitude, String> {
    Altitude::checked(metres).ok_or_else(|| format!("{} is out of range.", units.length_text(metres, 0)))
}

fn leg_speed(mps: f64, units: Units) -> Result<LegSpeed, String> {
    LegSpeed::checked(mps).ok_or_else(|| {
        let (typed, most) = (shortest(units.speed(mps)), units.speed_text(LegSpeed::MAX_MPS, 2));
        format!("{typed} {} is out of range: 0 to {most} is allowed.", units.speed_unit())
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ui::text_field::TextField;

    fn fill(form: &mut Form, label: &str, text: &str) {
        form.fields.iter_mut().rfind(|field| field.label == label).unwrap().text = TextField::new(text);
    }

    #[test]
    fn a_survey_beyond_thirty_waypoints_is_reported_and_either_spaced_wider_or_split() {
        let mut form = generate(true, Units::Metric);
        fill(&mut form, "shape", "survey");
        fill(&mut form, "width", "200");
        fill(&mut form, "spacing", "5");
        let wider = generated(&form, LatLon::default(), 0).unwrap();
        assert!(
            wider.reported.starts_with("82 waypoints, there is room for 30: a spacing of"),
            "{}",
            wider.reported
        );
        assert!(wider.plans.len() == 1 && wider.plans[0].len() <= 30);
        fill(&mut form, "beyond 30", "several plans");
        assert_eq!(generated(&form, LatLon::default(), 0).unwrap().plans.len(), 3);
        fill(&mut form, "spacing", "wide");
        assert_eq!(generated(&form, LatLon::default(), 0).unwrap_err(), "spacing: wide is not a number.");
    }

    #[test]
    fn properties_take_home_and_settings_or_say_what_is_wrong() {
        let mut document =
            PlanDocument { settings: vec!["ap_max_angle = 30".to_owned()], ..Default::default() };
        let mut form = properties(&document, Units::Metric);
        fill(&mut form, "home", "40,-79");
        fill(&mut form, "setting", "set ap_max_velocity=500");
        take_properties(&form, &mut document, |_, _| Ok(())).unwrap();
        assert_eq!(document.settings, ["ap_max_angle = 30", "ap_max_velocity = 500"]);
        assert!(document.home.is_some());
        fill(&mut form, "setting", "what");
        assert!(take_properties(&form, &mut document, |_, _| Ok(())).unwrap_err().contains("name = value"));
        fill(&mut form, "home", "north");
        assert!(
            take_properties(&form, &mut document, |_, _| Ok(()))
                .unwrap_err()
                .starts_with("home: north is not a place")
        );
    }
}
