//! The values of an airframe file: numbers, vectors, lists.

use arrayvec::ArrayVec;
use nalgebra::Vector3;
use toml::Spanned;
use toml::de::DeValue;

use crate::sim::airframe::{Airframe, MAX_LEGS, ROTORS, UnknownAirframe};

pub(super) fn base(value: &DeValue<'_>) -> Result<Airframe, String> {
    string(value)?.parse().map_err(|error: UnknownAirframe| format!("is wrong: {error}"))
}

pub(super) fn string(value: &DeValue<'_>) -> Result<String, String> {
    value.as_str().map(str::to_owned).ok_or_else(|| wrong("a text in quotes", value))
}

pub(super) fn number(value: &DeValue<'_>) -> Result<f64, String> {
    let text = match value {
        DeValue::Float(float) => float.as_str(),
        DeValue::Integer(integer) if integer.radix() == 10 => integer.as_str(),
        _ => return Err(wrong("a number", value)),
    };
    text.parse().ok().filter(|x: &f64| x.is_finite()).ok_or_else(|| "must be a finite number".to_owned())
}

pub(super) fn cells(value: &DeValue<'_>) -> Result<u8, String> {
    let cells = number(value)?;
    if cells.fract() == 0.0 && (1.0..=255.0).contains(&cells) {
        Ok(cells as u8)
    } else {
        Err(format!("must be a whole number of cells, not {cells}"))
    }
}

pub(super) fn vector(value: &DeValue<'_>) -> Result<Vector3<f64>, String> {
    let want = "three numbers: [x, y, z]";
    match items(value, want)?[..] {
        [x, y, z] => Ok(Vector3::new(number(x)?, number(y)?, number(z)?)),
        ref other => Err(format!("must be {want}, not {} of them", other.len())),
    }
}

pub(super) fn four<T>(
    value: &DeValue<'_>,
    read: fn(&DeValue<'_>) -> Result<T, String>,
) -> Result<[T; ROTORS], String> {
    let all = items(value, "a list of four values, M1 to M4")?;
    let all = all.into_iter().map(read).collect::<Result<Vec<T>, String>>()?;
    all.try_into()
        .map_err(|all: Vec<T>| format!("must be a list of four values, M1 to M4, not {}", all.len()))
}

pub(super) fn legs(value: &DeValue<'_>) -> Result<ArrayVec<Vector3<f64>, MAX_LEGS>, String> {
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
