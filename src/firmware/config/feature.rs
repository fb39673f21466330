//! Feature switches.

use strum::IntoEnumIterator;

/// A feature; the discriminant is its bit in the stored and transmitted mask.
#[derive(
    Debug,
    Clone,
    Copy,
    PartialEq,
    Eq,
    PartialOrd,
    Ord,
    Hash,
    strum::Display,
    strum::EnumIter,
    strum::IntoStaticStr,
)]
#[strum(serialize_all = "SCREAMING_SNAKE_CASE")]
#[repr(u8)]
#[allow(missing_docs, reason = "the variants have the names of Betaflight")]
pub enum Feature {
    RxPpm = 0,
    /// The receiver is the RC packet on UDP.
    RxUdp = 1,
    InflightAccCal = 2,
    RxSerial = 3,
    /// The motors stop at low throttle.
    MotorStop = 4,
    ServoTilt = 5,
    #[strum(to_string = "SOFTSERIAL")]
    SoftSerial = 6,
    Gps = 7,
    #[strum(to_string = "OPTICALFLOW")]
    OpticalFlow = 8,
    #[strum(to_string = "RANGEFINDER")]
    RangeFinder = 9,
    Telemetry = 10,
    #[strum(to_string = "3D")]
    ThreeD = 12,
    RxParallelPwm = 13,
    /// The receiver is `MSP_SET_RAW_RC`.
    RxMsp = 14,
    RssiAdc = 15,
    LedStrip = 16,
    Display = 17,
    Osd = 18,
    ChannelForwarding = 20,
    Transponder = 21,
    /// Full stabilisation at zero throttle.
    #[strum(to_string = "AIRMODE")]
    AirMode = 22,
    RxSpi = 25,
    EscSensor = 27,
    AntiGravity = 28,
}

impl Feature {
    /// Returns the bit of the feature in the mask.
    pub const fn bit(self) -> u32 {
        1 << self as u32
    }

    /// Returns `true` if this vehicle has the feature.
    pub fn is_available(self) -> bool {
        matches!(
            self,
            Self::RxUdp
                | Self::InflightAccCal
                | Self::MotorStop
                | Self::Gps
                | Self::ThreeD
                | Self::RxMsp
                | Self::AirMode
                | Self::AntiGravity
        )
    }

    /// Returns the feature of this name in any case, or the only feature whose name starts with it.
    pub fn by_name(name: &str) -> Option<Self> {
        let name = name.to_ascii_uppercase();
        let mut starting = Self::iter().filter(|feature| feature.to_string().starts_with(&name));
        Self::iter().find(|feature| feature.to_string() == name).or_else(|| {
            match (starting.next(), starting.next()) {
                (Some(only), None) if !name.is_empty() => Some(only),
                _ => None,
            }
        })
    }
}

/// A set of features.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Features(pub u32);

impl Default for Features {
    /// Returns the default features: receiver on UDP, GPS, airmode, anti gravity.
    fn default() -> Self {
        Self(Feature::RxUdp.bit() | Feature::Gps.bit() | Feature::AirMode.bit() | Feature::AntiGravity.bit())
    }
}

impl Features {
    /// Returns `true` if the feature is on.
    pub const fn has(self, feature: Feature) -> bool {
        self.0 & feature.bit() != 0
    }

    /// Turns a feature on or off.
    pub const fn set(&mut self, feature: Feature, on: bool) {
        if on {
            self.0 |= feature.bit();
        } else {
            self.0 &= !feature.bit();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_whole_name_wins_and_a_prefix_must_be_unique() {
        assert_eq!(Feature::by_name("gps"), Some(Feature::Gps));
        assert_eq!(Feature::by_name("motor"), Some(Feature::MotorStop));
        assert_eq!(Feature::by_name("3d"), Some(Feature::ThreeD));
        for wrong in ["", "RX", "A", "BLACKBOX", "GPSX"] {
            assert_eq!(Feature::by_name(wrong), None, "{wrong}");
        }
    }

    #[test]
    fn the_default_mask_is_the_one_on_the_wire() {
        assert_eq!(Features::default().0, 0x1040_0082);
    }
}
