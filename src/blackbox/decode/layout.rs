//! The fields of a frame as steps: how many bytes to read, which values to add.

use super::super::field::{Encoding, Field, Predictor};
use super::bytes::{Bytes, Stop, from_zigzag};
use super::group;
use super::predict::{Context, Prediction};

/// The fields of a frame, and what their bytes mean.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Layout {
    fields: Vec<Field>,
    reads: Vec<Read>,
    predictions: Vec<Prediction>,
}

/// Fields in a row that are read alike.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Read {
    from: usize,
    to: usize,
    encoding: Encoding,
}

/// Returns the most fields that one read takes.
fn group_size(encoding: Encoding) -> usize {
    match encoding {
        Encoding::Tag8_8Svb => 8,
        Encoding::Tag2_3S32 | Encoding::Tag2_3SVariable => 3,
        Encoding::Tag8_4S16 => 4,
        Encoding::SignedVb
        | Encoding::UnsignedVb
        | Encoding::Neg14Bit
        | Encoding::EliasDeltaU32
        | Encoding::EliasDeltaS32
        | Encoding::Null => usize::MAX,
    }
}

/// Returns how a field is read. A field that counts iterations has no bytes.
fn read_encoding(field: &Field) -> Encoding {
    if field.predictor == Predictor::Increment { Encoding::Null } else { field.encoding }
}

fn is_bit_code(encoding: Encoding) -> bool {
    matches!(encoding, Encoding::EliasDeltaU32 | Encoding::EliasDeltaS32)
}

impl Layout {
    pub(super) fn new(fields: Vec<Field>) -> Self {
        let mut reads: Vec<Read> = Vec::new();
        for (at, field) in fields.iter().enumerate() {
            let encoding = read_encoding(field);
            match reads.last_mut() {
                Some(last) if last.encoding == encoding && at - last.from < group_size(encoding) => {
                    last.to = at + 1;
                }
                _ => reads.push(Read { from: at, to: at + 1, encoding }),
            }
        }
        let predictions = Prediction::all(&fields);
        Self { fields, reads, predictions }
    }

    pub(super) fn fields(&self) -> &[Field] {
        &self.fields
    }

    /// Returns the place of the field with this name.
    pub(super) fn place(&self, name: &str) -> Option<usize> {
        self.fields.iter().position(|field| field.name == name)
    }

    /// Returns `true` if a field has this predictor.
    pub(super) fn predicts(&self, predictor: Predictor) -> bool {
        self.fields.iter().any(|field| field.predictor == predictor)
    }

    /// Makes the fields with this predictor signed.
    pub(super) fn sign(&mut self, predictor: Predictor) {
        let fields = self.fields.iter_mut().filter(|field| field.predictor == predictor);
        fields.for_each(|field| field.signed = true);
    }

    /// Decodes a frame after its letter into `values`, one for each field.
    pub(super) fn decode(
        &self,
        bytes: &mut Bytes<'_>,
        values: &mut [i32],
        context: &Context<'_>,
    ) -> Result<(), Stop> {
        let mut bits_go_on = false;
        for Read { from, to, encoding } in &self.reads {
            let values = &mut values[*from..*to];
            if !bits_go_on {
                bytes.align();
            }
            match encoding {
                Encoding::SignedVb => each(values, || bytes.signed_vb())?,
                Encoding::UnsignedVb => each(values, || Ok(bytes.unsigned_vb()? as i32))?,
                Encoding::Neg14Bit => each(values, || bytes.neg_14_bit())?,
                Encoding::EliasDeltaU32 => each(values, || Ok(bytes.elias_delta()? as i32))?,
                Encoding::EliasDeltaS32 => each(values, || Ok(from_zigzag(bytes.elias_delta()?)))?,
                Encoding::Null => values.fill(0),
                Encoding::Tag8_8Svb => group::tag8_8svb(bytes, values)?,
                Encoding::Tag2_3S32 => group::tag2_3s32(bytes, values)?,
                Encoding::Tag2_3SVariable => group::tag2_3svariable(bytes, values)?,
                Encoding::Tag8_4S16 => group::tag8_4s16(bytes, values)?,
            }
            // A field without bytes is no border for bits.
            bits_go_on = is_bit_code(*encoding) || *encoding == Encoding::Null && bits_go_on;
        }
        for prediction in &self.predictions {
            prediction.add(values, context);
        }
        Ok(())
    }
}

fn each(values: &mut [i32], mut read: impl FnMut() -> Result<i32, Stop>) -> Result<(), Stop> {
    for value in values {
        *value = read()?;
    }
    Ok(())
}
