//! Consecutive fields of a frame that are written in the same way.

use super::LogWriter;
use crate::blackbox::{Encoding, Predictor};

/// The encodings that are written. Old logs also have others.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Coding {
    SignedVb,
    UnsignedVb,
    Neg14Bit,
    Tag8_8Svb,
    /// For groups of three.
    Tag2_3S32,
    /// For groups of four. The differences must fit 16 bits.
    Tag8_4S16,
    /// For values that are equal to their prediction.
    Null,
}

impl From<Coding> for Encoding {
    fn from(coding: Coding) -> Self {
        match coding {
            Coding::SignedVb => Self::SignedVb,
            Coding::UnsignedVb => Self::UnsignedVb,
            Coding::Neg14Bit => Self::Neg14Bit,
            Coding::Tag8_8Svb => Self::Tag8_8Svb,
            Coding::Tag2_3S32 => Self::Tag2_3S32,
            Coding::Tag8_4S16 => Self::Tag8_4S16,
            Coding::Null => Self::Null,
        }
    }
}

impl Coding {
    /// Writes values of consecutive fields.
    pub(super) fn write(self, values: &[i32], log: &mut LogWriter<'_>) {
        match self {
            Self::SignedVb => log.all_signed_vb(values),
            Self::UnsignedVb => values.iter().for_each(|value| log.unsigned_vb(value.cast_unsigned())),
            Self::Neg14Bit => values.iter().for_each(|value| log.neg_14bit(*value)),
            Self::Tag8_8Svb => log.tag8_8svb(values),
            Self::Tag2_3S32 => values.as_chunks().0.iter().for_each(|group| log.tag2_3s32(*group)),
            Self::Tag8_4S16 => values.as_chunks().0.iter().for_each(|group| log.tag8_4s16(*group)),
            Self::Null => {}
        }
    }
}

/// The way from a value to bytes: the prediction, and the encoding of the difference from it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Rule(pub Predictor, pub Coding);

/// Consecutive fields of a frame that are written in the same way.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FieldGroup {
    /// The names in the header.
    pub names: &'static [&'static str],
    pub signed: bool,
    /// The rule of `P` frames for a field of the main frames; the rule of its only frame for any other field.
    pub rule: Rule,
    /// The rule of `I` frames. Used for the fields of the main frames only.
    pub intra: Rule,
}

impl FieldGroup {
    /// Returns fields of the main frames.
    pub const fn main(names: &'static [&'static str], signed: bool, intra: Rule, inter: Rule) -> Self {
        Self { names, signed, rule: inter, intra }
    }

    /// Returns fields of a frame that is not a main frame.
    pub const fn side(names: &'static [&'static str], signed: bool, rule: Rule) -> Self {
        Self { names, signed, rule, intra: rule }
    }
}
