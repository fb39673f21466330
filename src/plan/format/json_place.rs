//! The places of values in a JSON text that was parsed without an error.

use std::ops::Range;

/// Returns the bytes of the value of a JSON pointer; the longest part of the pointer that is there decides.
pub(super) fn span(text: &str, pointer: &str) -> Range<usize> {
    let bytes = text.as_bytes();
    let mut at = blanks(bytes, 0);
    for part in pointer.split('/').skip(1) {
        match child(bytes, at, part) {
            Some(found) => at = found,
            None => break,
        }
    }
    at..end(bytes, at)
}

/// Returns the start of a child of the object or array that starts at `at`.
fn child(bytes: &[u8], at: usize, part: &str) -> Option<usize> {
    let is_object = bytes.get(at) == Some(&b'{');
    if !is_object && bytes.get(at) != Some(&b'[') {
        return None;
    }
    let mut at = blanks(bytes, at + 1);
    let mut index = 0_usize;
    while !matches!(bytes.get(at), None | Some(b'}' | b']')) {
        let mut is_wanted = !is_object && part.parse() == Ok(index);
        if is_object {
            let key = at + 1..end(bytes, at).saturating_sub(1);
            is_wanted = bytes.get(key.clone()) == Some(part.as_bytes());
            // The colon.
            at = blanks(bytes, blanks(bytes, key.end + 1) + 1);
        }
        if is_wanted {
            return Some(at);
        }
        at = blanks(bytes, end(bytes, at).max(at + 1));
        at = if bytes.get(at) == Some(&b',') { blanks(bytes, at + 1) } else { at };
        index += 1;
    }
    None
}

fn blanks(bytes: &[u8], from: usize) -> usize {
    let count = bytes.iter().skip(from).take_while(|byte| byte.is_ascii_whitespace()).count();
    from + count
}

/// Returns the end of the value that starts at `at`.
fn end(bytes: &[u8], at: usize) -> usize {
    let mut depth = 0_usize;
    let mut at = at;
    while let Some(&byte) = bytes.get(at) {
        match byte {
            b'"' => {
                at += 1;
                while let Some(&byte) = bytes.get(at).filter(|&&byte| byte != b'"') {
                    at += if byte == b'\\' { 2 } else { 1 };
                }
                at += 1;
            }
            b'{' | b'[' => {
                depth += 1;
                at += 1;
            }
            b'}' | b']' if depth > 0 => {
                depth -= 1;
                at += 1;
            }
            b'}' | b']' | b',' if depth == 0 => break,
            byte if depth == 0 && byte.is_ascii_whitespace() => break,
            _ => {
                at += 1;
                continue;
            }
        }
        if depth == 0 {
            break;
        }
    }
    at.min(bytes.len())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pointers_lead_to_values() {
        let text = r#" {"a\"}": "x]", "b" : [ 1, {"c":[-2.5e3 , null]}, "d\\" ] }"#;
        for (pointer, value) in [
            ("/b/0", "1"),
            ("/b/1", r#"{"c":[-2.5e3 , null]}"#),
            ("/b/1/c/0", "-2.5e3"),
            ("/b/1/c/1", "null"),
            ("/b/2", r#""d\\""#),
            ("/b/9", r#"[ 1, {"c":[-2.5e3 , null]}, "d\\" ]"#),
            ("/x/y", text.trim()),
        ] {
            assert_eq!(&text[span(text, pointer)], value, "{pointer}");
        }
    }

    #[test]
    fn no_text_causes_a_panic() {
        for text in ["", "{", "[", "\"", "{\"a\"", "{\"a\":", "[1", "[1,", "\"\\", "]", "{]", "{a:1}"] {
            for pointer in ["", "/a", "/0", "/a/b"] {
                assert!(span(text, pointer).end <= text.len());
            }
        }
    }
}
