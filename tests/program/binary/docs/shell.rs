//! The command lines of the pages for a shell.
#![allow(clippy::disallowed_methods, reason = "a deadline for a program that hangs needs the clock")]

use std::ffi::OsString;
use std::os::unix::fs::PermissionsExt as _;
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use betadeck::args::{self, Layers};
use clap::error::ErrorKind;

use super::extract::{Shown, commands, is_screen, pages};
use super::filled_in;
use super::order::{examples, files};
use crate::binary::pty::Terminal;
use crate::binary::support::{PROGRAM, Sandbox};
use test_support::free_port;

/// Programs of other people, which are not run here.
const OTHERS: [(&str, &str); 7] = [
    ("cargo", "builds and tests this program"),
    ("cat", "passes a report to the CI service"),
    ("kubectl", "starts a job on a cluster"),
    ("pip", "installs packages of Python"),
    ("python3", "checks against SciPy"),
    ("sbatch", "starts an array job on a cluster"),
    ("kubernetes-validate", "checks a file against the schema of Kubernetes"),
];

/// A campaign whose craft stays on the ground for a second, in random winds.
const CAMPAIGN: &str = "format = 1
ends = \"1 s after boot\"
[plan]
builtin = \"square\"
[craft]
pilot = \"none\"
[vary]
wind = \"6+-2@250+-20\"
";

/// Executables of a firmware that the pages name.
const FIRMWARES: [&str; 4] = ["remote.elf", "new.elf", "old.elf", "obj/main/betaflight_SITL.elf"];

/// Commands in sentences that end with another exit code than 0; the sentence says so.
const EXIT_CODES: [(&str, u32); 1] = [("betadeck fly square --wind 5@270 --rx-loss-at 20", 1)];

/// The time after which a command counts as hung.
const NEVER: Duration = Duration::from_secs(600);

/// The way in which a command ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    /// By itself, with its exit code.
    ByItself,
    /// By Ctrl-C, after it has started.
    Runs,
    /// By Ctrl-C, after its firmware was started and has got states and a client.
    RunsFirmware,
    /// By `q`, after the screen was drawn.
    Screen,
    /// As before, after its firmware has got states and a client.
    ScreenWithFirmware,
}

impl Kind {
    fn of(words: &[String]) -> Self {
        let has = |name: &str| words.iter().any(|word| word == name);
        let is_remote = has("--firmware") || has("--betaloop");
        match words.get(1).map(String::as_str) {
            _ if has("--help") || has("--version") => Self::ByItself,
            Some("replay") if has("--plain") => Self::Runs,
            Some("replay") if ["--csv", "--gpx", "--kml", "--report"].into_iter().any(has) => Self::ByItself,
            Some("serve" | "fly" | "check" | "compare") if is_remote => Self::RunsFirmware,
            Some("serve" | "sitl" | "--plain") => Self::Runs,
            Some(
                "fly" | "plan" | "convert" | "completions" | "man" | "check" | "campaign" | "forecast"
                | "config" | "compare" | "lab" | "doctor" | "examples" | "flights",
            ) => Self::ByItself,
            _ if is_remote => Self::ScreenWithFirmware,
            _ => Self::Screen,
        }
    }
}

/// Returns the words of a line; single quotes keep words together.
pub(super) fn words(line: &str) -> Vec<String> {
    let mut words = Vec::new();
    for (part, text) in line.split('\'').enumerate() {
        if part % 2 == 1 {
            words.push(text.to_owned());
        } else {
            words.extend(text.split_whitespace().map(str::to_owned));
        }
    }
    words
}

/// Returns the words of a line up to a redirection.
fn arguments(line: &str) -> Vec<String> {
    let mut words = words(line);
    let end = words.iter().position(|word| ["<", ">", ">>", "|"].contains(&word.as_str()));
    words.truncate(end.unwrap_or(words.len()));
    words
}

/// Free ports for a firmware, TCP and the four of UDP.
fn free_ports() -> (String, String) {
    (free_port().to_string(), [(); 4].map(|()| free_port().to_string()).join(","))
}

/// A home directory with the files that the pages name, at free ports.
struct Desk {
    sandbox: Sandbox,
    /// Assignments for the shell.
    variables: String,
}

impl Desk {
    /// Writes the files. A firmware is the drop-in of this program at free ports; it writes its output to `said`.
    fn new(kind: Kind) -> Self {
        let needs_firmware = matches!(kind, Kind::RunsFirmware | Kind::ScreenWithFirmware);
        let sandbox = Sandbox::new();
        for folder in ["flight-tests", "obj/main", "betaloop"] {
            std::fs::create_dir_all(sandbox.path(folder)).expect("a writable directory");
        }
        for file in files(examples()).into_iter().filter(|file| !file.ends_with('/')) {
            std::fs::copy(examples().join(&file), sandbox.path(&file)).expect("a writable directory");
        }
        // The flights of the page's campaign take a minute each.
        sandbox.write("my-campaign.toml", CAMPAIGN);
        let (tcp, udp) = if needs_firmware { free_ports() } else { ("0".to_owned(), "0,0,0,0".to_owned()) };
        let script = format!(
            "#!/bin/sh\nexec {PROGRAM} sitl --udp-ports={udp} --tcp-port={tcp} --ws-port=0 >>{} 2>&1\n",
            sandbox.path("said").display()
        );
        for file in FIRMWARES {
            sandbox.write(file, &script);
            let mode = std::fs::Permissions::from_mode(0o700);
            std::fs::set_permissions(sandbox.path(file), mode).expect("an executable script");
        }
        let elf = sandbox.path("remote.elf");
        sandbox.write("betaloop/config.txt", &format!("[Betaloop]\nBetaflightElf={}\n", elf.display()));
        let folder = Path::new(PROGRAM).parent().expect("a folder").display().to_string();
        let mut variables = format!("PATH={folder}:$PATH; export PATH");
        if kind != Kind::ByItself {
            variables.push_str(&format!(
                "; BETADECK_TCP_PORT={tcp} BETADECK_UDP_PORTS={udp} BETADECK_WS_PORT=0; \
                 export BETADECK_TCP_PORT BETADECK_UDP_PORTS BETADECK_WS_PORT"
            ));
        }
        Self { sandbox, variables }
    }

    /// Flies what a line about campaigns needs before, and returns the line with few flights.
    fn of_campaign(&self, line: &str) -> String {
        let fly = |more: &[&str]| {
            let arguments = ["campaign", "my-campaign.toml", "--flights", "20"];
            self.sandbox.run(&[&arguments[..], more].concat()).exits(0);
        };
        if line.contains(" merge part") {
            fly(&["--shard", "1/2", "--out", "part-1.jsonl"]);
            fly(&["--shard", "2/2", "--out", "part-2.jsonl"]);
        } else if line.contains(" run.jsonl") && !line.contains("--out run.jsonl") {
            fly(&["--out", "run.jsonl"]);
        } else if (line.starts_with("betadeck campaign ") || line.starts_with("betadeck forecast "))
            && !line.contains("--sweep")
            && !line.contains("--help")
            && !line.contains("--flights")
        {
            return format!("{line} --flights 1");
        }
        // A page says how long many flights take.
        line.replace("--flights 1000", "--flights 10")
    }

    /// Runs a command line as a user would, and reports if it does not end as the page says.
    fn run(self, shown: &Shown, line: &str, kind: Kind) -> Result<(), String> {
        let attached = line.contains("--firmware attach");
        let before = if attached {
            "obj/main/betaflight_SITL.elf & firmware=$!; trap 'kill $firmware' EXIT; "
        } else {
            ""
        };
        if line.contains("open square.flight") || line.contains("replay square.flight") {
            self.sandbox.run(&["fly", "land", "--record", "square.flight"]).exits(0);
        }
        if line.contains("replay flight.tlog") {
            let log = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/exchange/mavlink/px4.tlog");
            std::fs::copy(log, self.sandbox.path("flight.tlog")).expect("a writable directory");
        }
        let port = format!("mavlink:udp:{}", free_port());
        let line = &self.of_campaign(line).replace("mavlink:udp:14550", &port);
        // The exit code is that of the command, and the shell reads it after a Ctrl-C, too.
        let script = format!("{}; trap : INT; {before}{line}\nexit $?\n", self.variables);
        let mut terminal = Terminal::start_in(self.sandbox, 200, 60, "/bin/sh", &["-c", &script]);
        let in_sentence = EXIT_CODES.iter().find(|(command, _)| *command == line).map(|(_, code)| *code);
        let in_comment =
            shown.text.split_once("exit code ").and_then(|(_, rest)| rest.get(..1)?.parse().ok());
        let (keys, codes): (&str, Vec<u32>) = match kind {
            // It reports what is wrong with this computer, if anything is.
            Kind::ByItself if line.contains(" doctor") => ("", vec![0, 1]),
            // The firmware here is a script, which cannot run in simulated time.
            Kind::ByItself if line.contains(" lab ") => ("", vec![3]),
            Kind::ByItself => ("", vec![in_comment.or(in_sentence).unwrap_or(0)]),
            Kind::Runs | Kind::RunsFirmware => ("\x03", vec![130]),
            Kind::Screen | Kind::ScreenWithFirmware => ("q", vec![0]),
        };
        match kind {
            Kind::ByItself => {}
            Kind::Runs => terminal.until("a first line", |terminal| !terminal.screen().trim().is_empty()),
            Kind::Screen => terminal.until("the screen", |terminal| {
                terminal.is_alternate() && terminal.screen().contains("help")
            }),
            Kind::RunsFirmware | Kind::ScreenWithFirmware => {
                await_firmware(&terminal).map_err(|error| format!("{}: {error}", shown.place))?;
            }
        }
        terminal.send(keys);
        let code = terminal.end();
        let seen = terminal.screen();
        codes
            .contains(&code)
            .then_some(())
            .ok_or_else(|| format!("{}: {kind:?} ended with {code}\n{seen}", shown.place))
    }
}

/// Waits until the firmware has got states from a simulator and a client at its TCP port.
fn await_firmware(terminal: &Terminal) -> Result<(), String> {
    let deadline = Instant::now() + NEVER;
    loop {
        let said = std::fs::read_to_string(terminal.home().path("said")).unwrap_or_default();
        if said.contains("new fdm") && said.contains("New connection on UART1") {
            return Ok(());
        }
        if Instant::now() > deadline {
            return Err(format!("the firmware is not in use\n{said}\n{}", terminal.screen()));
        }
        std::thread::sleep(Duration::from_millis(20));
    }
}

/// Returns the line to run for a command of a shell; `None` for a program of other people.
fn runnable(shown: &Shown) -> Result<Option<(String, Kind)>, String> {
    let mut line = filled_in(shown)?;
    let is_variable = |word: &String| {
        word.split_once('=').is_some_and(|(name, _)| name.chars().all(|c| c.is_ascii_uppercase() || c == '_'))
    };
    let mut words: Vec<String> = arguments(&line).into_iter().skip_while(is_variable).collect();
    let program = words.first().map(String::as_str).unwrap_or_default();
    if OTHERS.iter().any(|(name, _)| *name == program) {
        return Ok(None);
    }
    if program != "betadeck" {
        return Err(format!("{}: {program} is no program of OTHERS, and not betadeck", shown.place));
    }
    if !words.iter().any(|word| word == "--help" || word == "--version") {
        let arguments: Vec<OsString> = words.iter().map(OsString::from).collect();
        match args::parse(arguments, &Layers::default()) {
            Ok(_) => {}
            // In a sentence a command is named without its arguments; its help shows them.
            Err(error) if !shown.in_block && error.kind() == ErrorKind::MissingRequiredArgument => {
                line.push_str(" --help");
                words.push("--help".to_owned());
            }
            Err(error) => return Err(format!("{}: {error}", shown.place)),
        }
    }
    // The drop-in flies on the wall clock, and several seeds need simulated time.
    if words.iter().any(|word| word == "--seeds") && words.iter().any(|word| word == "--firmware") {
        return Ok(None);
    }
    let kind = Kind::of(&words);
    Ok(Some((line, kind)))
}

/// How many commands run at a time: most of them wait.
const AT_A_TIME: usize = 4;

/// Runs the commands of these kinds, each line once.
fn run_all(kinds: &[Kind], at_least: usize) {
    let mut lines: Vec<(Shown, String, Kind)> = Vec::new();
    let mut wrong = Vec::new();
    for shown in pages().iter().flat_map(|page| commands(page)).filter(|shown| !is_screen(&shown.text)) {
        match runnable(&shown) {
            Ok(Some((line, kind))) if kinds.contains(&kind) && lines.iter().all(|(_, of, _)| *of != line) => {
                lines.push((shown, line, kind));
            }
            Ok(_) => {}
            Err(problem) => wrong.push(problem),
        }
    }
    let next = AtomicUsize::new(0);
    let work = || {
        let others = std::iter::from_fn(|| lines.get(next.fetch_add(1, Ordering::Relaxed)));
        others.filter_map(|(shown, line, kind)| Desk::new(*kind).run(shown, line, *kind).err()).collect()
    };
    std::thread::scope(|scope| {
        let workers: Vec<_> = (0..AT_A_TIME).map(|_| scope.spawn(work)).collect();
        for worker in workers {
            wrong.extend::<Vec<String>>(worker.join().expect("a worker that ends"));
        }
    });
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(lines.len() >= at_least, "only {}", lines.len());
}

#[test]
fn every_command_of_the_pages_that_ends_does_as_the_page_says() {
    run_all(&[Kind::ByItself], 30);
}

#[test]
fn every_command_of_the_pages_that_serves_starts_and_ends_by_ctrl_c() {
    run_all(&[Kind::Runs], 4);
}

#[test]
fn every_command_of_the_pages_with_another_firmware_uses_it() {
    run_all(&[Kind::RunsFirmware, Kind::ScreenWithFirmware], 8);
}

#[test]
fn every_command_of_the_pages_that_opens_the_screen_does() {
    run_all(&[Kind::Screen], 6);
}
