//! `forecast` in the executable: go or no-go.

use serde_json::Value;

use crate::binary::support::Sandbox;

#[test]
fn a_forecast_is_go_in_a_calm_and_no_go_in_a_storm() {
    let sandbox = Sandbox::new();
    let forecast = |more: &[&str]| sandbox.run(&[&["forecast", "land", "--flights", "4"], more].concat());
    let calm = forecast(&["--wind", "1±0.5@250±20", "--battery", "92%"]).exits(0);
    assert!(calm.out.starts_with("GO land: 100 % complete with more than 20 % "), "{}", calm.out);
    let storm =
        forecast(&["--wind", "26+-1@250+-20", "--json", "answer.json", "--report", "f.html"]).exits(1);
    assert!(storm.out.starts_with("NO-GO land: ") && storm.out.contains("; to change: "), "{}", storm.out);
    let answer: Value = serde_json::from_str(&sandbox.read("answer.json")).expect("JSON");
    assert_eq!((answer["go"].as_bool(), answer["flights"].as_u64()), (Some(false), Some(4)));
    let page = sandbox.read("f.html");
    assert!(page.contains("✗ no-go") && page.contains("to change: "), "{page}");
    assert!(page.contains("betadeck forecast land --flights 4 --wind 26+-1@250+-20</code>"), "{page}");
    let none = forecast(&["--battery", "empty"]).exits(2);
    assert!(none.err.contains("92% or 90+-5%"), "{}", none.err);
}
