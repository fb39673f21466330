//! The quality of the receiver and its surroundings: `--world gps=…`. `docs/physics.md` names the sources of the
//! figures.

/// The quality of GPS solutions with real noise.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, Default, strum::Display, strum::EnumString, strum::VariantNames,
)]
#[strum(serialize_all = "lowercase")]
pub enum GpsGrade {
    /// A receiver with carrier-phase corrections, integers fixed.
    Rtk,
    /// A good multi-band receiver under open sky.
    #[default]
    Open,
    /// A single-band receiver under open sky.
    Consumer,
    /// A single-band receiver among buildings, with multipath.
    Urban,
}

/// The errors of a grade with its full constellation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct GradeErrors {
    /// White position error, standard deviation, m, horizontally.
    pub position_white_m: f64,
    /// Wandering position error: standard deviation, m, and time constant, s, horizontally.
    pub wander_sigma_m: f64,
    pub wander_tau_s: f64,
    /// White velocity error, standard deviation, m/s: horizontally and vertically.
    pub velocity_white_mps: [f64; 2],
    /// Horizontal position accuracy that the receiver reports, m.
    pub horizontal_accuracy_m: f64,
    /// Horizontal dilution of precision.
    pub hdop: f64,
    pub sats: u8,
    /// `true` if buildings mask satellites and reflect their signals.
    pub is_urban: bool,
}

/// The white velocity errors of a receiver with a clear view, m/s: horizontally and vertically.
const CLEAR_VELOCITY_MPS: [f64; 2] = [0.05, 0.08];

impl GpsGrade {
    pub(super) const fn errors(self) -> GradeErrors {
        match self {
            Self::Rtk => GradeErrors {
                position_white_m: 0.01,
                wander_sigma_m: 0.02,
                wander_tau_s: 20.0,
                velocity_white_mps: CLEAR_VELOCITY_MPS,
                horizontal_accuracy_m: 0.03,
                hdop: 0.7,
                sats: 12,
                is_urban: false,
            },
            Self::Open => GradeErrors {
                position_white_m: 0.03,
                wander_sigma_m: 0.25,
                wander_tau_s: 60.0,
                velocity_white_mps: CLEAR_VELOCITY_MPS,
                horizontal_accuracy_m: 1.0,
                hdop: 0.8,
                sats: 12,
                is_urban: false,
            },
            Self::Consumer => GradeErrors {
                position_white_m: 0.1,
                wander_sigma_m: 1.0,
                wander_tau_s: 120.0,
                velocity_white_mps: CLEAR_VELOCITY_MPS,
                horizontal_accuracy_m: 2.5,
                hdop: 1.0,
                sats: 10,
                is_urban: false,
            },
            Self::Urban => GradeErrors {
                position_white_m: 0.3,
                wander_sigma_m: 3.0,
                wander_tau_s: 30.0,
                velocity_white_mps: [0.3, 0.48],
                horizontal_accuracy_m: 6.0,
                hdop: 1.6,
                sats: 10,
                is_urban: true,
            },
        }
    }
}
