//! The first page of the core: nothing that a reader sees leads to an item that is hidden.

use std::collections::BTreeSet;

use crate::rooms::paths::{named, tokens};
use crate::rooms::source::{SourceFile, files};

/// The attribute of a hidden item, as tokens.
const HIDDEN: [&str; 7] = ["#", "[", "doc", "(", "hidden", ")", "]"];

/// A public item: its name, the names in its signature, and whether it is hidden.
#[derive(Debug)]
struct Item {
    name: String,
    signature: Vec<String>,
    is_hidden: bool,
    /// The header of the block around it: of a struct, a trait or an `impl`.
    owner: Vec<String>,
}

/// Returns the public items, methods and fields of a file. An enum has its variants in its signature. Fields of types that
/// are hidden or not public are left out.
fn items(file: &SourceFile) -> Vec<Item> {
    let tokens = tokens(&file.product().text);
    let is_public = |at: usize| tokens[at] == "pub" && tokens.get(at + 1).is_some_and(|next| next != "(");
    let mut found = Vec::new();
    let mut blocks: Vec<usize> = Vec::new();
    for at in 0..tokens.len() {
        match tokens[at].as_str() {
            "{" => blocks.push(at),
            "}" => _ = blocks.pop(),
            _ if is_public(at) => {
                let begin = blocks.last().map_or(0, |&block| header(&tokens, block));
                let owner = &tokens[begin..blocks.last().map_or(0, |&block| block)];
                let is_type = owner.iter().any(|word| ["struct", "trait"].contains(&word.as_str()));
                if !is_type || is_public(begin) && !is_hidden(&tokens[..begin]) {
                    found.push(item(&tokens, at, owner));
                }
            }
            _ => {}
        }
    }
    found
}

/// Returns the index at which the header of a block begins.
fn header(tokens: &[String], block: usize) -> usize {
    tokens[..block]
        .iter()
        .rposition(|token| [";", "{", "}", "]"].contains(&token.as_str()))
        .map_or(0, |at| at + 1)
}

/// Returns the item whose `pub` is at this index.
fn item(tokens: &[String], at: usize, owner: &[String]) -> Item {
    let kind = at + 1 + usize::from(tokens[at + 1] == "const" && tokens[at + 2] == "fn");
    let is_item =
        ["const", "enum", "fn", "mod", "static", "struct", "trait", "type"].contains(&tokens[kind].as_str());
    let end = if tokens[kind] == "use" { kind } else { end_of_signature(tokens, kind) };
    Item {
        name: tokens[kind + usize::from(is_item)].clone(),
        signature: tokens[kind..end].to_vec(),
        is_hidden: is_hidden(&tokens[..at]),
        owner: owner.to_vec(),
    }
}

/// Returns the index after the signature that begins at a token: before the body of a function, the fields of a struct, the
/// value of a constant, or the next field; after the variants of an enum.
fn end_of_signature(tokens: &[String], begin: usize) -> usize {
    let mut depth = 0;
    for (at, token) in tokens.iter().enumerate().skip(begin) {
        match token.as_str() {
            "{" if tokens[begin] != "enum" && depth == 0 => return at,
            "(" if tokens[begin] == "struct" && depth == 0 => return at,
            "=" if tokens[begin] == "type" => {}
            "," | ";" | ")" | "}" | "=" if depth == 0 => return at,
            "(" | "[" | "<" | "{" => depth += 1,
            ">" if tokens[at - 1] == "-" => {}
            ")" | "]" | ">" | "}" => {
                depth -= 1;
                if token == "}" && depth == 0 {
                    return at;
                }
            }
            _ => {}
        }
    }
    tokens.len()
}

/// Returns `true` if one of the attributes at the end of these tokens hides what follows.
fn is_hidden(mut before: &[String]) -> bool {
    while before.last().is_some_and(|token| token == "]") {
        if before.ends_with(&HIDDEN.map(str::to_owned)) {
            return true;
        }
        let Some(at) = before.iter().rposition(|token| token == "#") else { return false };
        before = &before[..at];
    }
    false
}

/// Returns the paths of the hidden modules and items of these files, from the root of the crate.
fn hidden(files: &[SourceFile]) -> BTreeSet<Vec<String>> {
    let of_file = |file: &SourceFile| -> Vec<Vec<String>> {
        let hidden = items(file).into_iter().filter(|item| item.is_hidden);
        hidden.map(|item| [file.module(), vec![item.name]].concat()).collect()
    };
    files.iter().flat_map(of_file).collect()
}

/// Returns the items of these files that a reader sees and that lead to a hidden one.
fn leaks(files: &[SourceFile]) -> Vec<String> {
    let hidden = hidden(files);
    // A room passes its items on, so the last name of a path counts with the room.
    let is_hidden_path = |path: &[String]| {
        (1..=path.len()).any(|length| hidden.contains(&path[..length]))
            || hidden.iter().any(|item| {
                item.len() > 1
                    && item.first() == path.first()
                    && item.last() == path.last()
                    && path.last().is_some_and(|name| name.starts_with(char::is_uppercase))
            })
    };
    let mut found = Vec::new();
    for file in files.iter().filter(|file| !is_hidden_path(&file.module())) {
        // A path that does not begin at the crate may begin at a child of the module.
        let known = named(&file.product()).into_iter().map(|named| {
            let whole = if named.is_ours { named.path } else { [file.module(), named.path].concat() };
            (named.name, whole)
        });
        let known: Vec<_> = known.filter(|(_, path)| is_hidden_path(path)).collect();
        let is_of_hidden =
            |item: &Item| item.owner.iter().any(|word| is_hidden_path(&[file.room(), word.clone()]));
        for item in items(file).iter().filter(|item| !item.is_hidden && !is_of_hidden(item)) {
            let led_to = known.iter().filter(|(name, _)| item.signature.contains(name));
            found.extend(
                led_to.map(|(_, path)| format!("{}: {} leads to {}", file.name, item.name, path.join("::"))),
            );
        }
    }
    found
}

#[test]
fn nothing_that_a_reader_of_the_core_sees_leads_to_a_hidden_type() {
    let is_core = |file: &SourceFile| file.name == "core.rs" || file.is_of_the_core();
    let core: Vec<SourceFile> = files().into_iter().filter(is_core).collect();
    let hidden = hidden(&core);
    assert!(hidden.contains(&vec!["msp".to_owned()]) && hidden.len() > 20, "{hidden:?}");
    let found = leaks(&core);
    assert!(found.is_empty(), "{found:#?}");
}

#[test]
fn every_known_leak_is_found() {
    let file = |name: &str, text: &str| SourceFile { name: name.to_owned(), text: text.to_owned() };
    let leaks_of = |text: &str| {
        leaks(&[
            file("core.rs", "#[doc(hidden)]\npub mod msp;\npub mod sim;"),
            file("msp.rs", "pub struct Code;"),
            file("sim.rs", text),
            file("sim/part.rs", "#[derive(Debug)]\n#[doc(hidden)]\npub struct Part { pub a: u8 }"),
        ])
    };
    for text in [
        "use crate::msp::Code; pub fn f(code: &Code) {}",
        "use crate::msp::Code; impl A { pub const fn f(&self) -> Option<Code> { None } }",
        "use crate::msp::Code as C; pub struct A { pub codes: Vec<C>, b: u8 }",
        "use crate::msp::Code; pub struct A(pub Code);",
        "use crate::msp::Code; pub enum A { B { code: Code }, D }",
        "pub fn f() -> crate::msp::Code { todo() }",
        "use part::Part; use crate::sim::part; pub fn f(part: &part::Part) {}",
        "use crate::sim::Part; pub type Parts = Vec<Part>;",
    ] {
        assert_eq!(leaks_of(text).len(), 1, "{text}: {:?}", leaks_of(text));
    }
    for text in [
        "use crate::msp::Code; fn f(code: &Code) {} pub(crate) fn g(code: &Code) {}",
        "use crate::msp::Code; pub fn f() { let code = Code; }",
        "use crate::msp::Code; pub struct A { code: Code, pub b: u8 } pub struct B(Code);",
        "use crate::msp::Code; pub(super) struct A { pub code: Code }",
        "use crate::msp::Code; impl Part { pub fn f(&self) -> Code {} }",
        "use crate::msp::Code; #[doc(hidden)] #[must_use]\npub fn f(code: &Code) {}",
        "use crate::geo::Code; pub fn f(code: &Code) {}",
    ] {
        assert_eq!(leaks_of(text), [""; 0], "{text}");
    }
}
