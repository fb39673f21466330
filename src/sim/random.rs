//! Randomness: one independent stream per consumer, all from one seed.
//!
//! A consumer that draws more, fewer or no numbers does not change the numbers of any other consumer.

use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

use crate::math;

mod ziggurat;

/// The generator of one stream.
pub type StreamRng = Xoshiro256PlusPlus;

/// The consumer of random numbers. The discriminant is the stream number of the generator. Changing one changes every
/// flight.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u64)]
pub enum Stream {
    /// White noise of the gyro.
    Gyro = 1,
    /// Turn-on bias and random walk of the gyro.
    GyroBias = 2,
    /// White noise of the accelerometer, vibration included.
    Accelerometer = 3,
    /// Turn-on bias and random walk of the accelerometer.
    AccelerometerBias = 4,
    /// White noise and drift of the barometer.
    Barometer = 5,
    /// White noise of the magnetometer.
    Magnetometer = 6,
    /// Position and velocity errors of the GPS.
    Gps = 7,
    /// Times of the first fix.
    GpsAcquisition = 8,
    /// Voltage and current readings.
    Battery = 9,
    /// Turbulence of the air.
    Turbulence = 10,
    /// Times and directions of gusts.
    Gusts = 11,
    /// RC frames dropped by the `rx-jitter` fault.
    RxJitter = 12,
    /// Packets that the faults of an external link drop, delay or repeat.
    Link = 13,
    /// Multipath steps and masked satellites of the GPS among buildings.
    GpsMultipath = 14,
}

impl Stream {
    /// Returns the generator of this consumer for a seed.
    ///
    /// The streams of a seed are parts of one sequence, each 2¹²⁸ numbers after the one before.
    pub fn rng(self, seed: u64) -> StreamRng {
        let mut rng = StreamRng::seed_from_u64(seed);
        for _ in 0..self as u64 {
            rng.jump();
        }
        rng
    }
}

/// Unit normal deviates from one stream.
#[derive(Debug, Clone)]
pub(super) struct Normals(StreamRng);

impl Normals {
    pub(super) fn new(seed: u64, stream: Stream) -> Self {
        Self(stream.rng(seed))
    }

    /// Returns one deviate with mean 0 and standard deviation 1.
    #[inline]
    pub(super) fn next(&mut self) -> f64 {
        ziggurat::normal(&mut self.0)
    }

    // Inlined, because the result would otherwise be copied through memory in every step.
    #[inline(always)]
    pub(super) fn next3(&mut self) -> nalgebra::Vector3<f64> {
        let x = self.next();
        let y = self.next();
        nalgebra::Vector3::new(x, y, self.next())
    }
}

/// Returns an exponential deviate with mean 1.
pub(super) fn exponential(rng: &mut StreamRng) -> f64 {
    // The argument is never zero.
    -math::ln(1.0 - rng.random::<f64>())
}

/// A first-order Gauss–Markov process: an error that wanders with a time constant and a constant standard deviation.
#[derive(Debug, Clone, Copy)]
pub(super) struct GaussMarkov {
    keep: f64,
    drive: f64,
}

impl GaussMarkov {
    /// Returns the process with stationary standard deviation `sigma` and time constant `tau_s`, updated every `dt`
    /// seconds.
    pub(super) fn stationary(sigma: f64, tau_s: f64, dt: f64) -> Self {
        let keep = math::exp(-dt / tau_s);
        Self { keep, drive: sigma * (1.0 - keep * keep).sqrt() }
    }

    /// Returns the process with time constant `tau_s`, driven by white noise of density `walk` (unit per √s).
    pub(super) fn random_walk(walk: f64, tau_s: f64, dt: f64) -> Self {
        Self::stationary(walk * (0.5 * tau_s).sqrt(), tau_s, dt)
    }

    /// Returns the next value after `value`, with a unit normal deviate.
    pub(super) fn next(&self, value: f64, normal: f64) -> f64 {
        self.keep * value + self.drive * normal
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn streams_of_one_seed_and_seeds_of_one_stream_differ() {
        let first = |seed, stream| Normals::new(seed, stream).next().to_bits();
        assert_ne!(first(1, Stream::Gyro), first(1, Stream::Gps));
        assert_ne!(first(1, Stream::Gyro), first(2, Stream::Gyro));
        assert_eq!(first(1, Stream::Gyro), first(1, Stream::Gyro));
    }

    #[test]
    fn an_exponential_deviate_has_mean_and_deviation_one() {
        let mut rng = Stream::Gusts.rng(1);
        let n = 1_000_000;
        let (mut sum, mut squares) = (0.0, 0.0);
        for _ in 0..n {
            let value = exponential(&mut rng);
            assert!(value >= 0.0 && value.is_finite());
            sum += value;
            squares += value * value;
        }
        let mean = sum / f64::from(n);
        assert!((mean - 1.0).abs() < 0.005, "{mean}");
        assert!((squares / f64::from(n) - 2.0).abs() < 0.03);
    }

    #[test]
    fn a_gauss_markov_process_keeps_its_deviation() {
        let process = GaussMarkov::stationary(0.25, 60.0, 0.1);
        let mut normals = Normals::new(5, Stream::Gps);
        let (mut value, mut sum) = (0.0, 0.0);
        let n = 4_000_000;
        for _ in 0..n {
            value = process.next(value, normals.next());
            sum += value * value;
        }
        let sigma = (sum / f64::from(n)).sqrt();
        assert!((sigma - 0.25).abs() < 0.01, "{sigma}");
    }
}
