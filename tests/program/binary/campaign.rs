//! Campaigns in the executable: the answer, its files and goals, comparisons, and campaigns of a plan.

mod interrupted;
mod shards;

use serde_json::Value;

use crate::binary::support::Sandbox;

/// A scenario whose craft stands on the ground for a second, in random winds. It fails in strong ones.
const STANDING: &str = "format = 1
name = \"standing\"
ends = \"1 s after boot\"
sample_hz = 20
[plan]
builtin = \"square\"
[craft]
pilot = \"none\"
[air]
world = [\"wind_profile=flat\"]
[[measure]]
name = \"blow\"
from = \"boot\"
max = \"wind\"
[[expect]]
from = \"boot\"
always = \"wind <= 9 m/s\"
[vary]
mass_pct = \"+- 3\"
gust_mps = [0, 1, 2]
wind = \"0..12@0..360\"
[vary.settings]
ap_max_angle = \"20..40\"
";

fn sandbox() -> Sandbox {
    let sandbox = Sandbox::new();
    sandbox.write("standing.toml", STANDING);
    sandbox
}

/// Returns the number of whole lines of a file.
fn lines(sandbox: &Sandbox, name: &str) -> usize {
    std::fs::read(sandbox.path(name)).unwrap_or_default().iter().filter(|byte| **byte == b'\n').count()
}

fn json(text: &str) -> Value {
    serde_json::from_str(text).unwrap_or_else(|error| panic!("{error}: {text}"))
}

#[test]
fn a_campaign_says_how_sure_how_far_and_why() {
    let sandbox = sandbox();
    let ran = sandbox.run(&["campaign", "standing.toml", "--flights", "60", "--out", "run.jsonl"]).exits(1);
    let first = ran.out.lines().next().expect("a sentence");
    assert!(first.starts_with("standing, 60 flights, monte-carlo: "), "{first}");
    assert!(first.contains(" succeeded (") && first.ends_with(" with 95 % confidence)."), "{first}");
    // The planted cause comes first, and its threshold is that of the expectation.
    let causes = ran.out.split_once("What explains the ").expect("causes").1;
    let cause = causes.lines().nth(1).expect("a cause");
    assert!(cause.starts_with("  1. wind_mps above "), "{causes}");
    let threshold: f64 = cause["  1. wind_mps above ".len()..].split(':').next().unwrap().parse().unwrap();
    assert!((8.5..9.5).contains(&threshold), "{cause}");
    assert!(ran.out.contains("\nThe worst flights:\n"), "{}", ran.out);
    let open =
        ran.out.lines().find(|line| line.trim().starts_with("betadeck open run.jsonl:")).expect("a command");
    assert!(open.contains(" --at boot+"), "{open}");
    assert!(ran.out.contains("\nblow "), "measures have a distribution, too: {}", ran.out);
    assert!(ran.err.contains("60 flights, 60 s, in "), "{}", ran.err);
    let file = sandbox.read("run.jsonl");
    let header = json(file.lines().next().expect("a header"));
    assert_eq!((header["event"].as_str(), header["flights"].as_u64()), (Some("campaign"), Some(60)));
    for (number, line) in (1..).zip(file.lines().skip(1)) {
        let line = json(line);
        assert_eq!(line["flight"], number);
        assert_eq!(line["seed"], number);
        for key in ["version", "inputs", "outcome", "metrics", "hash"] {
            assert!(!line[key].is_null(), "{key} in {line}");
        }
        assert!(!line.to_string().contains("wall"), "{line}");
    }
    assert_eq!(lines(&sandbox, "run.jsonl"), 61);
}

#[test]
fn the_answer_goes_to_files_and_goals_decide_the_exit_code() {
    let sandbox = sandbox();
    let with = |goals: &str| format!("{STANDING}[campaign]\nflights = 30\nexpect = [{goals}]\n");
    sandbox.write("met.toml", &with("'success >= 40 %', 'max(blow) <= 20 m/s'"));
    sandbox.write("failed.toml", &with("'success >= 40 %', 'success >= 99 % with 95 % confidence'"));
    let outputs = [
        "--json",
        "a.json",
        "--junit",
        "a.xml",
        "--markdown",
        "a.md",
        "--csv",
        "a.csv",
        "--report",
        "a.html",
    ];
    let ran = sandbox.run(&[&["campaign", "met.toml"][..], &outputs].concat()).exits(0);
    assert!(ran.out.contains("\n✓ success >= 40 %: "), "{}", ran.out);
    assert!(ran.out.contains("(--out RUN.jsonl keeps the flights"), "{}", ran.out);
    let answer = json(&sandbox.read("a.json"));
    assert_eq!((answer["met"].as_bool(), answer["goals"][1]["outcome"].as_str()), (Some(true), Some("met")));
    assert_eq!(answer["causes"][0]["input"], "wind_mps");
    assert!(sandbox.read("a.xml").contains("<testcase classname=\"standing\" name=\"success &gt;= 40 %\"/>"));
    assert!(sandbox.read("a.md").starts_with("### ✅ standing, 30 flights, monte-carlo: "));
    let page = sandbox.read("a.html");
    assert!(page.contains("<!-- betadeck report -->") && page.contains("<h1>standing</h1>"));
    assert!(page.contains("Failures by wind_mps.") && page.contains("betadeck campaign met.toml</code>"));
    let table = sandbox.read("a.csv");
    let head = "flight,side,seed,outcome,result,margin,hash,ap_max_angle,gust_mps,mass_pct,wind_from_deg,wind_mps,cross_track";
    assert!(table.starts_with(head), "{}", table.lines().next().unwrap_or_default());
    assert_eq!(table.lines().count(), 31);
    let ran = sandbox.run(&[&["campaign", "failed.toml"][..], &outputs].concat()).exits(1);
    assert!(ran.out.contains("\n✗ success >= 99 % with 95 % confidence: "), "{}", ran.out);
    assert!(ran.out.contains("(the bound is "), "{}", ran.out);
    assert!(sandbox.read("a.xml").contains("failures=\"1\""));
    let ran = sandbox.run(&["campaign", "met.toml", "--json", "-"]).exits(0);
    assert_eq!(json(&ran.out)["flights"], 30);
}

#[test]
fn the_same_flights_with_another_setting_are_compared_in_pairs() {
    let sandbox = sandbox();
    let text = STANDING.replace("always = \"wind <= 9 m/s\"", "always = \"wind <= 9 m/s or state IDLE\"");
    sandbox.write("standing.toml", &text);
    let arguments =
        ["campaign", "standing.toml", "--flights", "12", "--vs", "ap_max_angle=30", "--out", "run.jsonl"];
    let ran = sandbox.run(&arguments).exits(0);
    assert!(
        ran.out.contains("B (ap_max_angle = 30) against A (as given), 12 pairs with the same inputs:"),
        "{}",
        ran.out
    );
    assert!(
        ran.out.contains(
            "0 flights succeeded only with A, 0 only with B: this may be chance (McNemar, p = 1.000)."
        ),
        "{}",
        ran.out
    );
    let file = sandbox.read("run.jsonl");
    let sides: Vec<String> = file
        .lines()
        .skip(1)
        .take(4)
        .map(json)
        .map(|line| format!("{}{}", line["flight"], line["side"].as_str().unwrap_or_default()))
        .collect();
    assert_eq!(sides, ["1a", "1b", "2a", "2b"]);
    // Cut between the sides of a pair.
    let cut: String = file.lines().take(4).map(|line| format!("{line}\n")).collect();
    sandbox.write("run.jsonl", &cut);
    let again = sandbox.run(&arguments).exits(0);
    assert_eq!((again.out, sandbox.read("run.jsonl")), (ran.out, file));
}

#[test]
fn a_plan_is_flown_as_fly_flies_it() {
    let sandbox = Sandbox::new();
    let options =
        ["--wind", "3@270", "--fault", "gps-loss@3,2", "--set", "ap_max_angle=30", "--takeoff", "5"];
    sandbox
        .run(&[&["campaign", "land", "--flights", "2", "--out", "run.jsonl"][..], &options].concat())
        .exits(0);
    let second = json(sandbox.read("run.jsonl").lines().nth(2).expect("a line"));
    let flown =
        sandbox.run(&[&["fly", "land", "--seed", "2", "--json", "-"][..], &options].concat()).exits(0);
    let end = json(flown.out.lines().last().expect("an end"));
    assert_eq!(second["hash"], end["hash"], "the same flight to the last bit");
    let time = second["metrics"]["time"].as_f64().expect("a time");
    assert!((time - end["flown_s"].as_f64().expect("a time")).abs() < 1e-3);
    let miss = end["waypoints"].as_array().expect("waypoints").last().expect("LAND")["miss_m"].as_f64();
    let touchdown = second["metrics"]["touchdown"].as_f64().expect("a touchdown");
    assert!((touchdown - miss.expect("a miss")).abs() < 1e-2, "{touchdown} {miss:?}");
    let ran = sandbox.run(&["campaign", "standing.toml", "--wind", "3@270"]);
    assert_eq!(ran.code, Some(3), "there is no such file: {}", ran.err);
    sandbox.write("standing.toml", STANDING);
    let ran = sandbox.run(&["campaign", "standing.toml", "--wind", "3@270"]).exits(2);
    assert!(ran.err.contains("--wind is for a plan, and standing.toml is a scenario"), "{}", ran.err);
}

#[test]
fn inputs_of_a_plan_are_varied_on_the_command_line() {
    let sandbox = Sandbox::new();
    let ran = sandbox.run(&[
        "campaign",
        "land",
        "--flights",
        "1",
        "--timeout",
        "2",
        "--out",
        "run.jsonl",
        "--vary",
        "wind=6+-2@250+-20",
        "--vary",
        "turbulence=none,light",
        "--vary",
        "settings.ap_max_angle=20..40",
        "--vary",
        "faults.gps-loss,6=5..40",
        "--expect",
        "share(timeout) >= 50 %",
    ]);
    let ran = ran.exits(0);
    assert!(ran.out.contains("✓ share(timeout) >= 50 %: 100 %"), "{}", ran.out);
    let line = json(sandbox.read("run.jsonl").lines().nth(1).expect("a line"));
    let names: Vec<&String> = line["inputs"].as_object().expect("inputs").keys().collect();
    assert_eq!(names, ["ap_max_angle", "gps-loss,6_at_s", "turbulence", "wind_from_deg", "wind_mps"]);
    let ran = sandbox.run(&["campaign", "land", "--vary", "wnd=6@250"]).exits(2);
    assert!(
        ran.err.contains("wnd is not a key of vary") && ran.err.contains("did you mean wind?"),
        "{}",
        ran.err
    );
}

#[cfg(unix)]
#[test]
fn a_flight_of_a_campaign_is_opened_on_the_screen_bit_by_bit() {
    let sandbox = sandbox();
    sandbox.run(&["campaign", "standing.toml", "--flights", "5", "--out", "run.jsonl"]).exits(1);
    let path = sandbox.path("run.jsonl");
    let flight = format!("{}:4", path.to_str().expect("a path"));
    let mut terminal = crate::binary::pty::Terminal::betadeck(160, 40, &["open", &flight]);
    terminal.until_shown("same to the last bit");
    terminal.send("q");
    terminal.until("the question or the end", |terminal| {
        !terminal.is_alternate() || terminal.screen().contains("uit")
    });
    terminal.signal("TERM");
    terminal.end();
    let ran = sandbox.run(&["open", "run.jsonl:4"]);
    assert_ne!(ran.code, Some(0), "a screen needs a terminal");
}

#[test]
fn twenty_times_the_same_flight_are_no_campaign() {
    let sandbox = Sandbox::new();
    let standing = "ends = \"1 s after boot\"\n[plan]\nbuiltin = \"square\"\n[craft]\npilot = \"none\"\n";
    sandbox.write("one.toml", &format!("format = 1\nseeds = 1\n{standing}"));
    let refused = sandbox.run(&["campaign", "one.toml", "--flights", "20", "--out", "t.jsonl"]).exits(2);
    assert!(
        refused.err.contains("nothing varies") && refused.err.contains("--seeds 1..20"),
        "{}",
        refused.err
    );
    assert!(!sandbox.path("t.jsonl").exists());
    sandbox.run(&["campaign", "one.toml", "--flights", "3", "--seeds", "1..3"]).exits(0);
    sandbox.write("all.toml", &format!("format = 1\nseeds = \"1..\"\n{standing}"));
    sandbox.run(&["check", "all.toml"]).exits(0);
    sandbox.run(&["campaign", "all.toml", "--flights", "3", "--out", "all.jsonl"]).exits(0);
    let text = sandbox.read("all.jsonl");
    for (seed, line) in (1..).zip(text.lines().skip(1)) {
        assert_eq!(json(line)["seed"], seed);
    }
    // The file of a run has the bounds of the option.
    let more = text.replacen("\"flights\":3", "\"flights\":18446744073709551615", 2);
    sandbox.write("more.jsonl", &more);
    let refused = sandbox.run(&["campaign", "more.jsonl"]).exits(2);
    assert!(refused.err.contains("allowed: 1 to 10000000"), "{}", refused.err);
    sandbox.write("more.jsonl", &text.replacen("\"flights\":3", "\"flights\":30", 1));
    let refused = sandbox.run(&["campaign", "more.jsonl"]).exits(2);
    assert!(refused.err.contains("it says 30 flights, and its campaign has 3"), "{}", refused.err);
}
