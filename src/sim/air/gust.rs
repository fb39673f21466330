//! Discrete gusts of the shape 1 − cos (MIL-F-8785C), at random times or by command.

use arrayvec::ArrayVec;
use nalgebra::Vector3;
use rand::RngExt;

use crate::math;
use crate::signals::SimTime;
use crate::sim::random::{Stream, StreamRng, exponential};
use crate::sim::wind::Wind;

/// The time that a gust keeps its full strength, s.
const HOLD_S: f64 = 2.0;
/// The minimum and mean time between the starts of random gusts, s.
const MIN_SPACING_S: f64 = 6.0;
const MEAN_SPACING_S: f64 = 15.0;
/// The maximum deviation of random gusts from the direction of the mean wind, degrees.
const SPREAD_DEG: f64 = 30.0;
/// The maximum number of gusts at once. A further command replaces the oldest gust.
const MAX_GUSTS: usize = 4;

/// Returns the strength of a gust with a full strength of `peak_mps`, `t` seconds after its start: `A/2·(1 −
/// cos(πt/T))` during the rise of `rise_s`, A for `hold_s`, mirrored during the fall, 0 before and after.
pub fn one_minus_cosine(peak_mps: f64, rise_s: f64, hold_s: f64, t: f64) -> f64 {
    let end = 2.0 * rise_s + hold_s;
    let into = t.min(end - t);
    if into <= 0.0 {
        0.0
    } else if into >= rise_s {
        peak_mps
    } else {
        0.5 * peak_mps * (1.0 - math::cos(std::f64::consts::PI * into / rise_s))
    }
}

#[derive(Debug, Clone, Copy)]
struct Gust {
    direction_enu: Vector3<f64>,
    peak_mps: f64,
    rise_s: f64,
    hold_s: f64,
    start: SimTime,
}

impl Gust {
    fn new(wind: Wind, rise_s: f64, total_s: f64, start: SimTime) -> Self {
        let direction_enu = Wind { speed_mps: 1.0, ..wind }.velocity_enu();
        let rise_s = rise_s.min(0.5 * total_s);
        Self { direction_enu, peak_mps: wind.speed_mps, rise_s, hold_s: total_s - 2.0 * rise_s, start }
    }

    fn is_over(&self, now: SimTime) -> bool {
        now.seconds_since(self.start) >= 2.0 * self.rise_s + self.hold_s
    }
}

/// Returns the default length of a gust with the given rise time, s.
pub(in crate::sim) fn usual_length_s(rise_s: f64) -> f64 {
    2.0 * rise_s + HOLD_S
}

/// The active gusts and the next random one.
#[derive(Debug, Clone)]
pub(in crate::sim) struct Gusts {
    /// Strength of random gusts, m/s; 0 for none.
    size_mps: f64,
    rng: StreamRng,
    next: Option<SimTime>,
    blowing: ArrayVec<Gust, MAX_GUSTS>,
}

impl Gusts {
    pub(crate) fn new(seed: u64, size_mps: f64) -> Self {
        let mut gusts = Self { size_mps, rng: Stream::Gusts.rng(seed), next: None, blowing: ArrayVec::new() };
        gusts.plan_next(SimTime::ZERO);
        gusts
    }

    /// Returns the strength of random gusts, m/s.
    pub(crate) fn size_mps(&self) -> f64 {
        self.size_mps
    }

    /// Returns `true` while a gust is active.
    pub(crate) fn is_blowing(&self) -> bool {
        !self.blowing.is_empty()
    }

    /// Sets the strength of random gusts. The next one comes after a random time from now.
    pub(crate) fn set_size(&mut self, size_mps: f64, now: SimTime) {
        self.size_mps = size_mps;
        self.plan_next(now);
    }

    /// Starts one gust with the given speed and direction that rises and falls in `rise_s` and ends after `total_s`.
    pub(crate) fn blow(&mut self, wind: Wind, rise_s: f64, total_s: f64, now: SimTime) {
        if self.blowing.is_full() {
            self.blowing.remove(0);
        }
        self.blowing.push(Gust::new(wind, rise_s, total_s, now));
    }

    /// Ends gusts that are over and starts a random one when it is due.
    pub(crate) fn advance(&mut self, now: SimTime, mean: Wind, rise_s: f64) {
        self.blowing.retain(|gust| !gust.is_over(now));
        if self.next.is_some_and(|next| next <= now) {
            let turn = self.rng.random_range(-SPREAD_DEG..SPREAD_DEG);
            let wind = Wind { speed_mps: self.size_mps, from_deg: mean.from_deg + turn };
            self.blow(wind, rise_s, usual_length_s(rise_s), now);
            self.plan_next(now);
        }
    }

    /// Returns the velocity of all gusts together, ENU, m/s.
    pub(crate) fn velocity_enu(&self, time: SimTime) -> Vector3<f64> {
        self.blowing.iter().fold(Vector3::zeros(), |sum, gust| {
            let strength =
                one_minus_cosine(gust.peak_mps, gust.rise_s, gust.hold_s, time.seconds_since(gust.start));
            sum + gust.direction_enu * strength
        })
    }

    fn plan_next(&mut self, now: SimTime) {
        self.next = (self.size_mps > 0.0).then(|| {
            let wait = exponential(&mut self.rng);
            let spacing = MIN_SPACING_S + (MEAN_SPACING_S - MIN_SPACING_S) * wait;
            SimTime(now.0 + SimTime::from_secs_f64(spacing).0)
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const WEST: Wind = Wind { speed_mps: 5.0, from_deg: 270.0 };

    #[test]
    fn random_gusts_are_spaced_and_directed_as_stated() {
        let mut gusts = Gusts::new(3, 4.0);
        let mut starts = Vec::new();
        let mut was_blowing = false;
        for tick in 0..3_000_000_u64 {
            let now = SimTime(tick * 10_000);
            gusts.advance(now, WEST, 1.0);
            if gusts.is_blowing() && !was_blowing {
                starts.push(now.as_secs_f64());
                let direction = gusts.blowing[0].direction_enu;
                assert!(direction.x >= 30f64.to_radians().cos() - 1e-9, "{direction}");
            }
            was_blowing = gusts.is_blowing();
        }
        let gaps: Vec<f64> = starts.windows(2).map(|pair| pair[1] - pair[0]).collect();
        assert!(gaps.iter().all(|&gap| gap >= 6.0));
        let mean = gaps.iter().sum::<f64>() / gaps.len() as f64;
        // Standard error: 9 s / √2000 = 0.2 s.
        assert!((mean - 15.0).abs() < 0.8, "{mean}");
    }

    #[test]
    fn no_gust_without_size_and_one_on_command() {
        let mut gusts = Gusts::new(1, 0.0);
        gusts.advance(SimTime::from_secs_f64(1e5), WEST, 1.0);
        assert!(!gusts.is_blowing());
        gusts.blow(Wind { speed_mps: 8.0, from_deg: 0.0 }, 1.0, usual_length_s(1.0), SimTime::ZERO);
        let at = |t| gusts.velocity_enu(SimTime::from_secs_f64(t)).y;
        assert!((at(0.5) + 4.0).abs() < 1e-12 && (at(2.0) + 8.0).abs() < 1e-12);
        assert!((at(3.5) + 4.0).abs() < 1e-9 && at(4.0) == 0.0);
        gusts.advance(SimTime::from_secs_f64(4.0), WEST, 1.0);
        assert!(!gusts.is_blowing());
    }

    #[test]
    fn a_gust_blows_for_its_whole_length_and_no_longer() {
        for (rise_s, total_s) in [(2.0, 10.0), (0.5, 2.0), (3.0, 4.0)] {
            let mut gusts = Gusts::new(1, 0.0);
            gusts.blow(WEST, rise_s, total_s, SimTime::ZERO);
            let blows_at = |gusts: &mut Gusts, seconds: f64| {
                gusts.advance(SimTime::from_secs_f64(seconds), WEST, 1.0);
                gusts.is_blowing()
            };
            assert!(blows_at(&mut gusts, total_s - 0.01), "{rise_s} of {total_s} s");
            assert!(!blows_at(&mut gusts, total_s + 0.01), "{rise_s} of {total_s} s");
        }
    }
}
