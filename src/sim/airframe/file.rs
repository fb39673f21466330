//! Airframe files: TOML with one key per constant, checked as a whole.
//!
//! With `base = "iris"` a file only gives the differences from a built-in airframe. Errors give line and column, name
//! the key and show the line. All problems of a file are reported, not only the first.

use std::collections::BTreeMap;
use std::ops::Range;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::text::did_you_mean;
use crate::text::source_snippet::{shortened, source_snippet};

use super::{Airframe, check};

mod problem;
mod value;
mod write;

pub use problem::{AirframeFileError, AirframeProblem};
use value::{base, cells, four, legs, number, string, vector};

/// One key of an airframe file.
struct Key {
    name: &'static str,
    required: bool,
    read: fn(&mut Airframe, &DeValue<'_>) -> Result<(), String>,
}

const fn required(name: &'static str, read: fn(&mut Airframe, &DeValue<'_>) -> Result<(), String>) -> Key {
    Key { name, required: true, read }
}

const fn optional(name: &'static str, read: fn(&mut Airframe, &DeValue<'_>) -> Result<(), String>) -> Key {
    Key { name, required: false, read }
}

/// All keys of the file and of its table `battery`. The names of the latter carry a prefix.
const KEYS: [Key; 27] = [
    optional("base", |a, v| base(v).map(|base| *a = base)),
    required("name", |a, v| string(v).map(|name| a.name = name)),
    required("mass_kg", |a, v| number(v).map(|x| a.mass_kg = x)),
    required("inertia_kgm2", |a, v| vector(v).map(|x| a.inertia_kgm2 = x)),
    required("rotor_pos_m_M1_to_M4_flu_from_com", |a, v| four(v, vector).map(|x| a.rotor_positions_m = x)),
    required("spin_sign_ccw_positive", |a, v| four(v, number).map(|x| a.spin_sign = x)),
    required("k_t_N_per_rad2s2", |a, v| number(v).map(|x| a.thrust_coeff = x)),
    required("kappa_m_torque_over_thrust", |a, v| number(v).map(|x| a.torque_per_thrust_m = x)),
    required("j_rotor_kgm2", |a, v| number(v).map(|x| a.rotor_inertia_kgm2 = x)),
    required("k_z_inflow_kg_per_rad", |a, v| number(v).map(|x| a.inflow_coeff = x)),
    required("k_d_rotor_drag_kg_per_rad", |a, v| number(v).map(|x| a.rotor_drag_coeff = x)),
    required("c_par_N_per_m2s2", |a, v| vector(v).map(|x| a.body_drag = x)),
    required("k_w_Nm_per_rads", |a, v| vector(v).map(|x| a.angular_damping = x)),
    required("omega_max_rads", |a, v| number(v).map(|x| a.rotor_speed_max = x)),
    required("tau_up_s", |a, v| number(v).map(|x| a.motor_tau_up_s = x)),
    required("tau_down_s", |a, v| number(v).map(|x| a.motor_tau_down_s = x)),
    required("contact_points_m_flu_from_com", |a, v| legs(v).map(|x| a.legs_m = x)),
    required("k_n_N_per_m_per_point", |a, v| number(v).map(|x| a.leg_stiffness = x)),
    required("c_n_Ns_per_m_per_point", |a, v| number(v).map(|x| a.leg_damping = x)),
    required("mu", |a, v| number(v).map(|x| a.friction = x)),
    optional("friction_regularisation_mps", |a, v| number(v).map(|x| a.friction_full_mps = x)),
    optional("rotor_radius_m", |a, v| number(v).map(|x| a.rotor_radius_m = x)),
    optional("imu_position_m", |a, v| vector(v).map(|x| a.imu_position_m = x)),
    required("battery.cells", |a, v| cells(v).map(|x| a.battery.cells = x)),
    optional("battery.nominal_v", |a, v| number(v).map(|x| a.battery.nominal_v = x)),
    required("battery.resistance_ohm", |a, v| number(v).map(|x| a.battery.resistance_ohm = x)),
    required("battery.capacity_ah", |a, v| number(v).map(|x| a.battery.capacity_ah = x)),
];

/// The step of a flight without another `--rate`, s. A flight with a longer one judges the legs again.
const USUAL_STEP_S: f64 = 0.001;
/// The name of the table with the battery keys.
const BATTERY: &str = "battery";
/// The nominal voltage of a cell if the file gives none for the pack, V.
const NOMINAL_CELL_V: f64 = 3.7;

/// The maximum number of listed problems of a file. The others are counted.
const MAX_LISTED: usize = 100;

/// The positions of the keys in the text.
type Places = BTreeMap<String, Range<usize>>;

impl Airframe {
    /// Reads the airframe that a TOML text describes.
    ///
    /// # Errors
    /// Fails if the text is not TOML, if a key is missing, unknown or of the wrong form, or if the craft could not
    /// fly.
    pub fn from_toml(text: &str) -> Result<Self, AirframeFileError> {
        let mut reading = Reading { text, problems: Vec::new(), unlisted: 0 };
        match DeTable::parse(text) {
            Ok(table) => reading.airframe(table.get_ref()),
            Err(error) => {
                reading.problem(error.span().unwrap_or(0..0), error.message().to_owned());
                None
            }
        }
        .filter(|_| reading.problems.is_empty())
        .ok_or(AirframeFileError { problems: reading.problems, unlisted: reading.unlisted })
    }
}

/// The text that is read and the problems found so far.
struct Reading<'a> {
    text: &'a str,
    problems: Vec<AirframeProblem>,
    unlisted: usize,
}

impl Reading<'_> {
    fn airframe(&mut self, table: &DeTable<'_>) -> Option<Airframe> {
        let values = self.flatten(table);
        let has_base = values.contains_key("base");
        let mut airframe = Airframe::iris();
        let mut places = Places::new();
        for key in &KEYS {
            match values.get(key.name) {
                Some(value) => {
                    places.insert(key.name.to_owned(), value.span());
                    if let Err(problem) = (key.read)(&mut airframe, value.get_ref()) {
                        self.problem(value.span(), format!("{} {problem}", key.name));
                    }
                }
                None if key.required && !has_base => {
                    self.problem(0..0, format!("{} is missing; base = \"iris\" would supply it", key.name));
                }
                None => {}
            }
        }
        if !values.contains_key("battery.nominal_v") && values.contains_key("battery.cells") {
            airframe.battery.nominal_v = NOMINAL_CELL_V * f64::from(airframe.battery.cells);
        }
        if self.problems.is_empty() {
            for finding in check::findings(&airframe, USUAL_STEP_S) {
                let place = places.get(finding.key).cloned().unwrap_or(0..0);
                self.problem(place, format!("{} {}", finding.key, finding.text));
            }
        }
        Some(airframe)
    }

    /// Returns all known keys with their values, those of the battery table with its name in front. Unknown keys are
    /// problems.
    fn flatten<'t, 'i>(&mut self, table: &'t DeTable<'i>) -> BTreeMap<String, &'t Spanned<DeValue<'i>>> {
        let mut values = BTreeMap::new();
        for (key, value) in table {
            if key.get_ref() != BATTERY {
                self.keep(key.get_ref().to_string(), key.span(), value, &mut values);
            } else if let Some(battery) = value.get_ref().as_table() {
                for (key, value) in battery {
                    self.keep(format!("{BATTERY}.{}", key.get_ref()), key.span(), value, &mut values);
                }
            } else {
                self.problem(
                    value.span(),
                    "battery must be a table: [battery] with cells, resistance_ohm, capacity_ah".to_owned(),
                );
            }
        }
        values
    }

    fn keep<'t, 'i>(
        &mut self,
        name: String,
        place: Range<usize>,
        value: &'t Spanned<DeValue<'i>>,
        values: &mut BTreeMap<String, &'t Spanned<DeValue<'i>>>,
    ) {
        let known = || KEYS.iter().map(|key| key.name);
        if known().any(|key| key == name) {
            values.insert(name, value);
        } else {
            let hint = did_you_mean::suffix(&name, known());
            self.problem(place, format!("{name} is not a key of an airframe file{hint}"));
        }
    }

    fn problem(&mut self, place: Range<usize>, text: String) {
        if self.problems.len() == MAX_LISTED {
            self.unlisted += 1;
            return;
        }
        let before = self.text.get(..place.start).unwrap_or_default();
        let line = before.matches('\n').count() + 1;
        let column = before.chars().rev().take_while(|&c| c != '\n').count() + 1;
        let source = source_snippet(self.text.lines().nth(line - 1).unwrap_or_default(), column);
        self.problems.push(AirframeProblem { line, column, source, text: shortened(text) });
    }
}

#[cfg(test)]
mod tests;
