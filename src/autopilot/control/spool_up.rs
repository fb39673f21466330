//! The throttle until the craft leaves the ground.

/// The share of the hover throttle at which the rise begins. No airframe that flies with half the parameter lifts off
/// there.
const START_SHARE: f64 = 0.4;
/// Growth of the throttle above its zero, 1/s.
const GROWTH_PER_S: f64 = 0.5;

/// Raises the throttle from well below the hover throttle until the craft lifts off, so that the lifting throttle is
/// known. A wrong hover throttle then neither throws the craft into the air nor keeps it on the ground.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct SpoolUp(Option<f64>);

impl SpoolUp {
    /// Returns the throttle of a cycle on the ground, µs. `hover_us` is the hover throttle as far as it is known,
    /// `zero_us` the throttle without thrust. Without a command to climb it stays at the minimum.
    pub(super) fn update(
        &mut self,
        wants_climb: bool,
        (hover_us, zero_us): (f64, f64),
        (min_us, max_us): (f64, f64),
        dt: f64,
    ) -> f64 {
        if !wants_climb {
            self.0 = None;
            return min_us;
        }
        let before = self.0.unwrap_or((zero_us + START_SHARE * (hover_us - zero_us)).max(min_us));
        let now = (before + GROWTH_PER_S * (before - zero_us) * dt).clamp(min_us, max_us.max(min_us));
        self.0 = Some(now);
        now
    }

    /// Reports that the craft has left the ground. Returns `true` if this throttle lifted it.
    pub(super) fn lift_off(&mut self) -> bool {
        self.0.take().is_some()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_throttle_rises_from_below_hover_to_its_limit_and_falls_when_nobody_climbs() {
        let mut spool = SpoolUp::default();
        let mut update = |climbs| spool.update(climbs, (1500.0, 1050.0), (1100.0, 1900.0), 0.01);
        assert_eq!(update(false), 1100.0);
        let first = update(true);
        assert!((1230.0..1240.0).contains(&first), "{first}");
        let hover = (0..).take_while(|_| update(true) < 1500.0).count();
        assert!((120..250).contains(&hover), "{hover} cycles to the hover throttle");
        assert!((0..400).all(|_| update(true) <= 1900.0));
        assert_eq!(update(true), 1900.0);
        assert_eq!(update(false), 1100.0);
    }
}
