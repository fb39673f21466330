//! The quantities of a waypoint in SI. Each has the resolution and the range of the stored record, so that a plan
//! equals itself after it was stored, sent or written.

/// An altitude above home, to the centimetre.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd, Default)]
pub struct Altitude {
    above_home_m: f64,
}

impl Altitude {
    /// Returns the nearest altitude that a record can hold.
    pub fn above_home(metres: f64) -> Self {
        Self::from_cm(to_cm(metres))
    }

    /// Returns the nearest altitude; `None` if it is beyond the range of a record.
    pub fn checked(above_home_m: f64) -> Option<Self> {
        let range = Self::from_cm(i32::MIN).above_home_m..=Self::from_cm(i32::MAX).above_home_m;
        range.contains(&above_home_m).then(|| Self::above_home(above_home_m))
    }

    /// Returns the altitude above home, m.
    pub fn above_home_m(self) -> f64 {
        self.above_home_m
    }

    /// Returns the altitude changed by so many metres, rounded to the centimetre.
    pub fn raised_m(self, by_m: f64) -> Self {
        Self::from_cm(self.cm().saturating_add(to_cm(by_m)))
    }

    pub(super) fn from_cm(cm: i32) -> Self {
        Self { above_home_m: f64::from(cm) / 100.0 }
    }

    pub(super) fn cm(self) -> i32 {
        to_cm(self.above_home_m)
    }
}

/// Returns whole centimetres, saturated; 0 for NaN.
pub(super) fn to_cm(metres: f64) -> i32 {
    (metres * 100.0).round() as i32
}

/// The speed of a leg, to the cm/s. Zero stands for `ap_max_velocity`.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd, Default)]
pub struct LegSpeed {
    mps: f64,
}

impl LegSpeed {
    /// The greatest speed, m/s.
    pub const MAX_MPS: f64 = 655.35;

    /// Returns the nearest speed that a record can hold.
    pub fn from_mps(mps: f64) -> Self {
        Self::from_cms((mps * 100.0).round() as u16)
    }

    /// Returns the nearest speed; `None` if it is beyond the range of a record.
    pub fn checked(mps: f64) -> Option<Self> {
        let cms = (mps * 100.0).round();
        (0.0..=f64::from(u16::MAX)).contains(&cms).then(|| Self::from_mps(mps))
    }

    /// Returns the speed, m/s.
    pub fn mps(self) -> f64 {
        self.mps
    }

    /// Returns the speed, m/s; `None` if `ap_max_velocity` applies.
    pub fn own_mps(self) -> Option<f64> {
        (self.mps > 0.0).then_some(self.mps)
    }

    pub(super) fn from_cms(cms: u16) -> Self {
        Self { mps: f64::from(cms) / 100.0 }
    }

    pub(super) fn cms(self) -> u16 {
        (self.mps * 100.0).round() as u16
    }
}

/// The time of a HOLD or a DELAY, to the tenth of a second.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd, Default)]
pub struct Seconds(f64);

impl Seconds {
    /// The shortest duration that is not 0. A HOLD of 0 has no end, and one of this duration ends at once.
    pub const AT_ONCE: Self = Self(0.1);

    /// Returns the nearest time that a record can hold.
    pub fn new(seconds: f64) -> Self {
        Self::from_ds((seconds * 10.0).round() as u16)
    }

    /// Returns the time, s.
    pub fn get(self) -> f64 {
        self.0
    }

    /// Returns `true` for a duration of 0.
    pub fn is_zero(self) -> bool {
        self.0 <= 0.0
    }

    /// Returns the time in whole microseconds, without an error of rounding.
    pub fn micros(self) -> u64 {
        u64::from(self.ds()) * 100_000
    }

    pub(super) fn from_ds(ds: u16) -> Self {
        Self(f64::from(ds) / 10.0)
    }

    pub(super) fn ds(self) -> u16 {
        (self.0 * 10.0).round() as u16
    }
}
