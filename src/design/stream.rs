//! A stream of random numbers for each input, with the number of each flight at its own place.

use rand::{Rng as _, SeedableRng as _};
use rand_chacha::ChaCha8Rng;

/// The end of the key of each stream. Changing it changes every campaign.
const TAG: [u8; 8] = *b"campaign";
/// The number of 32-bit words for a number.
const WORDS: u128 = 2;

/// The random numbers of one input.
#[derive(Debug, Clone)]
pub struct Stream(ChaCha8Rng);

impl Stream {
    /// Returns the stream of an input for a seed.
    pub fn new(seed: u64, name: &str) -> Self {
        let mut key = [0; 32];
        let parts = [
            seed.to_le_bytes(),
            fingerprint(name.as_bytes()).to_le_bytes(),
            fingerprint(format!("{name}.").as_bytes()).to_le_bytes(),
            TAG,
        ];
        key.iter_mut().zip(parts.as_flattened()).for_each(|(to, from)| *to = *from);
        Self(ChaCha8Rng::from_seed(key))
    }

    /// Returns the 64 random bits of a flight.
    pub fn bits(&self, index: u64) -> u64 {
        let mut rng = self.0.clone();
        rng.set_word_pos(u128::from(index) * WORDS);
        rng.next_u64()
    }
}

/// Returns a number greater than 0 and less than 1 from random bits.
pub(super) fn unit_of(bits: u64) -> f64 {
    const STEP: f64 = 1.0 / (1_u64 << 52) as f64;
    ((bits >> 12) as f64 + 0.5) * STEP
}

/// Returns 64 bits that are all mixed from those of `bits`.
pub(super) fn mixed(bits: u64) -> u64 {
    let bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    bits ^ (bits >> 31)
}

/// Returns 64 bits that tell texts apart (FNV-1a).
pub fn fingerprint(bytes: &[u8]) -> u64 {
    let hash = |hash: u64, byte: &u8| (hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3);
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, hash)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_other_inputs_flights_and_seeds_differ() {
        let wind = Stream::new(1, "wind");
        assert_ne!(wind.bits(1), wind.bits(2));
        assert_ne!(wind.bits(1), Stream::new(1, "mass").bits(1));
        assert_ne!(wind.bits(1), Stream::new(2, "wind").bits(1));
        assert_eq!(wind.bits(7), Stream::new(1, "wind").bits(7), "in any order");
    }

    #[test]
    fn the_numbers_are_those_of_the_first_version() {
        let wind = Stream::new(1, "wind");
        assert_eq!(
            format!("{:016x} {:016x}", wind.bits(0), wind.bits(1_000_000)),
            "41167c48cf0d8525 f2c1008825b20a6d"
        );
    }

    #[test]
    fn numbers_are_uniform() {
        let stream = Stream::new(3, "gust");
        let count = 20_000;
        let units: Vec<f64> = (0..count).map(|index| unit_of(stream.bits(index))).collect();
        assert!(units.iter().all(|unit| (0.0..1.0).contains(unit) && *unit > 0.0));
        let mean = units.iter().sum::<f64>() / count as f64;
        // The standard deviation of the mean is 0.289 / √count.
        assert!((mean - 0.5).abs() < 4.0 * 0.289 / (count as f64).sqrt(), "{mean}");
        let mut tenths = [0_u32; 10];
        units.iter().for_each(|unit| tenths[(unit * 10.0) as usize] += 1);
        let expected = count as f64 / 10.0;
        let chi2: f64 = tenths.iter().map(|&seen| (f64::from(seen) - expected).powi(2) / expected).sum();
        assert!(chi2 < 27.9, "{chi2} with 9 degrees of freedom");
    }

    #[test]
    fn the_ends_are_left_out() {
        assert!(unit_of(0) > 0.0);
        assert!(unit_of(u64::MAX) < 1.0);
    }
}
