//! The Kalman covariance of one axis of dead reckoning: position, velocity, acceleration error.

/// The process noise of one axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct ProcessNoise {
    /// The spectral density of the acceleration's white error, (m/s²)²/Hz.
    pub accel: f64,
    /// The spectral density of the random walk of its slow error, (m/s³)²/Hz.
    pub drift: f64,
}

/// The corrections of position (m), velocity (m/s) and acceleration error (m/s²) per unit of innovation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Gain {
    pub position: f64,
    pub velocity: f64,
    pub accel: f64,
    /// The variance of the innovation.
    pub innovation: f64,
}

/// The symmetric covariance of a Kalman filter with the states position `p`, velocity `v` and acceleration error `b`,
/// driven by a measured acceleration: `p' = v`, `v' = a + b`, `b' = noise`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct KalmanCovariance {
    pp: f64,
    pv: f64,
    pb: f64,
    vv: f64,
    vb: f64,
    bb: f64,
}

impl KalmanCovariance {
    /// Creates independent states with these standard deviations.
    pub(super) fn new(position: f64, velocity: f64, accel: f64) -> Self {
        Self {
            pp: position * position,
            pv: 0.0,
            pb: 0.0,
            vv: velocity * velocity,
            vb: 0.0,
            bb: accel * accel,
        }
    }

    /// Predicts the covariance `dt` seconds later: `F P Fᵀ + Q` with `F = [1 dt dt²/2; 0 1 dt; 0 0 1]`.
    pub(super) fn predict(&mut self, dt: f64, noise: &ProcessNoise) {
        let Self { pv, pb, vv, vb, bb, .. } = *self;
        let half = 0.5 * dt * dt;
        self.pp += dt * (2.0 * pv + dt * (vv + pb + dt * (vb + 0.25 * dt * bb)));
        self.pv += dt * (vv + pb + dt * (1.5 * vb + 0.5 * dt * bb));
        self.pb += dt * vb + half * bb;
        self.vv += dt * (2.0 * vb + dt * bb) + noise.accel * dt;
        self.vb += dt * bb;
        self.bb += noise.drift * dt;
    }

    /// Applies a measurement of the position with this variance.
    pub(super) fn measure_position(&mut self, variance: f64) -> Gain {
        let (h, innovation) = ((self.pp, self.pv, self.pb), self.pp + variance);
        self.update(h, innovation)
    }

    /// Applies a measurement of the velocity with this variance.
    pub(super) fn measure_velocity(&mut self, variance: f64) -> Gain {
        let (h, innovation) = ((self.pv, self.vv, self.vb), self.vv + variance);
        self.update(h, innovation)
    }

    fn update(&mut self, (p, v, b): (f64, f64, f64), innovation: f64) -> Gain {
        let gain =
            Gain { position: p / innovation, velocity: v / innovation, accel: b / innovation, innovation };
        // The floors keep rounding errors from making a variance negative.
        self.pp = (self.pp - gain.position * p).max(1e-9);
        self.pv -= gain.position * v;
        self.pb -= gain.position * b;
        self.vv = (self.vv - gain.velocity * v).max(1e-9);
        self.vb -= gain.velocity * b;
        self.bb = (self.bb - gain.accel * b).max(1e-12);
        gain
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Matrix3;

    fn matrix(c: &KalmanCovariance) -> Matrix3<f64> {
        Matrix3::new(c.pp, c.pv, c.pb, c.pv, c.vv, c.vb, c.pb, c.vb, c.bb)
    }

    #[test]
    fn prediction_is_the_matrix_product() {
        let mut covariance = KalmanCovariance { pp: 2.0, pv: 0.3, pb: -0.1, vv: 1.5, vb: 0.2, bb: 0.7 };
        let dt = 0.2;
        let f = Matrix3::new(1.0, dt, 0.5 * dt * dt, 0.0, 1.0, dt, 0.0, 0.0, 1.0);
        let expected = f * matrix(&covariance) * f.transpose();
        covariance.predict(dt, &ProcessNoise { accel: 0.0, drift: 0.0 });
        assert!((matrix(&covariance) - expected).norm() < 1e-12);
    }

    #[test]
    fn a_velocity_measurement_is_the_textbook_update() {
        let mut covariance = KalmanCovariance { pp: 2.0, pv: 0.3, pb: -0.1, vv: 1.5, vb: 0.2, bb: 0.7 };
        let p = matrix(&covariance);
        let k = p.column(1) / (p[(1, 1)] + 0.5);
        let expected = p - k * p.row(1);
        let gain = covariance.measure_velocity(0.5);
        assert!((gain.accel - k[2]).abs() < 1e-12);
        assert!((matrix(&covariance) - expected).norm() < 1e-12);
    }

    #[test]
    fn stays_positive_over_an_hour() {
        let mut covariance = KalmanCovariance::new(10.0, 1.0, 0.5);
        let noise = ProcessNoise { accel: 4e-4, drift: 1e-3 };
        for step in 0..360_000 {
            covariance.predict(0.01, &noise);
            if step % 10 == 0 {
                covariance.measure_position(0.09);
                covariance.measure_velocity(0.0049);
            }
        }
        assert!(matrix(&covariance).cholesky().is_some());
        assert!(covariance.pp < 0.01);
    }
}
