//! The stand-in's sockets and one run of it, from boot to reboot.

use std::io::{ErrorKind, Read as _, Write as _};
use std::net::{SocketAddr, TcpListener, TcpStream, UdpSocket};
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use super::cli::Memory;
use super::receiver::{BOOT_US, Receiver, Seen, Taken};
use super::serial::Serial;

/// The time of the first motor packet, shortly before it is ready, µs.
const BOOT_PACKET_US: u64 = BOOT_US - 10_000;
/// The periods of the mixer and of the serial port, µs.
const MIXER_US: u64 = 1000;
const SERIAL_US: u64 = 10_000;
/// The longest wait for a state.
const WAIT: Duration = Duration::from_micros(300);

/// The sockets of one executable.
#[derive(Debug)]
pub(crate) struct Sockets {
    fdm: UdpSocket,
    rc: UdpSocket,
    /// Bound once it has booted.
    tcp: Option<TcpListener>,
    tcp_port: u16,
    /// The destinations of its motor packets: values, and pulses in `raw`.
    motors: SocketAddr,
    raw: SocketAddr,
}

/// Its UDP ports (raw and motors out, states and RC in) and its TCP port.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Ports {
    pub(crate) raw: u16,
    pub(crate) motors: u16,
    pub(crate) fdm: u16,
    pub(crate) rc: u16,
    pub(crate) tcp: u16,
}

impl Sockets {
    /// Binds the UDP sockets. For port 0 the system chooses one.
    pub(crate) fn bind(ports: Ports) -> std::io::Result<Self> {
        let (fdm, rc) = (UdpSocket::bind(here(ports.fdm))?, UdpSocket::bind(here(ports.rc))?);
        fdm.set_nonblocking(true)?;
        rc.set_nonblocking(true)?;
        let (motors, raw) = (here(ports.motors), here(ports.raw));
        Ok(Self { fdm, rc, tcp: None, tcp_port: ports.tcp, motors, raw })
    }

    /// Accepts TCP clients from now on.
    pub(crate) fn listen(&mut self) -> std::io::Result<()> {
        let tcp = TcpListener::bind(here(self.tcp_port))?;
        tcp.set_nonblocking(true)?;
        self.tcp_port = tcp.local_addr()?.port();
        self.tcp = Some(tcp);
        Ok(())
    }

    /// Drops the waiting packets, and closes the TCP port.
    pub(crate) fn forget(&mut self) {
        self.tcp = None;
        let mut buffer = [0; 512];
        while self.fdm.recv(&mut buffer).is_ok() || self.rc.recv(&mut buffer).is_ok() {}
    }

    /// Returns the ports in use.
    pub(crate) fn ports(&self) -> Ports {
        Ports {
            raw: self.raw.port(),
            motors: self.motors.port(),
            fdm: self.fdm.local_addr().unwrap().port(),
            rc: self.rc.local_addr().unwrap().port(),
            tcp: self.tcp_port,
        }
    }

    /// Sends one motor packet of a craft at rest, and its pulses if `pulses_too`.
    fn send_motors(&self, pulses_too: bool) {
        // There may be no receiver.
        drop(self.fdm.send_to(&[0; 16], self.motors));
        if pulses_too {
            let mut pulses = [0; 68];
            pulses[0] = 4;
            for at in [4, 8, 12, 16] {
                pulses[at..at + 4].copy_from_slice(&1000.0_f32.to_le_bytes());
            }
            drop(self.fdm.send_to(&pulses, self.raw));
        }
    }
}

fn here(port: u16) -> SocketAddr {
    SocketAddr::from(([127, 0, 0, 1], port))
}

/// The reason for the end of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum End {
    Reboot,
    /// A state arrived before it had booted, which it does not survive.
    EarlyState,
    Stopped,
}

/// The data that a run shares with its test.
#[derive(Debug, Default)]
pub(crate) struct Shared {
    pub(crate) stop: AtomicBool,
    /// `true` while it hangs and does not answer.
    pub(crate) hangs: AtomicBool,
    pub(crate) seen: Mutex<Seen>,
    /// The error of its clock against the wall clock, µs.
    pub(crate) clock_error_us: Mutex<f64>,
}

/// Runs once: boots, and answers until it is stopped or reboots. `memory` is its stored configuration.
pub(crate) fn live(sockets: &mut Sockets, memory: &mut Memory, boots: bool, shared: &Shared) -> End {
    let start = Instant::now();
    let boot = Duration::from_micros(BOOT_US);
    if boots {
        sockets.tcp = None;
    }
    let mut life = Life {
        sockets,
        start: if boots { start } else { start.checked_sub(boot).unwrap_or(start) },
        receiver: Receiver::new(),
        serial: Serial::new(memory.clone()),
        client: None,
        mixer_at: 0,
        serial_at: 0,
    };
    let end = life.run(shared);
    // The end of a process closes its port together with its connections.
    life.sockets.tcp = None;
    memory.clone_from(&life.serial.memory);
    end
}

struct Life<'a> {
    sockets: &'a mut Sockets,
    start: Instant,
    receiver: Receiver,
    serial: Serial,
    client: Option<TcpStream>,
    mixer_at: u64,
    serial_at: u64,
}

impl Life<'_> {
    fn wall_us(&self) -> u64 {
        self.start.elapsed().as_micros() as u64
    }

    fn run(&mut self, shared: &Shared) -> End {
        let (mut sent, mut booted) = (false, false);
        while !shared.stop.load(Ordering::Relaxed) {
            if shared.hangs.load(Ordering::Relaxed) {
                std::thread::sleep(WAIT);
                continue;
            }
            let busy = self.take_states();
            let now = self.wall_us();
            *shared.seen.lock().unwrap() = self.receiver.seen;
            *shared.clock_error_us.lock().unwrap() = self.receiver.clock_us(now) - now as f64;
            if now >= BOOT_PACKET_US && !std::mem::replace(&mut sent, true) {
                self.sockets.send_motors(true);
            }
            if now < BOOT_US {
                if self.receiver.seen.before_boot > 0 {
                    return End::EarlyState;
                }
                std::thread::sleep(WAIT);
                continue;
            }
            if !std::mem::replace(&mut booted, true) && self.sockets.tcp.is_none() {
                self.sockets.listen().unwrap();
            }
            self.take_rc(now);
            if now >= self.mixer_at + MIXER_US {
                self.mixer_at = now / MIXER_US * MIXER_US;
                if self.receiver.mixer_sends() {
                    self.sockets.send_motors(true);
                }
            }
            if now >= self.serial_at + SERIAL_US {
                self.serial_at = now / SERIAL_US * SERIAL_US;
                self.serve(now);
                if self.serial.reboots() {
                    return End::Reboot;
                }
            }
            if !busy {
                std::thread::sleep(WAIT);
            }
        }
        End::Stopped
    }

    /// Takes the waiting states. Returns `true` if there were any.
    fn take_states(&mut self) -> bool {
        let mut buffer = [0; 512];
        let mut any = false;
        while let Ok(size) = self.sockets.fdm.recv(&mut buffer) {
            any = true;
            let now = self.wall_us();
            if self.receiver.receive(&buffer[..size], now) == Taken::Resync {
                self.sockets.send_motors(false);
            }
        }
        any
    }

    fn take_rc(&mut self, now: u64) {
        let mut buffer = [0; 64];
        while let Ok(size) = self.sockets.rc.recv(&mut buffer) {
            if size >= 40 {
                let pulse = |at: usize| u16::from_le_bytes([buffer[8 + 2 * at], buffer[9 + 2 * at]]);
                self.serial.rc = Some((std::array::from_fn(pulse), now));
            }
        }
    }

    /// Runs one turn of the serial port. It serves one client; any other is accepted and closed.
    fn serve(&mut self, now: u64) {
        while let Some(Ok((client, _))) = self.sockets.tcp.as_ref().map(TcpListener::accept) {
            if self.client.is_none() && client.set_nonblocking(true).is_ok() {
                self.client = Some(client);
            }
        }
        let mut came = [0; 2048];
        let came: &[u8] = match self.client.as_mut().map(|client| client.read(&mut came)) {
            Some(Ok(size @ 1..)) => &came[..size],
            Some(Err(error)) if error.kind() == ErrorKind::WouldBlock => &[],
            Some(_) => {
                self.client = None;
                &[]
            }
            None => &[],
        };
        let output = self.serial.turn(came, &self.receiver, now);
        if let Some(client) = &mut self.client
            && client.write_all(&output).is_err()
        {
            self.client = None;
        }
    }
}
