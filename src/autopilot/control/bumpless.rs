//! Bumpless transfer: the difference between the old and the new demand fades out.

/// The time in which a difference fades out, s.
const FADE_S: f64 = 1.0;

/// A difference that fades out linearly.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct BumplessTransfer {
    offset: f64,
    left_s: f64,
}

impl BumplessTransfer {
    /// Starts the fade: [`BumplessTransfer::apply`] then leads from `old` to `new`, the demands of the same instant.
    pub fn start(&mut self, old: f64, new: f64) {
        let offset = old - new;
        *self = if offset.is_finite() { Self { offset, left_s: FADE_S } } else { Self::default() };
    }

    /// Returns the demand `new` plus the rest of the difference, and fades the difference by `dt` seconds.
    pub fn apply(&mut self, new: f64, dt: f64) -> f64 {
        let out = new + self.offset * (self.left_s / FADE_S);
        self.left_s = (self.left_s - dt).max(0.0);
        out
    }

    /// Returns the part of the difference that is still added.
    pub fn remaining(&self) -> f64 {
        self.offset * (self.left_s / FADE_S)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn leads_from_the_old_to_the_new_value() {
        let mut transfer = BumplessTransfer::default();
        transfer.start(10.0, 2.0);
        assert!((transfer.apply(2.0, 0.5) - 10.0).abs() < 1e-12);
        assert!((transfer.apply(2.0, 0.5) - 6.0).abs() < 1e-12);
        assert!((transfer.apply(2.0, 0.5) - 2.0).abs() < 1e-12);
    }
}
