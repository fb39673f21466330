//! Normal deviates by the ziggurat method of Marsaglia and Tsang: the density is covered by layers of equal area, and
//! almost every point of a layer is below the density whatever its height.
//!
//! The distribution is exact but for rounding. The compiler computes the tables, to twelve digits.

use rand::{Rng, RngExt};

use crate::math;

/// The number of layers.
const LAYERS: usize = 256;
/// The width of the lowest layer but its tail, and the area of each layer, for a density of exp(−x²/2).
const LOWEST_WIDTH: f64 = 3.654_152_885_361_009;
const AREA: f64 = 0.004_928_673_233_974_658;

/// The widths of the layers from the lowest on, and the density there. The lowest layer is the widest: its width is
/// that of a rectangle with the area of the layer and its tail.
const TABLES: ([f64; LAYERS + 1], [f64; LAYERS + 1]) = tables();
static WIDTHS: [f64; LAYERS + 1] = TABLES.0;
static DENSITIES: [f64; LAYERS + 1] = TABLES.1;

/// Returns a deviate with mean 0 and standard deviation 1.
#[inline]
pub(super) fn normal(rng: &mut impl Rng) -> f64 {
    loop {
        let bits = rng.next_u64();
        // The layer takes the lowest eight bits, the place the upper 53.
        let layer = (bits & 0xff) as usize;
        let place = (bits.cast_signed() >> 11) as f64 * (1.0 / (1_u64 << 52) as f64);
        let x = place * WIDTHS[layer];
        if x.abs() < WIDTHS[layer + 1] {
            return x;
        }
        if let Some(x) = at_the_edge(rng, layer, x) {
            return x;
        }
    }
}

/// Decides about a point that is not below the density whatever its height. Returns the deviate, or `None` if the
/// point is above the density.
#[cold]
#[inline(never)]
fn at_the_edge(rng: &mut impl Rng, layer: usize, x: f64) -> Option<f64> {
    if layer == 0 {
        return Some(tail(rng).copysign(x));
    }
    let (low, high) = (DENSITIES[layer], DENSITIES[layer + 1]);
    let height = low + (high - low) * rng.random::<f64>();
    (height < math::exp(-0.5 * x * x)).then_some(x)
}

/// Returns a deviate beyond the lowest layer, by Marsaglia's method.
fn tail(rng: &mut impl Rng) -> f64 {
    loop {
        let beyond = -math::ln(1.0 - rng.random::<f64>()) / LOWEST_WIDTH;
        let room = -math::ln(1.0 - rng.random::<f64>());
        if room + room > beyond * beyond {
            return LOWEST_WIDTH + beyond;
        }
    }
}

const fn tables() -> ([f64; LAYERS + 1], [f64; LAYERS + 1]) {
    let mut widths = [0.0; LAYERS + 1];
    let mut densities = [1.0; LAYERS + 1];
    densities[0] = 0.0;
    densities[1] = density(LOWEST_WIDTH);
    widths[0] = AREA / densities[1];
    widths[1] = LOWEST_WIDTH;
    let mut layer = 2;
    while layer < LAYERS {
        densities[layer] = densities[layer - 1] + AREA / widths[layer - 1];
        widths[layer] = width(densities[layer], widths[layer - 1]);
        layer += 1;
    }
    (widths, densities)
}

/// Returns the place at which the density has a value, found from a place a little beyond it.
const fn width(value: f64, beyond: f64) -> f64 {
    let mut x = beyond;
    let mut round = 0;
    // Newton's method for the logarithm of the density, −x²/2.
    while round < 8 {
        let d = density(x);
        x += (d - value) / (0.5 * (d + value) * x);
        round += 1;
    }
    x
}

/// Returns exp(−x²/2).
const fn density(x: f64) -> f64 {
    // A series for a small part of the exponent, and its power.
    let part = 0.5 * x * x / 256.0;
    let mut sum = 1.0;
    let mut term = 1.0;
    let mut n = 1;
    while n < 14 {
        term *= part / n as f64;
        sum += term;
        n += 1;
    }
    let mut doubling = 0;
    while doubling < 8 {
        sum *= sum;
        doubling += 1;
    }
    1.0 / sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sim::random::Stream;

    #[test]
    fn every_layer_has_the_same_area() {
        assert_eq!((WIDTHS[LAYERS], DENSITIES[LAYERS]), (0.0, 1.0));
        for layer in 1..LAYERS {
            let (width, density) = (WIDTHS[layer], DENSITIES[layer]);
            assert!((density / (-0.5 * width * width).exp() - 1.0).abs() < 1e-12, "{layer}");
            let area = width * (DENSITIES[layer + 1] - density);
            assert!((area / AREA - 1.0).abs() < 1e-9, "{layer}: {area}");
        }
        // The tail beyond x is √(π/2)·erfc(x/√2).
        let tail = (std::f64::consts::PI / 2.0).sqrt() * libm::erfc(LOWEST_WIDTH / std::f64::consts::SQRT_2);
        assert!(((LOWEST_WIDTH * DENSITIES[1] + tail) / AREA - 1.0).abs() < 1e-12);
    }

    #[test]
    fn as_many_deviates_fall_between_two_bounds_as_the_normal_distribution_says() {
        const N: u32 = 8_000_000;
        // Between these bounds are body, edges and tail of the layers.
        let bounds: Vec<f64> = (-46..=46).map(|tenths| f64::from(tenths) / 10.0).collect();
        let mut counts = vec![0_u32; bounds.len() + 1];
        let mut rng = Stream::Gyro.rng(3);
        for _ in 0..N {
            let x = normal(&mut rng);
            counts[bounds.partition_point(|bound| *bound < x)] += 1;
        }
        let below = |bound: f64| 0.5 * libm::erfc(-bound / std::f64::consts::SQRT_2);
        let mut chi_squared = 0.0;
        for (place, count) in counts.iter().enumerate() {
            let from = place.checked_sub(1).map_or(0.0, |left| below(bounds[left]));
            let to = bounds.get(place).map_or(1.0, |right| below(*right));
            let expected = (to - from) * f64::from(N);
            chi_squared += (f64::from(*count) - expected).powi(2) / expected;
        }
        // 93 degrees of freedom: mean 93, standard deviation 14.
        assert!((50.0..150.0).contains(&chi_squared), "{chi_squared}");
    }

    #[test]
    fn the_tail_is_reached_on_both_sides() {
        let mut rng = Stream::Gps.rng(1);
        let far: Vec<f64> =
            (0..2_000_000).map(|_| normal(&mut rng)).filter(|x| x.abs() > LOWEST_WIDTH).collect();
        // 2.58e-4 of all.
        assert!((440..600).contains(&far.len()), "{}", far.len());
        let left = far.iter().filter(|x| **x < 0.0).count();
        assert!((far.len() / 3..2 * far.len() / 3).contains(&left));
    }
}
