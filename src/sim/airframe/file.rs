//! Airframe files: TOML with one key a constant, checked as a whole.
//!
//! `base = "iris"` lets a file state only what differs from a built-in airframe. Errors say line and column, name
//! the key and show the line; all of a file's problems are reported, not the first only.

use std::collections::BTreeMap;
use std::fmt;
use std::ops::Range;

use arrayvec::ArrayVec;
use nalgebra::Vector3;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::did_you_mean;
use crate::source_snippet::{SourceSnippet, shortened, source_snippet};

use super::{Airframe, MAX_LEGS, ROTORS, check};

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

/// All keys of the file and of its table `battery`, whose names carry the prefix.
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

/// The name of the table of battery keys.
const BATTERY: &str = "battery";
/// Nominal voltage of a cell where the file gives none for the pack, V.
const NOMINAL_CELL_V: f64 = 3.7;

/// Most problems of a file that are listed; the others are counted.
const MOST_LISTED: usize = 100;

/// A key's place in the text.
type Places = BTreeMap<String, Range<usize>>;

impl Airframe {
    /// The airframe that a TOML text describes.
    ///
    /// # Errors
    /// When the text is no TOML, a key is missing, unknown or of the wrong form, or the craft could not fly.
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

/// A text being read and what was wrong so far.
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
            for finding in check::findings(&airframe) {
                let place = places.get(finding.key).cloned().unwrap_or(0..0);
                self.problem(place, format!("{} {}", finding.key, finding.text));
            }
        }
        Some(airframe)
    }

    /// All known keys with their values, those of the battery's table with its name in front; unknown ones are problems.
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
        if self.problems.len() == MOST_LISTED {
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

/// One thing wrong with an airframe file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct AirframeProblem {
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
    /// The line, or the part of it around the place.
    pub source: SourceSnippet,
    /// What is wrong.
    pub text: String,
}

impl fmt::Display for AirframeProblem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}:{}: {}", self.line, self.column, self.text)?;
        writeln!(f, "  {}", self.source.text)?;
        write!(f, "  {:>width$}", "^", width = self.source.column)
    }
}

/// Everything wrong with an airframe file. `Display` gives the problems as `LINE:COLUMN: …`, each with its line.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct AirframeFileError {
    /// At least one problem, in the order of the keys.
    pub problems: Vec<AirframeProblem>,
    /// Problems that are not listed.
    pub unlisted: usize,
}

impl AirframeFileError {
    /// The problems as `FILE:LINE:COLUMN: …`, each with its line.
    #[must_use]
    pub fn in_file(&self, file: &str) -> String {
        self.lines(|problem| format!("{file}:{problem}"))
    }

    fn lines(&self, line: impl Fn(&AirframeProblem) -> String) -> String {
        let mut lines: Vec<String> = self.problems.iter().map(line).collect();
        if self.unlisted > 0 {
            let problems = if self.unlisted == 1 { "problem" } else { "problems" };
            lines.push(format!("and {} more {problems}", self.unlisted));
        }
        lines.join("\n")
    }
}

impl fmt::Display for AirframeFileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.lines(ToString::to_string))
    }
}

impl std::error::Error for AirframeFileError {}

fn base(value: &DeValue<'_>) -> Result<Airframe, String> {
    string(value)?.parse().map_err(|error: super::UnknownAirframe| format!("is wrong: {error}"))
}

fn string(value: &DeValue<'_>) -> Result<String, String> {
    value.as_str().map(str::to_owned).ok_or_else(|| wrong("a text in quotes", value))
}

fn number(value: &DeValue<'_>) -> Result<f64, String> {
    let text = match value {
        DeValue::Float(float) => float.as_str(),
        DeValue::Integer(integer) if integer.radix() == 10 => integer.as_str(),
        _ => return Err(wrong("a number", value)),
    };
    text.parse().ok().filter(|x: &f64| x.is_finite()).ok_or_else(|| "must be a finite number".to_owned())
}

fn cells(value: &DeValue<'_>) -> Result<u8, String> {
    let cells = number(value)?;
    if cells.fract() == 0.0 && (1.0..=255.0).contains(&cells) {
        Ok(cells as u8)
    } else {
        Err(format!("must be a whole number of cells, not {cells}"))
    }
}

fn vector(value: &DeValue<'_>) -> Result<Vector3<f64>, String> {
    let want = "three numbers: [x, y, z]";
    match items(value, want)?[..] {
        [x, y, z] => Ok(Vector3::new(number(x)?, number(y)?, number(z)?)),
        ref other => Err(format!("must be {want}, not {} of them", other.len())),
    }
}

fn four<T>(value: &DeValue<'_>, read: fn(&DeValue<'_>) -> Result<T, String>) -> Result<[T; ROTORS], String> {
    let all = items(value, "a list of four values, M1 to M4")?;
    let all = all.into_iter().map(read).collect::<Result<Vec<T>, String>>()?;
    all.try_into()
        .map_err(|all: Vec<T>| format!("must be a list of four values, M1 to M4, not {}", all.len()))
}

fn legs(value: &DeValue<'_>) -> Result<ArrayVec<Vector3<f64>, MAX_LEGS>, String> {
    let all = items(value, "a list of points [[x, y, z], …]")?;
    if all.len() > MAX_LEGS {
        return Err(format!("must be at most {MAX_LEGS} points, not {}", all.len()));
    }
    all.into_iter().map(vector).collect()
}

fn items<'t, 'i>(value: &'t DeValue<'i>, want: &str) -> Result<Vec<&'t DeValue<'i>>, String> {
    let array = value.as_array().ok_or_else(|| wrong(want, value))?;
    Ok(array.iter().map(Spanned::get_ref).collect())
}

fn wrong(want: &str, value: &DeValue<'_>) -> String {
    format!("must be {want}, not a TOML {}", value.type_str())
}

#[cfg(test)]
mod tests {
    use super::*;

    const WHOLE: &str = r#"
name = "copy"
mass_kg = 0.53
inertia_kgm2 = [0.00683, 0.00611, 0.01063]
rotor_pos_m_M1_to_M4_flu_from_com = [[-0.13, -0.2, 0.01866], [0.13, -0.22, 0.01866], [-0.13, 0.2, 0.01866], [0.13, 0.22, 0.01866]]
spin_sign_ccw_positive = [-1, 1, 1, -1]
k_t_N_per_rad2s2 = 1.06202e-5
kappa_m_torque_over_thrust = 0.016
j_rotor_kgm2 = 2.65e-5
k_z_inflow_kg_per_rad = 2e-4
k_d_rotor_drag_kg_per_rad = 8.06e-5
c_par_N_per_m2s2 = [0.006, 0.006, 0.012]
k_w_Nm_per_rads = [0.002, 0.002, 0.002]
omega_max_rads = 696
tau_up_s = 0.01197
tau_down_s = 0.01197
contact_points_m_flu_from_com = [[0.235, 0.235, -0.19934], [0.235, -0.235, -0.19934], [-0.235, 0.235, -0.19934], [-0.235, -0.235, -0.19934]]
k_n_N_per_m_per_point = 1299.4
c_n_Ns_per_m_per_point = 9.2
mu = 1.0

[battery]
cells = 3
resistance_ohm = 0.03
capacity_ah = 3.3
"#;

    fn errors(text: &str) -> Vec<String> {
        let error = Airframe::from_toml(text).expect_err("a problem");
        error.problems.iter().map(|p| format!("{}:{}: {}", p.line, p.column, p.text)).collect()
    }

    #[test]
    fn a_whole_file_is_an_airframe() {
        let read = Airframe::from_toml(WHOLE).unwrap_or_else(|error| panic!("{error}"));
        // Nominal voltage comes out of 3.7·3 in floating point.
        let nominal_v = read.battery.nominal_v;
        assert!((nominal_v - 11.1).abs() < 1e-9);
        let mut want = Airframe { name: "copy".to_owned(), ..Airframe::iris() };
        want.battery.nominal_v = nominal_v;
        assert_eq!(read, want);
    }

    #[test]
    fn a_base_supplies_what_is_missing() {
        let read = Airframe::from_toml("base = \"five-inch\"\nmass_kg = 0.8\n").unwrap();
        assert_eq!(read, Airframe { mass_kg: 0.8, ..Airframe::five_inch() });
    }

    #[test]
    fn every_key_but_the_optional_ones_is_required() {
        assert_eq!(errors("").len(), KEYS.iter().filter(|key| key.required).count());
        assert!(errors("").iter().any(|e| e.contains("mass_kg is missing")));
    }

    #[test]
    fn problems_name_place_and_key() {
        let with = |line: &str| errors(&format!("base = \"iris\"\n{line}"));
        for (line, want) in [
            ("mass_kg = \"1\"", "2:11: mass_kg must be a number, not a TOML string"),
            ("mass_kg = -1", "2:11: mass_kg must be greater than 0, not -1"),
            ("mass_kg = nan", "2:11: mass_kg must be a finite number"),
            ("mass = 1", "2:1: mass is not a key of an airframe file"),
            ("mas_kg = 1", "2:1: mas_kg is not a key of an airframe file; did you mean mass_kg?"),
            ("inertia_kgm2 = [1, 2]", "2:16: inertia_kgm2 must be three numbers: [x, y, z], not 2 of them"),
            (
                "spin_sign_ccw_positive = [1, -1, -1, 1]",
                "2:26: spin_sign_ccw_positive must be [-1, 1, 1, -1]",
            ),
            ("[battery]\ncells = 2.5", "3:9: battery.cells must be a whole number of cells, not 2.5"),
            ("[battery]\nvolts = 2", "3:1: battery.volts is not a key"),
            ("battery = 3", "2:11: battery must be a table"),
            ("mass_kg =", "2:10: "),
        ] {
            let found = with(line);
            assert!(found.len() == 1 && found[0].starts_with(want), "{line}: {found:?}");
        }
        assert!(errors("base = \"irsi\"")[0].contains("did you mean iris?"));
    }

    #[test]
    fn the_message_shows_the_line_with_a_caret() {
        let error = Airframe::from_toml("base = \"iris\"\ntau_up_s = 0\n").unwrap_err();
        assert_eq!(
            error.in_file("x.toml"),
            "x.toml:2:12: tau_up_s must be at least 0.002, not 0\n  tau_up_s = 0\n             ^"
        );
    }

    #[test]
    fn many_problems_in_one_long_line_are_counted_and_some_are_shown() {
        let keys: Vec<String> = (0..20_000).map(|at| format!("key{at}=1")).collect();
        let error = Airframe::from_toml(&format!("battery = {{{}}}", keys.join(","))).unwrap_err();
        assert_eq!(error.problems.len(), MOST_LISTED);
        let message = error.to_string();
        let missing = KEYS.iter().filter(|key| key.required).count();
        assert!(
            message.ends_with(&format!("\nand {} more problems", 20_000 + missing - MOST_LISTED)),
            "{message}"
        );
        assert!(message.len() < 100_000, "{} bytes", message.len());

        let far_right = format!("base = \"iris\"\nbattery = {{{}volts = 2}}", " ".repeat(70_000));
        let message = Airframe::from_toml(&far_right).unwrap_err().to_string();
        assert!(message.starts_with("2:70012: battery.volts is not a key"), "{message}");
        assert!(message.ends_with(&format!("\n  {}^", " ".repeat(101))), "{message}");
    }

    proptest::proptest! {
        #[test]
        fn any_text_is_read_or_refused_without_panic(text in "(.|\n){0,80}", key in 0usize..KEYS.len()) {
            let _ = Airframe::from_toml(&text);
            let _ = Airframe::from_toml(&format!("{} = {text}", KEYS[key].name));
        }
    }
}
