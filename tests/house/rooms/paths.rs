//! The paths of a file: what it takes from which room, and how.

use std::collections::BTreeSet;

use crate::rooms::source::SourceFile;

/// A path that a file names, or a leaf of the group of a `use`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Named {
    /// The segments from the root of the crate, or from an external crate.
    pub(crate) path: Vec<String>,
    /// The name under which a `use` makes it known.
    pub(crate) name: String,
    /// `true` if it begins at this crate.
    pub(crate) is_ours: bool,
    /// `true` if a `pub use`, a `pub(crate) use` or a public type alias passes it on.
    pub(crate) is_passed_on: bool,
}

impl Named {
    fn segment(&self, at: usize) -> &str {
        self.path.get(at).map_or("", String::as_str)
    }

    /// Returns the room, and the first segment below it; empty if there is none.
    pub(crate) fn room(&self) -> (&str, &str) {
        (self.segment(0), self.segment(1))
    }
}

/// Returns the rooms that a file names, with the first segments below them.
pub(crate) fn rooms_used(file: &SourceFile) -> BTreeSet<(String, String)> {
    let ours = named(file).into_iter().filter(|named| named.is_ours);
    ours.filter(|named| is_room(named.room().0))
        .map(|named| (named.room().0.to_owned(), named.room().1.to_owned()))
        .collect()
}

/// Returns the paths of a file that begin with `crate`, `super` or `std`, and all leaves of its `use` declarations.
pub(crate) fn named(file: &SourceFile) -> Vec<Named> {
    let tokens = tokens(&file.text);
    let module = file.module();
    let mut found = Vec::new();
    // Inline modules, with the brace depths at which they close.
    let mut inner: Vec<(String, usize)> = Vec::new();
    let mut depth = 0;
    let mut index = 0;
    while index < tokens.len() {
        let is_path = |at: usize| tokens.get(at).is_some_and(|token| token == "::");
        let token = tokens[index].as_str();
        match token {
            "{" => {
                if index >= 2 && tokens[index - 2] == "mod" {
                    inner.push((tokens[index - 1].clone(), depth));
                }
                depth += 1;
            }
            "}" => {
                depth -= 1;
                inner.pop_if(|(_, at)| *at == depth);
            }
            "use" => {
                let mut leaves = Vec::new();
                let end = leaves_of(&tokens, index + 1, &[], &mut leaves);
                let is_passed_on = is_public(&tokens[..index]);
                let modules: Vec<&str> = module
                    .iter()
                    .map(String::as_str)
                    .chain(inner.iter().map(|(name, _)| name.as_str()))
                    .collect();
                found.extend(leaves.into_iter().map(|leaf| leaf.resolved(&modules, is_passed_on)));
                index = end;
                continue;
            }
            "crate" | "super" | "std" | "tokio" | "rustix" | "tempfile"
                if is_path(index + 1) && !follows_a_segment(&tokens[..index]) =>
            {
                let mut leaves = Vec::new();
                let end = leaves_of(&tokens, index, &[], &mut leaves);
                let modules: Vec<&str> = module
                    .iter()
                    .map(String::as_str)
                    .chain(inner.iter().map(|(name, _)| name.as_str()))
                    .collect();
                let is_alias = index >= 3
                    && tokens[index - 1] == "="
                    && tokens[index - 3] == "type"
                    && is_public(&tokens[..index - 3]);
                found.extend(leaves.into_iter().map(|leaf| leaf.resolved(&modules, is_alias)));
                index = end;
                continue;
            }
            _ => {}
        }
        index += 1;
    }
    found
}

/// Returns `true` if the tokens end within a path; a `::` at its beginning is not one.
fn follows_a_segment(before: &[String]) -> bool {
    let mut last = before.iter().rev().map(String::as_str);
    last.next() == Some("::") && last.next().is_some_and(|token| is_word(token) || token == ">")
}

/// Returns `true` if the tokens end with `pub` or `pub(crate)`.
fn is_public(before: &[String]) -> bool {
    let last: Vec<&str> = before.iter().rev().take(4).map(String::as_str).collect();
    last.first() == Some(&"pub") || last == [")", "crate", "(", "pub"]
}

/// A path as it is written, and its name.
struct Leaf {
    path: Vec<String>,
    name: String,
}

impl Leaf {
    /// Returns the path from the root of the crate, for a path in this module.
    fn resolved(self, module: &[&str], is_passed_on: bool) -> Named {
        let Self { path, name } = self;
        let up = path.iter().take_while(|segment| *segment == "super").count();
        let (mut whole, skip, is_ours): (Vec<String>, _, _) = match path.first().map(String::as_str) {
            Some("crate") => (Vec::new(), 1, true),
            Some("super") => {
                let base = &module[..module.len().saturating_sub(up)];
                (base.iter().map(|segment| (*segment).to_owned()).collect(), up, true)
            }
            Some("self") => (module.iter().map(|segment| (*segment).to_owned()).collect(), 1, true),
            _ => (Vec::new(), 0, false),
        };
        whole.extend(path.into_iter().skip(skip));
        Named { path: whole, name, is_ours, is_passed_on }
    }
}

/// Adds the leaves of the path or group that begins at a token; returns the index after it.
fn leaves_of(tokens: &[String], at: usize, prefix: &[String], leaves: &mut Vec<Leaf>) -> usize {
    let token = |at: usize| tokens.get(at).map_or("", String::as_str);
    let (mut at, mut path) = (at, prefix.to_vec());
    loop {
        match token(at) {
            "{" => {
                at += 1;
                while at < tokens.len() && token(at) != "}" {
                    let before = at;
                    at = leaves_of(tokens, at, &path, leaves);
                    if token(at) == "," || at == before {
                        at += 1;
                    }
                }
                return at + 1;
            }
            word if word == "*" || is_word(word) => {
                path.push(word.to_owned());
                at += 1;
            }
            // A turbofish or the end of a generic argument.
            _ => break,
        }
        if token(at) != "::" {
            break;
        }
        at += 1;
    }
    let mut name = path.last().cloned().unwrap_or_default();
    if token(at) == "as" {
        name = token(at + 1).to_owned();
        at += 2;
    }
    if path.len() > prefix.len() {
        leaves.push(Leaf { path, name });
    }
    at
}

fn is_word(token: &str) -> bool {
    token.starts_with(|first: char| first.is_alphabetic() || first == '_')
}

fn is_room(word: &str) -> bool {
    word.starts_with(|first: char| first.is_ascii_lowercase())
}

/// Splits text into words, `::` and single characters, without comments, strings and character literals.
pub(crate) fn tokens(text: &str) -> Vec<String> {
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
        let rooms: BTreeSet<String> = rooms_used(&file).into_iter().map(|(room, _)| room).collect();
        rooms.into_iter().collect()
    }

    #[test]
    fn paths_in_groups_in_code_and_by_super_are_found() {
        assert_eq!(used("a/b.rs", "use crate::{geo::{LatLon, x}, sim, plan::Plan};"), ["geo", "plan", "sim"]);
        assert_eq!(used("a.rs", "fn f() -> crate::geo::LatLon { super::link::open() }"), ["geo", "link"]);
        assert_eq!(used("a/b.rs", "use super::x; use super::super::link::Y;"), ["a", "link"]);
        assert_eq!(used("a.rs", "mod tests { use super::*; use super::super::link; }"), ["a", "link"]);
        assert_eq!(used("a/b.rs", "pub(crate) fn f() {} pub(super) struct S;"), [""; 0]);
        assert_eq!(used("a.rs", "let x = crate::sim::f::<crate::plan::P>();"), ["plan", "sim"]);
    }

    #[test]
    fn comments_strings_and_characters_are_passed_over() {
        let text = "// crate::a\n/* crate::b */ let s = \"crate::c \\\" crate::d\"; let r = r#\"crate::e\"#; \
                    let q = '\"'; let l: &'static str = crate::geo::NAME; let e = '\\''; crate::sim::f();";
        assert_eq!(used("x.rs", text), ["geo", "sim"]);
    }
}
