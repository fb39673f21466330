//! Bytes as hexadecimal digits.

/// Returns the bytes of a text of hexadecimal digits, two a byte.
///
/// # Panics
/// Panics if the text has other characters.
pub fn decode(text: &str) -> Vec<u8> {
    let pairs = (0..text.len() / 2).map(|i| &text[2 * i..2 * i + 2]);
    pairs.map(|pair| u8::from_str_radix(pair, 16).expect("hexadecimal digits")).collect()
}

/// Returns the hexadecimal digits of bytes.
pub fn encode(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}
