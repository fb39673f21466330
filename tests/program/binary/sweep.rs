//! `campaign --sweep` in the executable: the fault at every second of a flight.

use crate::binary::support::Sandbox;

#[test]
fn a_sweep_shows_each_second_at_which_a_fault_is_fatal() {
    let sandbox = Sandbox::new();
    let arguments = ["campaign", "land", "--takeoff", "2", "--sweep", "motor,,1:0", "--csv", "s.csv"];
    let arguments = [&arguments[..], &["--report", "s.html"]].concat();
    let ran = sandbox.run(&arguments).exits(1);
    let first = ran.out.lines().next().expect("a sentence");
    assert!(first.starts_with("land, motor,,1:0 at every second of the flight ("), "{first}");
    assert!(!first.contains(" 0 lost"), "{first}");
    assert!(ran.out.contains("Without the fault the flight ends complete: "), "{}", ran.out);
    let table = sandbox.read("s.csv");
    let rows: Vec<&str> = table.lines().skip(1).collect();
    assert!(first.contains(&format!("({} flights)", rows.len())), "{first}: {} rows", rows.len());
    for (second, row) in rows.iter().enumerate() {
        assert!(row.starts_with(&format!("{second},")), "{row}");
    }
    let page = sandbox.read("s.html");
    for part in ["✗ may be lost", "betadeck campaign land --takeoff 2 --sweep motor,,1:0</code>", "lost ("]
    {
        assert!(page.contains(part), "{part} is not in the page");
    }
    // The command of the worst second leads to a flight that ends so.
    let worst =
        ran.out.lines().find_map(|line| line.split_once(" and --fault ")).expect("the worst second").1;
    let flown = sandbox.run(&["fly", "land", "--takeoff", "2", "--fault", worst]).exits(1);
    assert!(flown.out.contains("Crashed: "), "{}", flown.out);
    assert!(page.contains(&format!("<code>betadeck fly land --takeoff 2 --fault {worst}</code>")), "{worst}");
}

#[test]
fn a_sweep_takes_a_plan_and_no_other_program() {
    let sandbox = Sandbox::new();
    sandbox.write("flown.toml", "format = 1\n[plan]\nbuiltin = \"land\"\n");
    for (arguments, sentence) in [
        (&["campaign", "flown.toml", "--sweep", "gps-loss"][..], "flown.toml is none: name the plan"),
        (&["campaign", "land", "--sweep", "gps-loss@3"], "leave the time out"),
        (&["campaign", "land", "--sweep", "gps-loss", "--vary", "mass_pct=1"], "cannot be used with"),
        (&["campaign", "land", "--sweep", "stall,1"], "stall"),
    ] {
        let ran = sandbox.run(arguments).exits(2);
        assert!(ran.err.contains(sentence), "{arguments:?}: {}", ran.err);
    }
}
