//! Campaigns in the executable: the answer, the file of a run after kills and full disks, shards and their merge.
#![allow(clippy::disallowed_methods, reason = "a program is watched until it has written a line")]

use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use serde_json::Value;

use crate::support::Sandbox;

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

/// The time after which a program counts as hung.
const NEVER: Duration = Duration::from_secs(300);

/// A process that is killed when its test ends.
struct Guard(Child);

impl Drop for Guard {
    fn drop(&mut self) {
        drop(self.0.kill());
        drop(self.0.wait());
    }
}

fn sandbox() -> Sandbox {
    let sandbox = Sandbox::new();
    sandbox.write("standing.toml", STANDING);
    sandbox
}

fn spawn(mut command: Command) -> Guard {
    command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
    Guard(command.spawn().expect("it starts"))
}

/// Returns the number of whole lines of a file.
fn lines(sandbox: &Sandbox, name: &str) -> usize {
    std::fs::read(sandbox.path(name)).unwrap_or_default().iter().filter(|byte| **byte == b'\n').count()
}

/// Waits until a file has more than so many lines, or the program is over.
fn wait_for_lines(child: &mut Guard, sandbox: &Sandbox, name: &str, count: usize) {
    let started = Instant::now();
    while lines(sandbox, name) <= count && child.0.try_wait().expect("a state").is_none() {
        assert!(started.elapsed() < NEVER, "{name} does not grow");
        std::thread::sleep(Duration::from_millis(2));
    }
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
fn a_run_that_is_killed_twenty_times_ends_with_the_same_bytes() {
    let sandbox = sandbox();
    let arguments = |out| ["campaign", "standing.toml", "--flights", "25", "--jobs", "2", "--out", out];
    sandbox.run(&arguments("whole.jsonl")).exits(1);
    let mut kills = 0;
    for killed in 1..=20 {
        let mut child = spawn(sandbox.command(&arguments("killed.jsonl")));
        wait_for_lines(&mut child, &sandbox, "killed.jsonl", killed);
        kills += u32::from(child.0.try_wait().expect("a state").is_none());
        drop(child);
    }
    assert!(kills > 10, "{kills}");
    let before = lines(&sandbox, "killed.jsonl") - 1;
    let ran = sandbox.run(&arguments("killed.jsonl")).exits(1);
    assert!(ran.err.contains(&format!("{before} were flown before")), "{}", ran.err);
    assert_eq!(sandbox.read("killed.jsonl"), sandbox.read("whole.jsonl"));
}

#[test]
fn a_file_that_ends_anywhere_is_finished_to_the_same_bytes_and_answer() {
    let sandbox = sandbox();
    let arguments = ["campaign", "standing.toml", "--flights", "6", "--out", "run.jsonl", "--csv", "run.csv"];
    let whole = sandbox.run(&arguments).exits(1);
    let (bytes, table) = (std::fs::read(sandbox.path("run.jsonl")).expect("a file"), sandbox.read("run.csv"));
    let head = bytes.iter().position(|byte| *byte == b'\n').expect("a header");
    let line = bytes[head + 1..].iter().position(|byte| *byte == b'\n').expect("a line");
    for cut in [0, 1, head, head + 1, head + 2, head + 1 + line, head + 2 + line, bytes.len() - 1] {
        std::fs::write(sandbox.path("run.jsonl"), &bytes[..cut]).expect("written");
        let ran = sandbox.run(&arguments).exits(1);
        assert_eq!(std::fs::read(sandbox.path("run.jsonl")).expect("a file"), bytes, "cut at {cut}");
        assert_eq!(
            (ran.out.as_str(), sandbox.read("run.csv")),
            (whole.out.as_str(), table.clone()),
            "cut at {cut}"
        );
    }
    // The file says everything itself.
    std::fs::write(sandbox.path("run.jsonl"), &bytes[..head + 5 + line]).expect("written");
    std::fs::remove_file(sandbox.path("standing.toml")).expect("removed");
    let ran = sandbox.run(&["campaign", "run.jsonl"]).exits(1);
    assert_eq!(ran.out, whole.out);
    assert_eq!(std::fs::read(sandbox.path("run.jsonl")).expect("a file"), bytes);
}

#[test]
fn files_of_something_else_stay_as_they_are() {
    let sandbox = sandbox();
    sandbox.write("notes.txt", "mine\n");
    sandbox.run(&["campaign", "standing.toml", "--flights", "2", "--out", "run.jsonl"]).exits(0);
    let kept = sandbox.read("run.jsonl");
    for (arguments, problem) in [
        (
            ["--flights", "2", "--out", "notes.txt"],
            "notes.txt is not the file of a campaign: name another file",
        ),
        (["--flights", "3", "--out", "run.jsonl"], "run.jsonl has another campaign: its options were others"),
        (
            ["--flights", "2", "--out", "standing.toml"],
            "--out standing.toml would overwrite a file of the campaign",
        ),
        (["--flights", "2", "--out", "/dev/null"], "--out /dev/null is not a file"),
    ] {
        let ran = sandbox.run(&[&["campaign", "standing.toml"][..], &arguments].concat()).exits(2);
        assert!(ran.err.contains(problem), "{problem}\n{}", ran.err);
    }
    assert_eq!((sandbox.read("run.jsonl"), sandbox.read("notes.txt")), (kept.clone(), "mine\n".to_owned()));
    sandbox.write("standing.toml", &STANDING.replace("9 m/s", "8 m/s"));
    let ran = sandbox.run(&["campaign", "standing.toml", "--flights", "2", "--out", "run.jsonl"]).exits(2);
    assert!(ran.err.contains("its scenario, plan or options were others"), "{}", ran.err);
    let damaged = kept.replacen("\"flight\":2", "\"flight\":3", 1);
    sandbox.write("run.jsonl", &damaged);
    let ran = sandbox.run(&["campaign", "run.jsonl"]).exits(2);
    assert!(ran.err.contains("run.jsonl:3: flight 3 is here in place of flight 2"), "{}", ran.err);
}

#[test]
fn a_full_disk_is_a_sentence_and_leaves_whole_lines() {
    let sandbox = sandbox();
    let arguments = "campaign standing.toml --flights 20 --jobs 1 --out run.jsonl";
    // The limit is in blocks of 512 bytes. Without the signal a write beyond it fails as on a full disk.
    let script = format!("trap '' XFSZ; ulimit -f 12; exec {} {arguments}", crate::support::PROGRAM);
    let mut command = Command::new("sh");
    command.args(["-c", &script]).env_clear().envs(sandbox.environment()).current_dir(sandbox.path("."));
    let output = command.output().expect("it runs");
    let err = String::from_utf8(output.stderr).expect("text");
    assert_eq!(output.status.code(), Some(3), "{err}");
    assert!(
        err.contains("cannot write run.jsonl: ") && err.contains("lines before are whole: make room"),
        "{err}"
    );
    let out = String::from_utf8(output.stdout).expect("text");
    assert!(out.contains("were not flown: ") || out.contains("were not flown"), "the answer so far: {out}");
    assert!(sandbox.read("run.jsonl").ends_with("}\n"), "whole lines");
    let before = lines(&sandbox, "run.jsonl");
    assert!((2..20).contains(&before), "{before}");
    let words: Vec<&str> = arguments.split(' ').collect();
    sandbox.run(&words).exits(1);
    sandbox.run(&["campaign", "standing.toml", "--flights", "20", "--out", "other.jsonl"]).exits(1);
    assert_eq!(sandbox.read("run.jsonl"), sandbox.read("other.jsonl"));
}

#[test]
fn ctrl_c_prints_the_answer_so_far() {
    let sandbox = sandbox();
    let mut child =
        spawn(sandbox.command(&["campaign", "standing.toml", "--flights", "100000", "--out", "run.jsonl"]));
    wait_for_lines(&mut child, &sandbox, "run.jsonl", 3);
    let id = child.0.id().to_string();
    assert!(Command::new("kill").args(["-s", "INT", &id]).status().expect("kill").success());
    let output = {
        use std::io::Read as _;
        let mut out = String::new();
        child.0.stdout.take().expect("a pipe").read_to_string(&mut out).expect("text");
        out
    };
    assert_eq!(child.0.wait().expect("an end").code(), Some(130));
    assert!(output.contains("of 100000 were not flown."), "{output}");
    assert!(sandbox.read("run.jsonl").ends_with("}\n"));
}

#[test]
fn seven_shards_make_the_file_of_one_process() {
    let sandbox = sandbox();
    let arguments = ["campaign", "standing.toml", "--flights", "23"];
    let whole = sandbox.run(&[&arguments[..], &["--out", "whole.jsonl"]].concat()).exits(1);
    let mut parts = Vec::new();
    for number in 1..=7 {
        let (shard, part) = (format!("{number}/7"), format!("part-{number}.jsonl"));
        let ran = sandbox.run(&[&arguments[..], &["--shard", &shard, "--out", &part]].concat()).exits(0);
        assert!(ran.out.contains(&format!(", shard {shard}: ")), "{}", ran.out);
        parts.push(part);
    }
    parts.reverse();
    let merge = |parts: &[String]| {
        let mut arguments = vec!["campaign", "merge"];
        arguments.extend(parts.iter().map(String::as_str));
        arguments.extend(["--out", "merged.jsonl", "--report", "merged.html"]);
        sandbox.run(&arguments)
    };
    let merged = merge(&parts).exits(1);
    assert_eq!(sandbox.read("merged.jsonl"), sandbox.read("whole.jsonl"));
    assert_eq!(merged.out, whole.out.replace("whole.jsonl", "merged.jsonl"));
    let page = sandbox.read("merged.html");
    assert!(page.contains("<code>betadeck open merged.jsonl:"), "{page}");
    assert!(page.contains("<code>betadeck campaign merge part-7.jsonl part-6.jsonl"), "{page}");
    std::fs::remove_file(sandbox.path("merged.jsonl")).expect("removed");

    // Lost, doubled, unfinished and foreign parts are found.
    let lost = merge(&parts[1..6]).exits(2);
    assert!(
        lost.err.contains("the shards 1/7, 7/7 are missing: fly them with the same command and --shard 1/7"),
        "{}",
        lost.err
    );
    let doubled = merge(&[&parts[..], &["part-3.jsonl".to_owned()]].concat()).exits(2);
    assert!(
        doubled.err.contains("shard 3/7 is there twice: part-3.jsonl and part-3.jsonl"),
        "{}",
        doubled.err
    );
    sandbox
        .run(&["campaign", "standing.toml", "--flights", "22", "--shard", "2/7", "--out", "foreign.jsonl"])
        .exits(0);
    let foreign =
        merge(&[&parts[..5], &["foreign.jsonl".to_owned(), "part-1.jsonl".to_owned()]].concat()).exits(2);
    assert!(
        foreign.err.contains(
            "foreign.jsonl does not belong to the campaign of part-7.jsonl: its options were others"
        ),
        "{}",
        foreign.err
    );
    let text = sandbox.read("part-4.jsonl");
    let short = text.trim_end().rsplit_once('\n').expect("lines").0;
    sandbox.write("part-4.jsonl", &format!("{short}\n{{\"ev"));
    let unfinished = merge(&parts).exits(2);
    assert!(
        unfinished.err.contains("part-4.jsonl (shard 4/7) ends after 3 of 4 flights: finish it with betadeck campaign part-4.jsonl"),
        "{}",
        unfinished.err
    );
    assert!(!sandbox.path("merged.jsonl").exists());
    sandbox.run(&["campaign", "part-4.jsonl"]).exits(0);
    assert_eq!(sandbox.read("part-4.jsonl"), text);
}

#[test]
fn array_jobs_name_their_shard_in_the_environment() {
    let sandbox = sandbox();
    let run = |shard: &str, variables: &[(&str, &str)]| {
        let mut command = sandbox.command(&[
            "campaign",
            "standing.toml",
            "--flights",
            "4",
            "--shard",
            shard,
            "--out",
            "part.jsonl",
        ]);
        let output = command.envs(variables.iter().copied()).output().expect("it runs");
        (output.status.code(), String::from_utf8(output.stderr).expect("text"))
    };
    let slurm = [
        ("SLURM_ARRAY_TASK_ID", "12"),
        ("SLURM_ARRAY_TASK_MIN", "11"),
        ("SLURM_ARRAY_TASK_MAX", "12"),
        ("SLURM_ARRAY_TASK_COUNT", "2"),
    ];
    assert_eq!(run("slurm", &slurm).0, Some(0));
    let numbers = |sandbox: &Sandbox| -> Vec<u64> {
        sandbox
            .read("part.jsonl")
            .lines()
            .skip(1)
            .map(|line| json(line)["flight"].as_u64().unwrap())
            .collect()
    };
    assert_eq!(numbers(&sandbox), [3, 4]);
    // The same shard by another name.
    assert_eq!(run("2/2", &[]).0, Some(0));
    std::fs::remove_file(sandbox.path("part.jsonl")).expect("removed");
    assert_eq!(run("k8s/4", &[("JOB_COMPLETION_INDEX", "0")]).0, Some(0));
    assert_eq!(numbers(&sandbox), [1]);
    let (code, err) = run("slurm", &[]);
    assert_eq!(code, Some(2));
    assert!(err.contains("SLURM_ARRAY_TASK_ID is not set"), "{err}");
    let (code, err) = run("k8s/4", &[("JOB_COMPLETION_INDEX", "1")]);
    assert_eq!(code, Some(2));
    assert!(err.contains("part.jsonl has shard 1/4 of this campaign"), "{err}");
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
    let mut terminal = crate::pty::Terminal::betadeck(160, 40, &["open", &flight]);
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
