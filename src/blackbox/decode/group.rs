//! The encodings that pack several fields.
//!
//! Each function writes as many values as `values` has room for; the missing fields of an incomplete group take their bytes,
//! too.

use super::bytes::{Bytes, Stop, sign_extended};

/// Stores the values for which there is room.
fn store(values: &mut [i32], decoded: impl IntoIterator<Item = i32>) {
    for (value, decoded) in values.iter_mut().zip(decoded) {
        *value = decoded;
    }
}

/// Up to eight values: a byte with a bit for each that is not zero, then those. A single value has no such byte.
pub(super) fn tag8_8svb(bytes: &mut Bytes<'_>, values: &mut [i32]) -> Result<(), Stop> {
    if let [only] = values {
        *only = bytes.signed_vb()?;
        return Ok(());
    }
    let tag = bytes.byte()?;
    for (at, value) in values.iter_mut().enumerate() {
        *value = if tag >> at & 1 == 0 { 0 } else { bytes.signed_vb()? };
    }
    Ok(())
}

/// Three values of one to four bytes each: the low six bits of `tag` are the three lengths.
fn three_lengths(tag: u8, bytes: &mut Bytes<'_>, values: &mut [i32]) -> Result<(), Stop> {
    let mut decoded = [0; 3];
    for (at, value) in decoded.iter_mut().enumerate() {
        let count = usize::from(tag >> (2 * at) & 3) + 1;
        *value = sign_extended(bytes.little_endian(count)?, 8 * count as u32);
    }
    store(values, decoded);
    Ok(())
}

/// Three values in the low bits of `packed`, the first one highest, with these numbers of bits.
fn packed_three(packed: u32, [first, second, third]: [u32; 3], values: &mut [i32]) {
    let decoded = [(packed >> (second + third), first), (packed >> third, second), (packed, third)];
    store(values, decoded.map(|(low, bits)| sign_extended(low, bits)));
}

/// Three values of 2, 4 or 6 bits, or of one to four bytes.
pub(super) fn tag2_3s32(bytes: &mut Bytes<'_>, values: &mut [i32]) -> Result<(), Stop> {
    let tag = bytes.byte()?;
    match tag >> 6 {
        0 => packed_three(tag.into(), [2, 2, 2], values),
        1 => packed_three(u32::from(tag) << 8 | u32::from(bytes.byte()?), [4, 4, 4], values),
        2 => {
            let others = [bytes.byte()?, bytes.byte()?];
            store(values, [tag, others[0], others[1]].map(|byte| sign_extended(byte.into(), 6)));
        }
        _ => three_lengths(tag, bytes, values)?,
    }
    Ok(())
}

/// Three values of 2, 2, 2, of 5, 5, 4 or of 8, 7, 7 bits, or of one to four bytes.
pub(super) fn tag2_3svariable(bytes: &mut Bytes<'_>, values: &mut [i32]) -> Result<(), Stop> {
    let tag = bytes.byte()?;
    let mut packed = u32::from(tag);
    let mut more = |count| {
        for _ in 0..count {
            packed = packed << 8 | u32::from(bytes.byte()?);
        }
        Ok(packed)
    };
    match tag >> 6 {
        0 => packed_three(more(0)?, [2, 2, 2], values),
        1 => packed_three(more(1)?, [5, 5, 4], values),
        2 => packed_three(more(2)?, [8, 7, 7], values),
        _ => three_lengths(tag, bytes, values)?,
    }
    Ok(())
}

/// Four values of 0, 4, 8 or 16 bits. Half bytes are packed high first, and the last one is padded.
pub(super) fn tag8_4s16(bytes: &mut Bytes<'_>, values: &mut [i32]) -> Result<(), Stop> {
    let tag = bytes.byte()?;
    let mut half = None;
    let mut decoded = [0; 4];
    for (at, value) in decoded.iter_mut().enumerate() {
        let halves = [0, 1, 2, 4][usize::from(tag >> (2 * at) & 3)];
        let mut packed = 0;
        for _ in 0..halves {
            let low = match half.take() {
                Some(low) => low,
                None => {
                    let byte = bytes.byte()?;
                    half = Some(byte & 0x0f);
                    byte >> 4
                }
            };
            packed = packed << 4 | u32::from(low);
        }
        *value = if halves == 0 { 0 } else { sign_extended(packed, 4 * halves) };
    }
    store(values, decoded);
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    type Group = fn(&mut Bytes<'_>, &mut [i32]) -> Result<(), Stop>;

    /// Decodes all bytes as one group.
    fn decoded<const N: usize>(group: Group, bytes: &[u8]) -> [i32; N] {
        let mut values = [99; N];
        let mut rest = Bytes::new(bytes);
        assert_eq!(group(&mut rest, &mut values), Ok(()));
        assert_eq!(rest.remaining(), 0);
        for end in 0..bytes.len() {
            assert_eq!(group(&mut Bytes::new(&bytes[..end]), &mut [0; N]), Err(Stop::Short));
        }
        values
    }

    #[test]
    fn worked_groups() {
        assert_eq!(decoded(tag2_3s32, &[0x1c]), [1, -1, 0]);
        assert_eq!(decoded(tag8_8svb, &[0x12, 0x01, 0x0e]), [0, -1, 0, 0, 7]);
        assert_eq!(decoded(tag8_8svb, &[0x0e]), [7]);
        assert_eq!(decoded(tag8_4s16, &[0xe4, 0x39, 0xc0, 0x1f, 0x40]), [0, 3, -100, 500]);
    }

    #[test]
    fn every_size_of_the_groups_of_three() {
        assert_eq!(decoded(tag2_3s32, &[0x47, 0x8f]), [7, -8, -1]);
        assert_eq!(decoded(tag2_3s32, &[0x9f, 0x20, 0x01]), [31, -32, 1]);
        assert_eq!(
            decoded(tag2_3s32, &[0xf4, 0x80, 0xff, 0x7f, 0x00, 0x00, 0x00, 0x80]),
            [-128, 32767, i32::MIN]
        );
        assert_eq!(decoded(tag2_3s32, &[0xc2, 0x56, 0x34, 0x92, 0x01, 0x02]), [-7_195_562, 1, 2]);
        assert_eq!(decoded(tag2_3svariable, &[0x1c]), [1, -1, 0]);
        // 01 01111 10000 1111
        assert_eq!(decoded(tag2_3svariable, &[0x5f, 0x0f]), [15, -16, -1]);
        // 10 01111111 1000000 0000001
        assert_eq!(decoded(tag2_3svariable, &[0x9f, 0xe0, 0x01]), [127, -64, 1]);
        assert_eq!(decoded(tag2_3svariable, &[0xc0, 0x01, 0x02, 0x03]), [1, 2, 3]);
    }

    #[test]
    fn half_bytes_are_packed_across_bytes() {
        assert_eq!(decoded(tag8_4s16, &[0x00]), [0, 0, 0, 0]);
        assert_eq!(decoded(tag8_4s16, &[0x55, 0x18, 0x7f]), [1, -8, 7, -1]);
        assert_eq!(
            decoded(tag8_4s16, &[0xff, 0x80, 0, 0x7f, 0xff, 0, 1, 0xff, 0xff]),
            [-32768, 32767, 1, -1]
        );
    }

    #[test]
    fn an_incomplete_group_gives_the_values_that_it_has() {
        assert_eq!(decoded(tag2_3s32, &[0x1c]), [1, -1]);
        assert_eq!(decoded(tag8_4s16, &[0x55, 0x18, 0x7f]), [1, -8]);
    }
}
