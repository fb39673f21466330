//! The barometer: static pressure 50 times a second, 20 ms late.

use crate::sim::config::Noise;
use crate::sim::fault::Effects;
use crate::sim::random::{GaussMarkov, Normals, Stream};
use crate::sim::switches::Switches;

/// The white noise of one sample, Pa.
const SIGMA_PA: f64 = 1.0;
/// The drift: standard deviation, Pa, and time constant, s.
const DRIFT_PA: (f64, f64) = (3.0, 600.0);
/// The time between two samples, s.
const PERIOD_S: f64 = 0.02;
/// The number of samples between two spikes of the spike fault: one second.
const SPIKE_EVERY: u32 = 50;

#[derive(Debug, Clone)]
pub(super) struct Barometer {
    normals: Normals,
    drift: f64,
    drift_process: GaussMarkov,
    /// Sum of the drift fault so far, Pa.
    ramp: f64,
    since_spike: u32,
    /// Pressure at the last sampling instant, Pa. The sampling period is the latency.
    last: Option<f64>,
    /// The newest sample, Pa.
    sample: Option<f64>,
}

impl Barometer {
    pub(super) fn new(seed: u64) -> Self {
        let (sigma, tau_s) = DRIFT_PA;
        Self {
            normals: Normals::new(seed, Stream::Barometer),
            drift: 0.0,
            drift_process: GaussMarkov::stationary(sigma, tau_s, PERIOD_S),
            ramp: 0.0,
            since_spike: SPIKE_EVERY - 1,
            last: None,
            sample: None,
        }
    }

    /// Forgets the history, as if the craft had always been here.
    pub(super) fn settle(&mut self) {
        self.last = None;
    }

    /// Returns one sample, Pa, for a true pressure of `pressure`. Call it once per sampling period.
    pub(super) fn read(
        &mut self,
        pressure: f64,
        switches: &Switches,
        effects: &Effects,
        noise: Noise,
    ) -> f64 {
        let late = self.last.replace(pressure).unwrap_or(pressure);
        self.ramp += effects.baro_drift_pa_per_s * PERIOD_S;
        let faults = self.ramp + self.spike(effects.baro_spike_pa);
        let sample = match noise {
            Noise::None => pressure + faults,
            Noise::Real => {
                if switches.sensor_bias {
                    self.drift = self.drift_process.next(self.drift, self.normals.next());
                }
                let drift = if switches.sensor_bias { self.drift } else { 0.0 };
                (late + drift + SIGMA_PA * self.normals.next() + faults).round()
            }
        };
        let shown = self.sample.filter(|_| effects.baro_freeze).unwrap_or(sample);
        self.sample = Some(shown);
        shown
    }

    fn spike(&mut self, size: f64) -> f64 {
        if size == 0.0 {
            self.since_spike = SPIKE_EVERY - 1;
            return 0.0;
        }
        self.since_spike = (self.since_spike + 1) % SPIKE_EVERY;
        if self.since_spike == 0 { size } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the samples of a barometer without drift while the pressure rises by 200 Pa, Pa.
    fn samples(noise: Noise) -> [f64; 3] {
        let switches = Switches { sensor_bias: false, ..Switches::default() };
        let mut barometer = Barometer::new(1);
        [100_000.0, 100_200.0, 100_200.0]
            .map(|pressure| barometer.read(pressure, &switches, &Effects::NONE, noise))
    }

    #[test]
    fn a_sample_is_one_period_old_unless_the_sensors_are_ideal() {
        // The margin is several times the noise of a sample.
        let expected = [100_000.0, 100_000.0, 100_200.0];
        let late = samples(Noise::Real);
        for (sample, pressure) in late.iter().zip(expected) {
            assert!((sample - pressure).abs() < 10.0, "{late:?}");
        }
        assert_eq!(samples(Noise::None), [100_000.0, 100_200.0, 100_200.0]);
    }

    #[test]
    fn a_craft_put_elsewhere_does_not_report_the_pressure_of_its_old_place() {
        let switches = Switches { sensor_bias: false, ..Switches::default() };
        let mut barometer = Barometer::new(1);
        let read = |barometer: &mut Barometer, pressure| {
            barometer.read(pressure, &switches, &Effects::NONE, Noise::Real)
        };
        read(&mut barometer, 100_000.0);
        barometer.settle();
        let first = read(&mut barometer, 100_200.0);
        assert!((first - 100_200.0).abs() < 10.0, "{first} Pa");
    }
}
