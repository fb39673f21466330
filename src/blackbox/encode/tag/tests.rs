//! Groups of values, byte by byte, and read back by readers that work differently: digit by digit.

use proptest::prelude::*;

use super::super::buffer::written;

#[test]
fn worked_groups_have_their_bytes() {
    assert_eq!(written(|log| log.tag2_3s32([1, -1, 0])), [0x1c]);
    assert_eq!(written(|log| log.tag8_8svb(&[0, -1, 0, 0, 7])), [0x12, 0x01, 0x0e]);
    assert_eq!(written(|log| log.tag8_4s16([0, 3, -100, 500])), [0xe4, 0x39, 0xc0, 0x1f, 0x40]);
}

#[test]
fn three_values_take_the_shortest_form_that_holds_the_largest() {
    let length = |values| written(|log| log.tag2_3s32(values)).len();
    assert_eq!(length([1, -2, 0]), 1);
    assert_eq!(length([2, 0, 0]), 2);
    assert_eq!(length([0, -8, 7]), 2);
    assert_eq!(length([0, 0, 8]), 3);
    assert_eq!(length([31, -32, 0]), 3);
    assert_eq!(length([32, 0, 0]), 1 + 3);
    assert_eq!(length([128, 40_000, -8_388_608]), 1 + 2 + 3 + 3);
    assert_eq!(length([i32::MIN, i32::MAX, 0]), 1 + 4 + 4 + 1);
}

#[test]
fn a_single_value_has_no_flags() {
    assert_eq!(written(|log| log.tag8_8svb(&[-3])), [0x05]);
    assert!(written(|log| log.tag8_8svb(&[])).is_empty());
    assert_eq!(written(|log| log.tag8_8svb(&[0, 0])), [0]);
}

#[test]
fn more_than_eight_values_have_more_flags() {
    let mut values = [0; 10];
    (values[0], values[9]) = (1, -1);
    assert_eq!(written(|log| log.tag8_8svb(&values)), [0x01, 0x02, 0x02, 0x01]);
    assert_eq!(written(|log| log.tag8_8svb(&values[..9])), [0x01, 0x02, 0x00]);
}

#[test]
fn nibbles_fill_bytes_from_the_top() {
    assert_eq!(written(|log| log.tag8_4s16([0; 4])), [0]);
    assert_eq!(written(|log| log.tag8_4s16([1, 2, -1, 0])), [0x15, 0x12, 0xf0]);
    assert_eq!(
        written(|log| log.tag8_4s16([-32_768, 32_767, 128, -129])),
        [0xff, 0x80, 0x00, 0x7f, 0xff, 0x00, 0x80, 0xff, 0x7f]
    );
}

/// Reads signed numbers of these widths in bits, from the top of the first byte on.
fn signed_from_top(bytes: &[u8], widths: &[u32]) -> Vec<i32> {
    let digits: String = bytes.iter().map(|byte| format!("{byte:08b}")).collect();
    let mut rest = digits.as_str();
    let mut values = Vec::new();
    for width in widths {
        let (value, after) = rest.split_at(*width as usize);
        rest = after;
        let raw = if value.is_empty() { 0 } else { i64::from_str_radix(value, 2).unwrap() };
        values.push(if value.starts_with('1') { raw - (1 << width) } else { raw } as i32);
    }
    assert!(rest.len() < 8 && !rest.contains('1'), "unused bytes: {rest}");
    values
}

fn read_tag2_3s32(bytes: &[u8]) -> Vec<i32> {
    match bytes[0] >> 6 {
        0 => signed_from_top(&[bytes[0] << 2], &[2, 2, 2]),
        1 => signed_from_top(bytes, &[4, 4, 4, 4])[1..].to_vec(),
        2 => bytes.iter().map(|byte| signed_from_top(&[byte << 2], &[6])[0]).collect(),
        _ => {
            let mut rest = &bytes[1..];
            let values = [0, 2, 4].map(|shift| {
                let (value, after) = rest.split_at(usize::from(bytes[0] >> shift & 3) + 1);
                rest = after;
                let big_endian: Vec<u8> = value.iter().rev().copied().collect();
                signed_from_top(&big_endian, &[8 * value.len() as u32])[0]
            });
            assert!(rest.is_empty());
            values.to_vec()
        }
    }
}

/// Values of every size.
fn of_any_size(bits: u32) -> impl Strategy<Value = i32> {
    (any::<i32>(), 32 - bits..32).prop_map(|(value, shift)| value >> shift)
}

proptest! {
    #[test]
    fn groups_of_three_are_read_back(values in prop::array::uniform3(of_any_size(32))) {
        prop_assert_eq!(read_tag2_3s32(&written(|log| log.tag2_3s32(values))), values);
    }

    #[test]
    fn groups_of_four_are_read_back(values in prop::array::uniform4(of_any_size(16))) {
        let bytes = written(|log| log.tag8_4s16(values));
        let widths: Vec<u32> = [0, 2, 4, 6].map(|shift| [0, 4, 8, 16][usize::from(bytes[0] >> shift & 3)]).into();
        prop_assert_eq!(signed_from_top(&bytes[1..], &widths), values);
    }

    #[test]
    fn flagged_values_are_read_back(values in prop::collection::vec(of_any_size(32), 2..=8)) {
        let bytes = written(|log| log.tag8_8svb(&values));
        let mut rest = bytes[1..].iter();
        for (bit, value) in values.iter().enumerate() {
            prop_assert_eq!(bytes[0] >> bit & 1 == 1, *value != 0);
            if *value == 0 {
                continue;
            }
            let mut number = 0_u64;
            for place in 0.. {
                let byte = *rest.next().unwrap();
                number |= u64::from(byte & 0x7f) << (7 * place);
                if byte < 0x80 {
                    break;
                }
            }
            let magnitude = number.div_ceil(2) as i64;
            prop_assert_eq!(if number % 2 == 1 { -magnitude } else { magnitude }, i64::from(*value));
        }
        prop_assert!(rest.next().is_none());
    }
}
