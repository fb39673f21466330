//! Random orders of many flights without a list of them.

use super::stream::mixed;

/// Mixing rounds. Four are the least for an order that looks random.
const ROUNDS: u64 = 8;

/// Returns the place of `index` in a random order of `0..count`. `key` chooses the order. Each place occurs once.
pub(super) fn shuffled(index: u64, count: u64, key: u64) -> u64 {
    let bits = u64::BITS - count.saturating_sub(1).leading_zeros();
    let half = bits.div_ceil(2).max(1);
    let mask = (1_u64 << half) - 1;
    let mut place = index;
    // The order of a slightly larger range is walked until it is in this one.
    loop {
        let (mut left, mut right) = (place >> half, place & mask);
        for round in 0..ROUNDS {
            let next = left ^ (mixed(key ^ mixed(right ^ (round << 56))) & mask);
            (left, right) = (right, next);
        }
        place = left << half | right;
        if place < count {
            return place;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_place_occurs_once() {
        for count in [1, 2, 3, 7, 64, 1000, 1025] {
            let mut places: Vec<u64> = (0..count).map(|index| shuffled(index, count, 42)).collect();
            places.sort_unstable();
            assert_eq!(places, (0..count).collect::<Vec<_>>(), "{count}");
        }
    }

    #[test]
    fn orders_differ_by_key_and_have_no_trend() {
        let order = |key| (0..1000).map(|index| shuffled(index, 1000, key)).collect::<Vec<_>>();
        let (first, second) = (order(1), order(2));
        let same = std::iter::zip(&first, &second).filter(|(a, b)| a == b).count();
        assert!(same < 10, "{same}");
        // The correlation with the index has the standard deviation 1 / √1000.
        let centred = |number: u64| number as f64 - 499.5;
        let product: f64 = first.iter().zip(0_u64..).map(|(&a, b)| centred(a) * centred(b)).sum();
        let scale: f64 = (0..1000).map(|number| centred(number).powi(2)).sum();
        assert!((product / scale).abs() < 0.13, "{}", product / scale);
    }
}
