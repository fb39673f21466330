//! Sobol's sequence in base 2, with Owen's scrambling.
//!
//! The direction numbers are those of S. Joe and F. Y. Kuo, "Constructing Sobol sequences with better two-dimensional
//! projections", SIAM J. Sci. Comput. 30 (2008), the table for criterion D(6).

use super::stream::mixed;

/// The number of inputs that share the sequence.
pub const DIMENSIONS: usize = 20;
/// The bits of a coordinate.
const BITS: usize = 32;
/// The most terms of a primitive polynomial here.
const TERMS: usize = 7;

/// A primitive polynomial: its inner coefficients as bits, and the first direction numbers. Their count is its degree.
type Row = (u32, &'static [u32]);

/// The rows of the second and later dimensions.
const ROWS: [Row; DIMENSIONS - 1] = [
    (0, &[1]),
    (1, &[1, 3]),
    (1, &[1, 3, 1]),
    (2, &[1, 1, 1]),
    (1, &[1, 1, 3, 3]),
    (4, &[1, 3, 5, 13]),
    (2, &[1, 1, 5, 5, 17]),
    (4, &[1, 1, 5, 5, 5]),
    (7, &[1, 1, 7, 11, 19]),
    (11, &[1, 1, 5, 1, 1]),
    (13, &[1, 1, 1, 3, 11]),
    (14, &[1, 3, 5, 5, 31]),
    (1, &[1, 3, 3, 9, 7, 49]),
    (13, &[1, 1, 1, 15, 21, 21]),
    (16, &[1, 3, 1, 13, 27, 49]),
    (19, &[1, 1, 1, 15, 7, 5]),
    (22, &[1, 3, 1, 15, 13, 25]),
    (25, &[1, 1, 5, 5, 19, 61]),
    (1, &[1, 3, 7, 11, 23, 15, 103]),
];

/// Returns the coordinate of a point in a dimension, as a fraction of 2³². The first dimension is 0.
pub(super) fn coordinate(index: u32, dimension: usize) -> u32 {
    let directions = directions(dimension);
    let gray = index ^ (index >> 1);
    let used = (0..BITS).filter(|bit| gray >> bit & 1 == 1);
    used.fold(0, |sum, bit| sum ^ directions[bit])
}

fn directions(dimension: usize) -> [u32; BITS] {
    let Some(&(coefficients, first)) = dimension.checked_sub(1).and_then(|row| ROWS.get(row)) else {
        return std::array::from_fn(|bit| 1 << (BITS - 1 - bit));
    };
    let degree = first.len().min(TERMS);
    let mut numbers = [0_u32; BITS];
    for bit in 0..BITS {
        numbers[bit] = match first.get(bit) {
            Some(number) => number << (BITS - 1 - bit),
            None => {
                let mut number = numbers[bit - degree] ^ (numbers[bit - degree] >> degree);
                for term in 1..degree {
                    if coefficients >> (degree - 1 - term) & 1 == 1 {
                        number ^= numbers[bit - term];
                    }
                }
                number
            }
        };
    }
    numbers
}

/// Returns the bits scrambled as Owen does: each bit is flipped or kept, depending on all higher bits and the key. Numbers
/// that share an interval still share one afterwards.
pub(super) fn scrambled(bits: u32, key: u64) -> u32 {
    let mut flips = 0;
    for bit in (0..u32::BITS).rev() {
        // The higher bits, with a mark in front, so that every interval has a number of its own.
        let interval = (1 << (u32::BITS - 1 - bit)) | (u64::from(bits) >> bit >> 1);
        flips |= (mixed(key ^ mixed(interval)) as u32 & 1) << bit;
    }
    bits ^ flips
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_points_are_the_published_ones() {
        let half = 1_u32 << 31;
        for dimension in 0..DIMENSIONS {
            assert_eq!((coordinate(0, dimension), coordinate(1, dimension)), (0, half));
        }
        // The third to sixth point of the first four dimensions, in eighths.
        let eighths = |index| std::array::from_fn(|dimension| coordinate(index, dimension) >> 29);
        let points: [[u32; 4]; 4] = [eighths(2), eighths(3), eighths(4), eighths(5)];
        assert_eq!(points, [[6, 2, 2, 2], [2, 6, 6, 6], [3, 3, 5, 7], [7, 7, 1, 3]]);
    }

    #[test]
    fn every_dimension_fills_each_interval_once() {
        for dimension in 0..DIMENSIONS {
            for scramble in [None, Some(7), Some(8)] {
                let point = |index| {
                    let bits = coordinate(index, dimension);
                    scramble.map_or(bits, |key| scrambled(bits, key))
                };
                let mut cells: Vec<u32> = (0..256).map(|index| point(index) >> 24).collect();
                cells.sort_unstable();
                assert_eq!(cells, (0..256).collect::<Vec<_>>(), "dimension {dimension}");
            }
        }
    }

    #[test]
    fn the_first_two_dimensions_fill_each_elementary_box_once() {
        // 256 points in boxes of 2^-a by 2^-(8-a).
        for across in 0..=8_u32 {
            let cell = |index| {
                let (x, y) = (scrambled(coordinate(index, 0), 3), scrambled(coordinate(index, 1), 4));
                let part = |bits: u32, count: u32| bits.checked_shr(32 - count).unwrap_or(0);
                part(x, across) << (8 - across) | part(y, 8 - across)
            };
            let mut cells: Vec<u32> = (0..256).map(cell).collect();
            cells.sort_unstable();
            assert_eq!(cells, (0..256).collect::<Vec<_>>(), "{across}");
        }
    }

    #[test]
    fn no_pair_of_dimensions_is_on_a_line() {
        let centred = |index, dimension| {
            let key = mixed(dimension as u64 + 1);
            f64::from(scrambled(coordinate(index, dimension), key)) / f64::from(u32::MAX) - 0.5
        };
        for a in 0..DIMENSIONS {
            for b in 0..a {
                let product: f64 = (0..1024).map(|index| centred(index, a) * centred(index, b)).sum();
                let correlation = product / 1024.0 * 12.0;
                assert!(correlation.abs() < 0.1, "{a} and {b}: {correlation}");
            }
        }
    }
}
