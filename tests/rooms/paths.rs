//! The `crate::` and `super::` paths of a file.

use std::collections::BTreeSet;

use crate::source::SourceFile;

/// Returns the rooms that a file names, including its own if it names it.
pub(crate) fn rooms_used(file: &SourceFile) -> BTreeSet<String> {
    let tokens = tokens(&file.text);
    let module = file.module();
    let mut rooms = BTreeSet::new();
    // Inline modules, as the brace depths at which they close.
    let mut inner: Vec<usize> = Vec::new();
    let mut depth = 0;
    for (index, token) in tokens.iter().enumerate() {
        let is_path = |at: usize| tokens.get(at).is_some_and(|token| token == "::");
        match token.as_str() {
            "{" => {
                if index >= 2 && tokens[index - 2] == "mod" {
                    inner.push(depth);
                }
                depth += 1;
            }
            "}" => {
                depth -= 1;
                if inner.last() == Some(&depth) {
                    inner.pop();
                }
            }
            "crate" if is_path(index + 1) => heads(&tokens[index + 2..], &mut rooms),
            "super" if is_path(index + 1) && (index == 0 || tokens[index - 1] != "::") => {
                let mut at = index;
                let mut levels = 0;
                while tokens.get(at).is_some_and(|token| token == "super") && is_path(at + 1) {
                    levels += 1;
                    at += 2;
                }
                // Above the room itself the next word names another room.
                if levels >= module.len() + inner.len() {
                    heads(&tokens[at..], &mut rooms);
                }
            }
            _ => {}
        }
    }
    rooms
}

/// Adds the first word of a path, or of each path of a group in braces, if it is a room.
fn heads(tokens: &[String], rooms: &mut BTreeSet<String>) {
    if tokens.first().is_none_or(|token| token != "{") {
        rooms.extend(tokens.first().filter(|token| is_room(token)).cloned());
        return;
    }
    let mut depth = 0;
    let mut starts = true;
    for token in tokens {
        match token.as_str() {
            "{" => depth += 1,
            "}" => depth -= 1,
            "," if depth == 1 => starts = true,
            word if depth == 1 && starts => {
                starts = false;
                if is_room(word) {
                    rooms.insert(word.to_owned());
                }
            }
            _ => {}
        }
        if depth == 0 {
            return;
        }
    }
}

fn is_room(word: &str) -> bool {
    word.starts_with(|first: char| first.is_ascii_lowercase())
}

/// Splits text into words, `::` and single characters, without comments, strings and character literals.
fn tokens(text: &str) -> Vec<String> {
    let mut tokens = Vec::new();
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        let length = if rest.starts_with("//") {
            rest.find('\n').unwrap_or(rest.len())
        } else if rest.starts_with("/*") {
            rest.find("*/").map_or(rest.len(), |end| end + 2)
        } else if let Some(length) = raw_string(rest) {
            length
        } else if first == '"' {
            string(rest)
        } else if first == '\'' {
            character(rest)
        } else if first.is_alphanumeric() || first == '_' {
            let length = rest.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(rest.len());
            tokens.push(rest[..length].to_owned());
            length
        } else if rest.starts_with("::") {
            tokens.push("::".to_owned());
            2
        } else {
            if !first.is_whitespace() {
                tokens.push(first.to_string());
            }
            first.len_utf8()
        };
        rest = &rest[length..];
    }
    tokens
}

/// Returns the length of a raw string that begins here.
fn raw_string(rest: &str) -> Option<usize> {
    let hashes = rest.strip_prefix("br").or_else(|| rest.strip_prefix('r'))?;
    let count = hashes.len() - hashes.trim_start_matches('#').len();
    let body = hashes[count..].strip_prefix('"')?;
    let end = format!("\"{}", "#".repeat(count));
    let length = body.find(&end)? + end.len();
    Some(rest.len() - body.len() + length)
}

/// Returns the length of a string that begins here.
fn string(rest: &str) -> usize {
    let mut escaped = false;
    for (index, c) in rest.char_indices().skip(1) {
        match c {
            _ if escaped => escaped = false,
            '\\' => escaped = true,
            '"' => return index + 1,
            _ => {}
        }
    }
    rest.len()
}

/// Returns the length of a character literal, or of the mark of a lifetime.
fn character(rest: &str) -> usize {
    let mut inside = rest.chars().skip(1);
    match (inside.next(), inside.next()) {
        (Some('\\'), _) => rest[3..].find('\'').map_or(rest.len(), |end| 3 + end + 1),
        (Some(c), Some('\'')) => 2 + c.len_utf8(),
        _ => 1,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn used(name: &str, text: &str) -> Vec<String> {
        let file = SourceFile { name: name.to_owned(), text: text.to_owned() };
        rooms_used(&file).into_iter().collect()
    }

    #[test]
    fn paths_in_groups_in_code_and_by_super_are_found() {
        assert_eq!(used("a/b.rs", "use crate::{geo::{LatLon, x}, sim, plan::Plan};"), ["geo", "plan", "sim"]);
        assert_eq!(used("a.rs", "fn f() -> crate::geo::LatLon { super::link::open() }"), ["geo", "link"]);
        assert_eq!(used("a/b.rs", "use super::x; use super::super::link::Y;"), ["link"]);
        assert_eq!(used("a.rs", "mod tests { use super::*; use super::super::link; }"), ["link"]);
        assert_eq!(used("a/b.rs", "pub(crate) fn f() {} pub(super) struct S;"), [""; 0]);
    }

    #[test]
    fn comments_strings_and_characters_are_passed_over() {
        let text = "// crate::a\n/* crate::b */ let s = \"crate::c \\\" crate::d\"; let r = r#\"crate::e\"#; \
                    let q = '\"'; let l: &'static str = crate::geo::NAME; let e = '\\''; crate::sim::f();";
        assert_eq!(used("x.rs", text), ["geo", "sim"]);
    }
}
