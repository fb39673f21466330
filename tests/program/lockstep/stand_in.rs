//! A stand-in for the public executable with its threads and its system calls: a main thread that reads the clock and
//! sleeps for 50 µs, a thread each for states and RC that waits with `select`, and a thread for the serial port whose loop
//! is a `select` of 10 ms. This test program starts itself as the stand-in.
//!
//! For each state its main loop folds the state, the newest RC packet and its clock into a number, which is its motor
//! packet. It answers each line on the serial port with the line, the time and that number. `serial_port` answers MSP and
//! the command line.
#![allow(unsafe_code, reason = "it makes the system calls of a C program")]
#![allow(clippy::print_stdout, reason = "the tests read what it prints")]

use std::ffi::{CStr, c_char};
use std::io::{ErrorKind, Read as _, Write as _};
use std::mem::offset_of;
use std::net::{TcpListener, TcpStream, UdpSocket};
use std::os::fd::AsRawFd;
use std::os::unix::fs::FileExt as _;
use std::os::unix::process::CommandExt as _;
use std::process::Command;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::thread::ScopedJoinHandle;

use super::flying::{self, FLYING};
use super::frames::{MOTOR_BYTES, Page, REPORT_BYTES, Report, SERIAL_PORTS};
use super::serial_port::{Effect, SerialPort};

/// The file in its folder with its ports: states, RC, motors, serial.
pub(crate) const PORTS_FILE: &str = "ports.txt";
/// The file in its folder that makes it close its first connection, and sleep.
pub(crate) const CLOSES_FILE: &str = "closes.txt";
/// The file in its folder that makes it crash unless its threads run on their own.
pub(crate) const OWN_THREADS_FILE: &str = "own-threads.txt";
/// The file in its folder that makes each process compute something else.
pub(crate) const DIFFERS_FILE: &str = "differs.txt";
/// The argument that makes this test program the stand-in.
pub(crate) const ARGUMENT: &str = "stand-in";

#[repr(C)]
#[derive(Default)]
struct Time {
    s: i64,
    fraction: i64,
}

unsafe extern "C" {
    fn fork() -> i32;
    fn clock_gettime(id: i32, time: *mut Time) -> i32;
    fn nanosleep(length: *const Time, left: *mut Time) -> i32;
    fn select(
        count: i32,
        readable: *mut [u64; 16],
        writable: *mut [u64; 16],
        failed: *mut [u64; 16],
        timeout: *mut Time,
    ) -> i32;
    fn recvfrom(
        fd: i32,
        bytes: *mut u8,
        size: usize,
        flags: i32,
        from: *mut u8,
        from_size: *mut u32,
    ) -> isize;
}

/// Returns the monotonic clock, ns.
fn clock_ns() -> u64 {
    let mut time = Time::default();
    // SAFETY: the time is writable.
    unsafe { clock_gettime(1, &raw mut time) };
    time.s as u64 * 1_000_000_000 + time.fraction as u64
}

pub(super) fn sleep_50_us() {
    let length = Time { s: 0, fraction: 50_000 };
    // SAFETY: the length is readable.
    unsafe { nanosleep(&raw const length, std::ptr::null_mut()) };
}

/// Waits until one of the descriptors is readable, or writable if it is the last and `writes`. Returns those that are.
fn wait(descriptors: &[i32], writes: bool, timeout_us: i64) -> Vec<i32> {
    let (mut readable, mut writable) = ([0_u64; 16], [0_u64; 16]);
    let set = |set: &mut [u64; 16], fd: i32| set[fd as usize / 64] |= 1 << (fd % 64);
    descriptors.iter().for_each(|fd| set(&mut readable, *fd));
    if let Some(last) = descriptors.last().filter(|_| writes) {
        set(&mut writable, *last);
    }
    let count = descriptors.iter().max().map_or(0, |fd| fd + 1);
    let mut timeout = Time { s: 0, fraction: timeout_us };
    // SAFETY: the sets and the time are writable.
    let ready = unsafe {
        select(count, &raw mut readable, &raw mut writable, std::ptr::null_mut(), &raw mut timeout)
    };
    let is_ready =
        |fd: &i32| (readable[*fd as usize / 64] | writable[*fd as usize / 64]) >> (fd % 64) & 1 == 1;
    if ready > 0 { descriptors.iter().copied().filter(is_ready).collect() } else { Vec::new() }
}

/// The number of threads that have begun.
static BEGUN: AtomicU32 = AtomicU32::new(0);

/// Begins as a thread that the machine lets run late.
fn begin_late() {
    std::thread::sleep(std::time::Duration::from_millis(10));
    let (own, process) = (std::fs::read_link("/proc/thread-self").unwrap(), std::process::id());
    if own.ends_with(format!("task/{process}")) && std::path::Path::new(OWN_THREADS_FILE).exists() {
        std::process::abort();
    }
    BEGUN.fetch_add(1, Ordering::SeqCst);
}

/// Reports a step with so many bytes over the serial ports, as a program that does not keep to the messages, and sleeps.
fn report(sent: u64) -> ! {
    let is_page = |entry: &std::fs::DirEntry| {
        std::fs::read_link(entry.path())
            .is_ok_and(|to| to.to_string_lossy().starts_with("/memfd:betadeck-page"))
    };
    let page = std::fs::read_dir("/proc/self/fd").unwrap().flatten().find(is_page).unwrap().path();
    let page = std::fs::File::options().read(true).write(true).open(page).unwrap();
    let report = Report {
        now_ns: 0,
        motor_packets: 0,
        motors: [0; MOTOR_BYTES],
        run: 0,
        sent,
        ports: [1; SERIAL_PORTS],
    };
    let mut granted = [0; 4];
    page.read_exact_at(&mut granted, offset_of!(Page, granted) as u64).unwrap();
    page.write_all_at(&report.to_bytes(), (size_of::<Page>() - REPORT_BYTES) as u64).unwrap();
    page.write_all_at(&granted, offset_of!(Page, reported) as u64).unwrap();
    loop {
        std::thread::park();
    }
}

/// `true` once its threads must end.
static STOPS: AtomicBool = AtomicBool::new(false);

/// `true` once the thread of the serial port must end its connection.
static CLOSES: AtomicBool = AtomicBool::new(false);

/// The newest packet of a port, and the number of packets.
struct Newest<const N: usize>(Mutex<([u8; N], u64)>);

/// Receives packets of a size, as the thread of a port does.
fn take_packets<const N: usize>(socket: &UdpSocket, newest: &Newest<N>) {
    let fd = socket.as_raw_fd();
    while !STOPS.load(Ordering::SeqCst) {
        if wait(&[fd], false, 100_000).is_empty() {
            continue;
        }
        let mut bytes = [0; N];
        let (mut from, mut from_size) = ([0_u8; 16], 16);
        // SAFETY: the bytes and the address are writable.
        let size = unsafe { recvfrom(fd, bytes.as_mut_ptr(), N, 0, from.as_mut_ptr(), &raw mut from_size) };
        if size == N as isize {
            let mut newest = newest.0.lock().unwrap();
            *newest = (bytes, newest.1 + 1);
        }
    }
}

/// The bytes between the thread of the serial port and the main thread.
#[derive(Default)]
struct Serial {
    received: Mutex<Vec<u8>>,
    to_send: Mutex<Vec<u8>>,
}

/// Serves one client of the serial port after the other.
fn serve(listener: &TcpListener, serial: &Serial) {
    let mut client: Option<TcpStream> = None;
    let mut unsent = Vec::new();
    while !STOPS.load(Ordering::SeqCst) {
        unsent.append(&mut serial.to_send.lock().unwrap());
        if CLOSES.swap(false, Ordering::SeqCst) {
            client = None;
        }
        let descriptors: Vec<i32> =
            std::iter::once(listener.as_raw_fd()).chain(client.as_ref().map(AsRawFd::as_raw_fd)).collect();
        let ready = wait(&descriptors, client.is_some() && !unsent.is_empty(), 10_000);
        if ready.contains(&listener.as_raw_fd()) {
            let (stream, _) = listener.accept().unwrap();
            if std::path::Path::new(CLOSES_FILE).exists() {
                drop(stream);
                std::thread::park();
                continue;
            }
            stream.set_nonblocking(true).unwrap();
            client = Some(stream);
            continue;
        }
        let Some(stream) = client.as_mut().filter(|client| ready.contains(&client.as_raw_fd())) else {
            continue;
        };
        let mut bytes = [0; 64];
        match stream.read(&mut bytes) {
            Ok(0) => client = None,
            Ok(size) => serial.received.lock().unwrap().extend_from_slice(&bytes[..size]),
            Err(error) if error.kind() == ErrorKind::WouldBlock => {
                let sent = stream.write(&unsent).unwrap();
                unsent.drain(..sent);
            }
            Err(_) => client = None,
        }
    }
}

/// Runs before the main function of this test program, because the test harness gives each test a thread of its own, and
/// a SITL executable lives on the main thread.
#[used]
#[unsafe(link_section = ".init_array")]
static BEFORE_MAIN: extern "C" fn(i32, *const *const c_char) = before_main;

extern "C" fn before_main(count: i32, arguments: *const *const c_char) {
    // SAFETY: the C library passes as many arguments as it counts, each with a zero at its end.
    let argument = if count == 2 { unsafe { CStr::from_ptr(*arguments.add(1)) }.to_bytes() } else { b"" };
    if argument == ARGUMENT.as_bytes() {
        run();
    } else if argument == FLYING.as_bytes() {
        flying::run();
    }
}

/// The parts of the program that its threads share.
pub(super) struct Parts {
    state: Newest<144>,
    rc: Newest<40>,
    serial: Serial,
    motors_out: UdpSocket,
    motors_port: u16,
}

impl Parts {
    /// Returns the newest state and RC packet, and the number of states.
    pub(super) fn newest(&self) -> ([u8; 144], [u8; 40], u64) {
        let (state, count) = *self.state.0.lock().unwrap();
        (state, self.rc.0.lock().unwrap().0, count)
    }

    /// Sends a motor packet.
    pub(super) fn send_motors(&self, packet: &[u8; 16]) {
        self.motors_out.send_to(packet, ("127.0.0.1", self.motors_port)).unwrap();
    }

    /// Returns the bytes that came over the serial port.
    pub(super) fn received(&self) -> Vec<u8> {
        std::mem::take(&mut *self.serial.received.lock().unwrap())
    }

    /// Sends bytes over the serial port.
    pub(super) fn send(&self, bytes: &[u8]) {
        self.serial.to_send.lock().unwrap().extend_from_slice(bytes);
    }
}

/// Starts the threads, and runs `main` on this one. The ports are those of states, RC, motors and the serial port.
pub(super) fn with_threads(
    [states, rc, motors_port, serial]: [u16; 4],
    main: impl for<'s> FnOnce(&'s Parts, Vec<ScopedJoinHandle<'s, ()>>),
) {
    let bind = |port| UdpSocket::bind(("0.0.0.0", port)).unwrap();
    let (states_in, rc_in) = (bind(states), bind(rc));
    let listener = TcpListener::bind(("0.0.0.0", serial)).unwrap();
    let parts = Parts {
        state: Newest(Mutex::new(([0_u8; 144], 0))),
        rc: Newest(Mutex::new(([0_u8; 40], 0))),
        serial: Serial::default(),
        motors_out: bind(0),
        motors_port,
    };
    std::thread::scope(|scope| {
        let threads = vec![
            scope.spawn(|| {
                begin_late();
                serve(&listener, &parts.serial);
                println!("the serial thread ends");
            }),
            scope.spawn(|| {
                begin_late();
                take_packets(&states_in, &parts.state);
                println!("the state thread ends");
            }),
            scope.spawn(|| {
                begin_late();
                take_packets(&rc_in, &parts.rc);
                println!("the RC thread ends");
            }),
        ];
        // The threads of the executable share data with its main thread, which must not go on before them.
        if BEGUN.load(Ordering::SeqCst) != 3 {
            println!("a thread has not come to wait for its turn");
            std::process::exit(9);
        }
        main(&parts, threads);
    });
}

fn run() {
    let ports = std::fs::read_to_string(PORTS_FILE).unwrap();
    let ports: Vec<u16> = ports.split(',').map(|port| port.parse().unwrap()).collect();
    with_threads(ports.try_into().unwrap(), |parts, mut threads| {
        let differs = std::path::Path::new(DIFFERS_FILE).exists();
        let mut number = if differs { u64::from(std::process::id()) } else { 0 };
        let (started_ns, mut states, mut terminal) = (clock_ns(), 0, SerialPort::default());
        loop {
            let now_ns = clock_ns();
            let (state, rc, count) = parts.newest();
            if count == std::mem::replace(&mut states, count) {
                sleep_50_us();
                continue;
            }
            for byte in state.iter().chain(&rc).chain(&now_ns.to_le_bytes()) {
                number = (number ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3);
            }
            let mut packet = [0; 16];
            packet[..8].copy_from_slice(&number.to_le_bytes());
            packet[8..].copy_from_slice(&(now_ns - started_ns).to_le_bytes());
            parts.send_motors(&packet);
            for byte in parts.received() {
                let text = match terminal.take(byte, &rc) {
                    None => continue,
                    Some(Effect::Send(bytes)) => {
                        parts.send(&bytes);
                        continue;
                    }
                    Some(Effect::Save) => std::process::exit(0),
                    Some(Effect::Line(line)) => line,
                };
                match text.as_str() {
                    "save" => std::process::exit(0),
                    "join" => {
                        // Upstream waits for two of its threads before it replaces itself or ends.
                        STOPS.store(true, Ordering::SeqCst);
                        threads.drain(..2).for_each(|thread| thread.join().unwrap());
                        drop(Command::new(std::env::current_exe().unwrap()).arg(ARGUMENT).exec());
                    }
                    "exec" => drop(Command::new(std::env::current_exe().unwrap()).arg(ARGUMENT).exec()),
                    "start" => {
                        let started = Command::new("/usr/bin/env").output().unwrap();
                        let variables = String::from_utf8(started.stdout).unwrap();
                        let is_inherited = variables.contains("BETADECK") || variables.contains("LD_PRELOAD");
                        println!("a program inherits lockstep: {is_inherited}");
                    }
                    "print" => println!("printed at {} µs", (now_ns - started_ns) / 1000),
                    "crash" => std::process::abort(),
                    "overstate" => report(u64::MAX),
                    "promise" => report(100_000),
                    "sleep" => std::thread::park(),
                    "fork" => {
                        // SAFETY: the copy only sleeps.
                        if unsafe { fork() } == 0 {
                            std::thread::park();
                        }
                        std::process::exit(7);
                    }
                    "close" => CLOSES.store(true, Ordering::SeqCst),
                    "hang" => loop {
                        std::hint::spin_loop();
                    },
                    _ => {}
                }
                let answer = format!("{text} at {} µs, {number:x}\n", (now_ns - started_ns) / 1000);
                parts.send(answer.as_bytes());
            }
        }
    });
}
