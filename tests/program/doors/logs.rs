//! The logs of the craft: downloaded as the App does it, and in the directory of the drop-in.

use std::time::{Duration, Instant};

use betadeck::blackbox::FrameKind;
use betadeck::blackbox::decode::{Item, LogReader};

use super::app::App;
use super::program::{PATIENCE, Serve, Sitl};
use super::serial::Terminal;
use super::simulator::Sockets;

/// The App's messages about the memory: its state, a part of it, its end.
const SUMMARY: u16 = 70;
const READ: u16 = 71;
const ERASE: u16 = 72;
/// The bytes of a part.
const PART: u16 = 4096;

/// Returns the number of main frames of the logs, without damage.
fn main_frames(bytes: &[u8]) -> usize {
    let mut reader = LogReader::new(bytes);
    let mut frames = 0;
    loop {
        let offset = reader.offset();
        let Some(item) = reader.next_item().unwrap() else { break };
        match item {
            Item::Frame(frame) if matches!(frame.kind, FrameKind::Intra | FrameKind::Inter) => frames += 1,
            // The end may be in the middle of a frame.
            Item::Skipped { .. } => assert!(offset + 500 > bytes.len() as u64, "damage at {offset}"),
            Item::Refused { error, .. } => panic!("{error}"),
            _ => {}
        }
    }
    frames
}

/// Tries until there is a result.
fn patiently<T>(what: &str, mut attempt: impl FnMut() -> Option<T>) -> T {
    let begun = Instant::now();
    while begun.elapsed() < PATIENCE {
        if let Some(result) = attempt() {
            return result;
        }
        std::thread::sleep(Duration::from_millis(50));
    }
    panic!("no {what}")
}

/// Returns the size and the used bytes of the memory.
fn summary(app: &mut App) -> (usize, usize) {
    let answer = app.expect(SUMMARY);
    assert_eq!((answer.len(), answer[0]), (13, 3), "ready and supported");
    let number = |at: usize| u32::from_le_bytes(answer[at..at + 4].try_into().unwrap()) as usize;
    assert_eq!(number(1) * 4096, number(5), "sectors");
    (number(5), number(9))
}

fn part(app: &mut App, address: usize, length: u16) -> Vec<u8> {
    let address = (address as u32).to_le_bytes();
    let request = [&address[..], &length.to_le_bytes(), &[1]].concat();
    let answer = app.ask(READ, &request).unwrap();
    assert_eq!(answer[..4], address);
    assert_eq!(usize::from(u16::from_le_bytes([answer[4], answer[5]])), answer.len() - 7);
    assert_eq!(answer[6], 0, "not compressed");
    answer[7..].to_vec()
}

#[test]
fn the_app_downloads_the_log_of_the_craft_and_erases_it() {
    let serve = Serve::start("8");
    let mut app = App::open(serve.websocket);
    assert_eq!(summary(&mut app), (16 << 20, 0));
    // Device flash, every loop of four.
    assert_eq!(app.ask(81, &[1, 1, 4, 0, 0, 2, 0, 0, 0, 0]), Some(Vec::new()));
    assert_eq!(app.expect(80)[..2], [1, 1], "supported, in the flash memory");
    Terminal::open(serve.tcp).type_lines("set blackbox_mode = ALWAYS");
    let used = patiently("a log", || Some(summary(&mut app).1).filter(|used| *used > 60_000));
    let mut log = Vec::new();
    while log.len() < used {
        log.extend(part(&mut app, log.len(), PART));
    }
    assert!(main_frames(&log[..used]) > 500);
    assert_eq!(part(&mut app, 16 << 20, PART), b"", "there is nothing beyond the end");
    // It stays until it is erased.
    assert_eq!(part(&mut app, 0, 100), log[..100]);
    assert_eq!(app.ask(81, &[0, 1, 4, 0, 0, 2, 0, 0, 0, 0]), Some(Vec::new()));
    assert_eq!(app.ask(ERASE, &[]), Some(Vec::new()));
    assert_eq!(summary(&mut app), (16 << 20, 0));
}

#[test]
fn the_drop_in_writes_its_logs_beside_its_configuration() {
    let sockets = Sockets::open();
    let sitl = Sitl::start(sockets.raw_port(), sockets.motors_port());
    let _simulator = sockets.fly(sitl.fdm, 4.0);
    let mut terminal = Terminal::open(sitl.tcp);
    terminal.type_lines("set blackbox_device = VIRTUAL\nset blackbox_mode = ALWAYS");
    let log = |number: u32| std::fs::read(sitl.program.directory().join(format!("LOG{number:05}.BFL")));
    patiently("a log before the restart", || log(1).ok().filter(|log| !log.is_empty()));
    terminal.save();
    // The log before the restart has its end.
    let second = patiently("a second log", || log(2).ok().filter(|log| log.len() > 30_000));
    assert!(main_frames(&second) > 200);
    let first = log(1).unwrap();
    assert!(first.ends_with(b"End of log\0"), "{} bytes", first.len());
    main_frames(&first);
}
