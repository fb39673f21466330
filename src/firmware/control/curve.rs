//! Stick curves: from stick positions to rates and throttle.

use crate::math;

/// The formula that turns sticks into rates. The discriminant is the value of the setting.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, strum::FromRepr)]
#[repr(u8)]
pub enum RatesType {
    /// RC rate, super rate, expo.
    Betaflight = 0,
    /// Rate, acro+, expo.
    Raceflight = 1,
    /// RC rate, rate, RC curve.
    Kiss = 2,
    /// Centre sensitivity, greatest rate, expo.
    #[default]
    Actual = 3,
    /// RC rate, greatest rate, expo.
    Quick = 4,
}

/// The curve of one axis. The fields are the numbers of the settings.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RateCurve {
    pub kind: RatesType,
    /// `*_rc_rate`.
    pub rc_rate: f64,
    /// `*_srate`.
    pub srate: f64,
    /// `*_expo`.
    pub expo: f64,
    /// `*_rate_limit`, °/s.
    pub limit_dps: f64,
    /// `quickrates_rc_expo`.
    pub quick_expo_on_stick: bool,
}

impl RateCurve {
    /// Returns the rate (°/s) for a stick position −1…1.
    pub fn rate_dps(&self, stick: f64) -> f64 {
        let x = stick.clamp(-1.0, 1.0);
        let a = x.abs();
        let e = self.expo / 100.0;
        let rate = match self.kind {
            RatesType::Betaflight => {
                let bent = x * (math::powi(a, 3) * e + 1.0 - e);
                let mut r = self.rc_rate / 100.0;
                if r > 2.0 {
                    r += 14.54 * (r - 2.0);
                }
                200.0 * r * bent / (1.0 - a * self.srate / 100.0).max(0.01)
            }
            RatesType::Raceflight => {
                x * (1.0 + e * (x * x - 1.0)) * self.rc_rate * 10.0 * (1.0 + a * self.srate / 100.0)
            }
            RatesType::Kiss => {
                (math::powi(x, 3) * e + x * (1.0 - e)) * 2.0 * self.rc_rate
                    / (1.0 - a * self.srate / 100.0).max(0.01)
            }
            RatesType::Actual => {
                let centre = self.rc_rate * 10.0;
                let bent = a * (math::powi(x, 5) * e + x * (1.0 - e));
                x * centre + (self.srate * 10.0 - centre).max(0.0) * bent
            }
            RatesType::Quick => {
                let centre = self.rc_rate * 2.0;
                let greatest = (self.srate * 10.0).max(centre);
                let s = if greatest > 0.0 { 1.0 - centre / greatest } else { 0.0 };
                if self.quick_expo_on_stick {
                    (math::powi(x, 3) * e + x * (1.0 - e)) * centre / (1.0 - a * s).max(0.01)
                } else {
                    x * centre / (1.0 - s * (math::powi(a, 3) * e + a * (1.0 - e))).max(0.01)
                }
            }
        };
        rate.clamp(-self.limit_dps, self.limit_dps)
    }
}

/// The kind of throttle limit (`throttle_limit_type`). The discriminant is the value of the setting.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, strum::FromRepr)]
#[repr(u8)]
pub enum ThrottleLimit {
    #[default]
    Off = 0,
    Scale = 1,
    Clip = 2,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ThrottleCurve {
    /// The pulse of zero throttle, µs (`min_check`).
    pub zero_us: f64,
    /// The stick position (0…1) of the middle point.
    pub mid: f64,
    /// The throttle (0…1) of the middle point.
    pub hover: f64,
    /// The bend about the middle point, 0…1.
    pub expo: f64,
    /// The kind of limit.
    pub limit: ThrottleLimit,
    /// The limit, 0…1.
    pub limit_share: f64,
}

impl ThrottleCurve {
    /// Returns the throttle 0…1 for a pulse (µs).
    pub fn throttle(&self, pulse_us: f64) -> f64 {
        let stick = ((pulse_us - self.zero_us) / (2000.0 - self.zero_us).max(1.0)).clamp(0.0, 1.0);
        let curved = self.bend(stick);
        match self.limit {
            ThrottleLimit::Off => curved,
            ThrottleLimit::Scale => curved * self.limit_share,
            ThrottleLimit::Clip => curved.min(self.limit_share),
        }
    }

    /// Evaluates two quadratic Bézier curves through (0, 0), (`mid`, `hover`) and (1, 1). With full expo they are flat
    /// at the middle point; without expo they are straight.
    fn bend(&self, x: f64) -> f64 {
        let (mid, hover) = (self.mid, self.hover);
        if x <= mid {
            if mid <= 0.0 {
                return hover;
            }
            // Seen outwards from the middle point, both halves have the same form.
            hover * (1.0 - self.half(1.0 - x / mid))
        } else {
            hover + (1.0 - hover) * self.half((x - mid) / (1.0 - mid))
        }
    }

    /// Evaluates the curve from the middle point (0) to the end (1). The control point is halfway, lowered by expo.
    fn half(&self, t: f64) -> f64 {
        t * (t * self.expo + (1.0 - self.expo))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn curve(kind: RatesType, rc_rate: f64, srate: f64, expo: f64) -> RateCurve {
        RateCurve { kind, rc_rate, srate, expo, limit_dps: 1998.0, quick_expo_on_stick: false }
    }

    #[test]
    fn known_points_of_every_type() {
        let cases = [
            // Centre 70, greatest 670, no expo: at half stick 35 + 600/4.
            (curve(RatesType::Actual, 7.0, 67.0, 0.0), 0.5, 185.0),
            (curve(RatesType::Actual, 7.0, 67.0, 0.0), -1.0, -670.0),
            // 200·1·1/(1 − 0.7).
            (curve(RatesType::Betaflight, 100.0, 70.0, 0.0), 1.0, 200.0 / 0.3),
            (curve(RatesType::Betaflight, 220.0, 0.0, 0.0), 1.0, 200.0 * (2.2 + 14.54 * 0.2)),
            (curve(RatesType::Raceflight, 37.0, 80.0, 50.0), 1.0, 370.0 * 1.8),
            (curve(RatesType::Kiss, 100.0, 70.0, 0.0), 0.5, 100.0 / 0.65),
            // (0.125·0.4 + 0.5·0.6)·200/(1 − 0.35).
            (curve(RatesType::Kiss, 100.0, 70.0, 40.0), 0.5, 70.0 / 0.65),
            (curve(RatesType::Quick, 100.0, 67.0, 0.0), 1.0, 670.0),
            (curve(RatesType::Quick, 100.0, 67.0, 0.0), 0.0, 0.0),
        ];
        for (curve, stick, rate) in cases {
            assert!((curve.rate_dps(stick) - rate).abs() < 1e-9, "{curve:?} {stick}");
        }
    }

    #[test]
    fn rates_are_limited() {
        let wild = RateCurve { limit_dps: 300.0, ..curve(RatesType::Betaflight, 255.0, 100.0, 0.0) };
        assert_eq!(wild.rate_dps(1.0), 300.0);
    }

    #[test]
    fn the_throttle_curve_passes_its_points() {
        let curve = ThrottleCurve {
            zero_us: 1050.0,
            mid: 0.4,
            hover: 0.3,
            expo: 0.7,
            limit: ThrottleLimit::Off,
            limit_share: 1.0,
        };
        for (stick, throttle) in [(0.0, 0.0), (0.4, 0.3), (1.0, 1.0)] {
            assert!((curve.throttle(1050.0 + 950.0 * stick) - throttle).abs() < 1e-12);
        }
        assert_eq!(curve.throttle(900.0), 0.0);
        let limited = ThrottleCurve { limit: ThrottleLimit::Scale, limit_share: 0.5, ..curve };
        assert!((limited.throttle(2000.0) - 0.5).abs() < 1e-12);
        let identity = ThrottleCurve { mid: 0.5, hover: 0.5, expo: 0.0, ..curve };
        assert!((identity.throttle(1525.0) - 0.5).abs() < 1e-12);
    }

    proptest! {
        #[test]
        fn curves_are_odd_and_finite(
            kind in 0_u8..5, rc_rate in 1.0..255.0, srate in 0.0..255.0, expo in 0.0..100.0, x in -1.0..1.0
        ) {
            let curve = curve(RatesType::from_repr(kind).unwrap(), rc_rate, srate, expo);
            let rate = curve.rate_dps(x);
            prop_assert!(rate.abs() <= 1998.0);
            prop_assert!((rate + curve.rate_dps(-x)).abs() < 1e-9);
        }

        #[test]
        fn throttle_never_falls_with_the_stick(
            mid in 0.0..1.0, hover in 0.0..1.0, expo in 0.0..1.0, a in 900.0..2100.0, b in 900.0..2100.0
        ) {
            let curve = ThrottleCurve {
                zero_us: 1050.0, mid, hover, expo, limit: ThrottleLimit::Off, limit_share: 1.0,
            };
            let (low, high) = if a < b { (a, b) } else { (b, a) };
            prop_assert!(curve.throttle(low) <= curve.throttle(high) + 1e-12);
        }
    }
}
