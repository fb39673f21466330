//! The functions whose bits depend on the machine: the core calls those of `math` instead.

use crate::rooms::paths::tokens;
use crate::rooms::rules::is_pure;
use crate::rooms::source::{SourceFile, files};

/// The functions of `f64` that the C library computes, or whose precision is not specified.
const BY_MACHINE: [&str; 25] = [
    "acos", "acosh", "asin", "asinh", "atan", "atan2", "atanh", "cbrt", "cos", "cosh", "exp", "exp2",
    "exp_m1", "hypot", "ln", "ln_1p", "log10", "log2", "powf", "powi", "sin", "sin_cos", "sinh", "tan",
    "tanh",
];

/// Exact everywhere, but slow on machines without an instruction for it.
const SLOW: &str = "mul_add";

/// Returns the calls of such functions as methods or as functions of `f64`.
fn calls(file: &SourceFile) -> Vec<String> {
    let tokens = tokens(&file.product().text);
    let token = |index: usize| tokens.get(index).map_or("", String::as_str);
    let is_call = |at: &usize| {
        let is_method = token(at - 1) == "." && token(at + 1) == "(";
        let is_function = token(at - 1) == "::" && *at > 1 && token(at - 2) == "f64";
        (is_method || is_function) && (BY_MACHINE.contains(&token(*at)) || token(*at) == SLOW)
    };
    (1..tokens.len()).filter(is_call).map(|at| format!("{}: {}", file.name, token(at))).collect()
}

#[test]
fn the_core_calls_no_function_whose_bits_depend_on_the_machine() {
    // What `mavlink` computes is sent or shown, and no part of a flight.
    let is_free = |file: &SourceFile| ["math", "mavlink"].contains(&file.room().as_str());
    let core = files().into_iter().filter(|file| is_pure(file) && !is_free(file));
    let found: Vec<String> = core.flat_map(|file| calls(&file)).collect();
    assert!(found.is_empty(), "use crate::math: {found:#?}");
}

#[test]
fn every_such_call_is_found() {
    let file = |text: &str| SourceFile { name: "sim/x.rs".to_owned(), text: text.to_owned() };
    for text in ["x.sin()", "x\n    .powi(2)", "f64::atan2(y, x)", "list.map(f64::cos)", "a.mul_add(b, c)"] {
        assert_eq!(calls(&file(text)).len(), 1, "{text}");
    }
    for text in ["let sin = 1.0;", "x.sqrt()", "x.sine()", "math::sin(x)", "self.log.lines()"] {
        assert_eq!(calls(&file(text)), [""; 0], "{text}");
    }
}
