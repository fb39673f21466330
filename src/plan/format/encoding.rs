//! The bytes of a text file as text.

use std::borrow::Cow;

/// Decodes a text: UTF-8 or UTF-16, each with or without a byte order mark. Lines that end with CR end with LF.
///
/// # Errors
///
/// Returns the reason, with the byte of the first fault.
pub fn decode(bytes: &[u8]) -> Result<Cow<'_, str>, String> {
    let text = match bytes {
        [0xef, 0xbb, 0xbf, rest @ ..] => utf8(rest)?,
        [0xff, 0xfe, rest @ ..] => utf16(rest, u16::from_le_bytes)?,
        [0xfe, 0xff, rest @ ..] => utf16(rest, u16::from_be_bytes)?,
        // The first character of a plan is one of ASCII, and no text has the character 0.
        [first, 0, ..] if *first != 0 => utf16(bytes, u16::from_le_bytes)?,
        [0, second, ..] if *second != 0 => utf16(bytes, u16::from_be_bytes)?,
        _ => utf8(bytes)?,
    };
    Ok(match lines_by_cr(&text) {
        true => Cow::Owned(text.replace("\r\n", "\n").replace('\r', "\n")),
        false => text,
    })
}

/// Returns `true` if a CR without a LF ends a line.
fn lines_by_cr(text: &str) -> bool {
    let bytes = text.as_bytes();
    let is_alone = |(index, byte): (usize, &u8)| *byte == b'\r' && bytes.get(index + 1) != Some(&b'\n');
    bytes.iter().enumerate().any(is_alone)
}

fn utf8(bytes: &[u8]) -> Result<Cow<'_, str>, String> {
    std::str::from_utf8(bytes)
        .map(Cow::Borrowed)
        .map_err(|error| format!("byte {} is not UTF-8 text", error.valid_up_to()))
}

fn utf16(bytes: &[u8], unit: fn([u8; 2]) -> u16) -> Result<Cow<'static, str>, String> {
    let (pairs, rest) = bytes.as_chunks::<2>();
    if !rest.is_empty() {
        return Err("the UTF-16 text ends in the middle of a character".to_owned());
    }
    char::decode_utf16(pairs.iter().map(|&pair| unit(pair)))
        .collect::<Result<String, _>>()
        .map(Cow::Owned)
        .map_err(|_| "the text is not UTF-16".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn utf_16_is_known_without_a_byte_order_mark() {
        for bytes in [&b"a\0b\0\xe4\0"[..], b"\0a\0b\0\xe4"] {
            assert_eq!(decode(bytes).unwrap(), "abä");
        }
        assert_eq!(decode(b"a\0b").unwrap_err(), "the UTF-16 text ends in the middle of a character");
    }

    #[test]
    fn lines_may_end_with_cr() {
        for bytes in [&b"a\rb\r\nc\r"[..], b"a\0\r\0b\0\r\0\n\0c\0\r\0"] {
            assert_eq!(decode(bytes).unwrap(), "a\nb\nc\n");
        }
        assert!(matches!(decode(b"a\r\nb"), Ok(Cow::Borrowed(_))));
    }

    #[test]
    fn the_byte_order_mark_gives_the_encoding() {
        for bytes in [&b"ab"[..], b"\xef\xbb\xbfab", b"\xff\xfea\0b\0", b"\xfe\xff\0a\0b"] {
            assert_eq!(decode(bytes).unwrap(), "ab");
        }
        assert_eq!(decode(b"a\xff").unwrap_err(), "byte 1 is not UTF-8 text");
        assert!(decode(b"\xff\xfea").is_err() && decode(b"\xff\xfe\0\xd8").is_err());
    }
}
