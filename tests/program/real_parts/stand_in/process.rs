//! The stand-in as a separate process: this test program starts itself, with a variable that selects the fault.

use std::process::ExitCode;
use std::sync::atomic::Ordering;
use std::time::Duration;

use super::cli::{Done, Memory};
use super::program::{End, Ports, Shared, Sockets, live};

/// The variable that passes the ports and the fault to the child. (The program's own variables are not passed on to
/// it.)
pub(crate) const VARIABLE: &str = "STAND_IN";
/// The test that the child runs.
const PROGRAM: &str = "real_parts::stand_in::process::the_program";
const IMAGE: &str = "eeprom.bin";

/// The fault of a stand-in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Trouble {
    None,
    /// Ends by a signal two seconds after it has booted.
    Crashes,
    /// Stops answering two seconds after it has booted.
    Hangs,
    /// Binds nothing for three seconds.
    StartsSlowly,
    /// Refuses every value.
    RefusesSettings,
    /// Prints a line and keeps running, but opens no ports.
    IsNoSitl,
    /// Was built without flight plans.
    HasNoPlans,
}

const TROUBLES: [(Trouble, &str); 7] = [
    (Trouble::None, "none"),
    (Trouble::Crashes, "crashes"),
    (Trouble::Hangs, "hangs"),
    (Trouble::StartsSlowly, "starts-slowly"),
    (Trouble::RefusesSettings, "refuses-settings"),
    (Trouble::IsNoSitl, "is-no-sitl"),
    (Trouble::HasNoPlans, "has-no-plans"),
];

/// Returns the value of [`VARIABLE`].
pub(crate) fn variable(ports: Ports, trouble: Trouble) -> String {
    let Ports { raw, motors, fdm, rc, tcp } = ports;
    let name = TROUBLES.iter().find(|(other, _)| *other == trouble).unwrap().1;
    format!("{raw},{motors},{fdm},{rc},{tcp},{name}")
}

/// Returns the executable, and the arguments that make it the stand-in.
pub(crate) fn command() -> (std::path::PathBuf, [&'static str; 4]) {
    (std::env::current_exe().unwrap(), [PROGRAM, "--exact", "--ignored", "--nocapture"])
}

#[test]
#[ignore = "it is the program of a child that other tests start"]
fn the_program() {
    let Ok(variable) = std::env::var(VARIABLE) else { return };
    let code = run(&variable);
    std::process::exit(i32::from(code != ExitCode::SUCCESS));
}

#[expect(clippy::print_stdout, reason = "it is what the program prints")]
fn run(variable: &str) -> ExitCode {
    let words: Vec<&str> = variable.split(',').collect();
    let trouble = TROUBLES.iter().find(|(_, name)| *name == words[5]).unwrap().0;
    let port = |at: usize| words[at].parse().unwrap();
    let ports = Ports { raw: port(0), motors: port(1), fdm: port(2), rc: port(3), tcp: port(4) };
    match trouble {
        Trouble::StartsSlowly => std::thread::sleep(Duration::from_secs(3)),
        Trouble::IsNoSitl => {
            println!("what is this?");
            std::thread::sleep(Duration::from_secs(3600));
        }
        _ => {}
    }
    println!("process {}", std::process::id());
    println!("[SITL] The SITL will output to IP 127.0.0.1:{} (Gazebo)", ports.motors);
    let mut sockets = match Sockets::bind(ports) {
        Ok(sockets) => sockets,
        Err(error) => {
            println!("bind failed!! {error}");
            return ExitCode::FAILURE;
        }
    };
    let (mut memory, shared) = (stored(), Shared::default());
    memory.refuses_settings = trouble == Trouble::RefusesSettings;
    memory.has_plans = trouble != Trouble::HasNoPlans;
    std::thread::scope(|scope| {
        scope.spawn(|| {
            std::thread::sleep(Duration::from_millis(2500));
            match trouble {
                Trouble::Crashes => std::process::abort(),
                Trouble::Hangs => shared.hangs.store(true, Ordering::Relaxed),
                _ => {}
            }
        });
        match live(&mut sockets, &mut memory, true, &shared) {
            End::Reboot => {
                if let Done::Answered(lines) = memory.run("diff") {
                    println!("[FLASH_ProgramWord]0x55577effc700 = 0042beb2");
                    std::fs::write(IMAGE, lines).unwrap();
                }
                std::process::exit(0);
            }
            End::EarlyState => std::process::abort(),
            End::Stopped => std::process::exit(0),
        }
    })
}

/// Reads the configuration stored in the working directory.
fn stored() -> Memory {
    let mut memory = Memory::new();
    for line in std::fs::read_to_string(IMAGE).unwrap_or_default().lines() {
        if !line.starts_with('#') {
            drop(memory.run(line));
        }
    }
    memory
}
