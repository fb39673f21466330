//! Functions of real numbers that have the same bits on every machine.
//!
//! `f64::sin` and its relatives call the C library, which has several versions of each and takes the one that suits the
//! processor. Their results differ in the last bit, and after a few seconds of flight in every bit. These functions come
//! from a library in Rust, so a flight has the same bits wherever it is flown. Each is within about 1 unit in the last place
//! of the exact value. `tests/house/rooms` forbids the others to the core.
//!
//! Operations that IEEE 754 defines exactly are not here: the four operations, `sqrt`, `abs`, `floor`, `round`, `%`. `mul_add` is exact
//! everywhere, but slow on processors without an instruction for it.

/// The most decimals that tell two numbers apart.
const MAX_DECIMALS: usize = 17;

/// Returns the sine of an angle, rad.
pub fn sin(x: f64) -> f64 {
    libm::sin(x)
}

/// Returns the cosine of an angle, rad.
pub fn cos(x: f64) -> f64 {
    libm::cos(x)
}

/// Returns sine and cosine of an angle, rad.
pub fn sin_cos(x: f64) -> (f64, f64) {
    libm::sincos(x)
}

/// Returns the tangent of an angle, rad.
pub fn tan(x: f64) -> f64 {
    libm::tan(x)
}

/// Returns the angle of a sine, −π/2…π/2; not a number for a sine beyond ±1.
pub fn asin(x: f64) -> f64 {
    libm::asin(x)
}

/// Returns the angle of a cosine, 0…π; not a number for a cosine beyond ±1.
pub fn acos(x: f64) -> f64 {
    libm::acos(x)
}

/// Returns the angle of a tangent, −π/2…π/2.
pub fn atan(x: f64) -> f64 {
    libm::atan(x)
}

/// Returns the angle of the point (x, y) from the x axis, −π…π.
pub fn atan2(y: f64, x: f64) -> f64 {
    libm::atan2(y, x)
}

/// Returns the length of the vector (x, y), without overflow.
pub fn hypot(x: f64, y: f64) -> f64 {
    libm::hypot(x, y)
}

/// Returns e to the power of x.
pub fn exp(x: f64) -> f64 {
    libm::exp(x)
}

/// Returns the natural logarithm.
pub fn ln(x: f64) -> f64 {
    libm::log(x)
}

/// Returns the logarithm to base 2.
pub fn log2(x: f64) -> f64 {
    libm::log2(x)
}

/// Returns the logarithm to base 10.
pub fn log10(x: f64) -> f64 {
    libm::log10(x)
}

/// Returns a number to any power.
pub fn powf(x: f64, exponent: f64) -> f64 {
    libm::pow(x, exponent)
}

/// Returns a number to a small power of at least 1, by repeated multiplication.
#[inline]
pub fn powi(x: f64, exponent: u32) -> f64 {
    (1..exponent).fold(x, |power, _| power * x)
}

/// Returns the smallest number of decimals, from `least` on, with which two numbers read differently; `least` if they are
/// equal.
pub fn decimals_apart(one: f64, other: f64, least: usize) -> usize {
    // As numbers, −0.0 and 0.0 are the same.
    let read = |number: f64, decimals: usize| format!("{number:.decimals$}").parse::<f64>();
    (least..=MAX_DECIMALS)
        .find(|&decimals| read(one, decimals) != read(other, decimals))
        .filter(|_| one != other)
        .unwrap_or(least)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn they_are_the_functions_that_their_names_say() {
        for n in -400..=400 {
            let x = f64::from(n) * 0.025;
            let near =
                |got: f64, want: f64| assert!((got - want).abs() <= 1e-14 * want.abs().max(1.0), "{x}");
            near(sin(x), x.sin());
            near(cos(x), x.cos());
            near(sin_cos(x).0, sin(x));
            near(sin_cos(x).1, cos(x));
            near(tan(x) * cos(x), sin(x));
            near(atan(x), x.atan());
            near(atan2(x, -3.0), x.atan2(-3.0));
            near(hypot(x, 2.0), (x * x + 4.0).sqrt());
            near(asin(x / 10.0), (x / 10.0).asin());
            near(acos(x / 10.0), (x / 10.0).acos());
            near(exp(x), x.exp());
            near(ln(1.0 + x * x), (1.0 + x * x).ln());
            near(log2(1.0 + x * x), (1.0 + x * x).log2());
            near(log10(1.0 + x * x), (1.0 + x * x).log10());
            near(powf(1.0 + x * x, 0.4), (1.0 + x * x).powf(0.4));
            near(powi(x, 3), x * x * x);
        }
    }

    #[test]
    fn numbers_that_differ_are_told_apart_by_their_decimals() {
        for (one, other, least, decimals) in [
            (150.0, 100.0, 0, 0),
            (50.4, 50.0, 0, 1),
            (50.04, 50.0, 0, 2),
            (50.0004, 50.0, 1, 4),
            (15.000_000_1, 15.0, 1, 7),
            (15.000_000_000_000_002, 15.0, 1, 15),
            (-0.001, 0.001, 1, 3),
            (50.0, 50.0, 2, 2),
            (f64::NAN, 50.0, 1, 1),
        ] {
            assert_eq!(decimals_apart(one, other, least), decimals, "{one} and {other}");
        }
    }
}
