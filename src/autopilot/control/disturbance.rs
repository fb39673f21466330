//! Estimates the acceleration that the tilt does not explain: wind and drag.

use nalgebra::Vector2;

/// The bandwidth of the estimate, rad/s (critically damped second order, about 1 s).
const BANDWIDTH_RPS: f64 = 2.0;
/// The maximum estimate, m/s²: more than the wind of a storm.
const LIMIT_MPS2: f64 = 10.0;

/// A velocity observer with the disturbance as its second state: `v̂' = a + d̂ + 2ω(v − v̂)`, `d̂' = ω²(v − v̂)`,
/// where `a` is the acceleration of the actual tilt. It needs no accelerometer, so accelerometer bias does not affect
/// it.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct DisturbanceObserver {
    velocity: Option<Vector2<f64>>,
    accel: Vector2<f64>,
}

impl DisturbanceObserver {
    /// Returns the estimated disturbance (north, east), m/s².
    pub fn accel(&self) -> Vector2<f64> {
        self.accel
    }

    /// Takes the measured ground `velocity` (m/s) and the acceleration of the actual tilt (m/s²). Ignores values that
    /// are not finite.
    pub fn update(&mut self, velocity: Vector2<f64>, tilt_accel: Vector2<f64>, dt: f64) {
        if !(velocity.sum() + tilt_accel.sum() + dt).is_finite() {
            return;
        }
        let predicted = self.velocity.unwrap_or(velocity);
        let error = velocity - predicted;
        // A jump of the velocity is a new estimate, not a gust.
        if error.norm() > 5.0 {
            self.velocity = Some(velocity);
            return;
        }
        self.velocity = Some(predicted + (tilt_accel + self.accel + error * (2.0 * BANDWIDTH_RPS)) * dt);
        let next = self.accel + error * (BANDWIDTH_RPS * BANDWIDTH_RPS * dt);
        self.accel = next.cap_magnitude(LIMIT_MPS2);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_a_constant_wind_within_three_seconds() {
        let mut observer = DisturbanceObserver::default();
        let wind = Vector2::new(-1.2, 2.0);
        let mut velocity = Vector2::zeros();
        for _ in 0..300 {
            observer.update(velocity, Vector2::new(0.5, 0.0), 0.01);
            velocity += (wind + Vector2::new(0.5, 0.0)) * 0.01;
        }
        assert!((observer.accel() - wind).norm() < 0.1);
    }
}
