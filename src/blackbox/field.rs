//! The fields of frames, and how their values become bytes.

/// The kind of a frame. `letter` gives the byte with which it begins in the log.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, strum::EnumIter, strum::EnumCount)]
pub enum FrameKind {
    /// A main frame with whole values.
    Intra,
    /// A main frame with differences from the main frames before it.
    Inter,
    /// Modes, state and receiver flags.
    Slow,
    /// The place of home.
    GpsHome,
    /// A navigation solution of the GPS.
    Gps,
    /// An event.
    Event,
}

impl FrameKind {
    /// Returns the first byte of a frame of this kind.
    pub fn letter(self) -> u8 {
        match self {
            Self::Intra => b'I',
            Self::Inter => b'P',
            Self::Slow => b'S',
            Self::GpsHome => b'H',
            Self::Gps => b'G',
            Self::Event => b'E',
        }
    }

    /// Returns the kind of the frame that begins with this byte.
    pub fn from_letter(letter: u8) -> Option<Self> {
        use strum::IntoEnumIterator as _;
        Self::iter().find(|kind| kind.letter() == letter)
    }
}

/// How the difference between a value and its prediction becomes bytes. The number is the one of the header.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, strum::FromRepr, strum::EnumIter)]
#[repr(u8)]
pub enum Encoding {
    /// Zigzag, then as [`Self::UnsignedVb`].
    SignedVb = 0,
    /// Seven bits a byte, the lowest first; bit 7 is set if more bytes follow.
    UnsignedVb = 1,
    /// The negated value, 14 bits, as [`Self::UnsignedVb`].
    Neg14Bit = 3,
    /// Elias delta code, unsigned; in old logs only.
    EliasDeltaU32 = 4,
    /// Elias delta code, signed; in old logs only.
    EliasDeltaS32 = 5,
    /// A byte of flags for up to eight fields, then each value that is not zero.
    Tag8_8Svb = 6,
    /// Three fields of 2, 4, 6 or up to 32 bits.
    Tag2_3S32 = 7,
    /// Four fields of 0, 4, 8 or 16 bits.
    Tag8_4S16 = 8,
    /// No bytes: the value is zero.
    Null = 9,
    /// Three fields of 2,2,2, of 5,5,4, of 8,7,7 or of up to 32 bits.
    Tag2_3SVariable = 10,
}

/// The value to which the decoded difference is added. The number is the one of the header.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, strum::FromRepr, strum::EnumIter)]
#[repr(u8)]
pub enum Predictor {
    Zero = 0,
    /// The value of the main frame before.
    Previous = 1,
    /// The continuation of the line through the two main frames before.
    StraightLine = 2,
    /// The average of the two main frames before, truncated towards zero.
    Average2 = 3,
    /// The header's `minthrottle`.
    MinThrottle = 4,
    /// The first motor of this frame.
    Motor0 = 5,
    /// The value of the main frame before, plus the number of loops since.
    Increment = 6,
    /// The coordinate of home: the latitude for the first such field, the longitude for the second.
    HomeCoordinate = 7,
    /// 1500.
    Centre1500 = 8,
    /// The header's `vbatref`.
    VbatReference = 9,
    /// The time of the last main frame.
    LastMainFrameTime = 10,
    /// The lower number of the header's `motorOutput`.
    MinMotor = 11,
}

/// A field of a frame.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Field {
    /// The name in the header, for example `gyroADC[0]`.
    pub name: String,
    pub signed: bool,
    pub predictor: Predictor,
    pub encoding: Encoding,
}

#[cfg(test)]
mod tests {
    use strum::IntoEnumIterator as _;

    use super::*;

    #[test]
    fn each_kind_is_found_by_its_letter() {
        for kind in FrameKind::iter() {
            assert_eq!(FrameKind::from_letter(kind.letter()), Some(kind));
        }
        assert_eq!(FrameKind::from_letter(b'X'), None);
    }

    #[test]
    fn the_numbers_of_the_header_have_their_encodings_and_predictors() {
        assert_eq!(Encoding::from_repr(8), Some(Encoding::Tag8_4S16));
        assert_eq!(Encoding::from_repr(2), None);
        assert_eq!(Predictor::from_repr(11), Some(Predictor::MinMotor));
        assert_eq!(Predictor::from_repr(12), None);
    }
}
