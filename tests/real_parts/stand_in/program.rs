//! The stand-in's sockets and its life, from boot to reboot.

use std::io::{ErrorKind, Read as _, Write as _};
use std::net::{SocketAddr, TcpListener, TcpStream, UdpSocket};
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use super::cli::Memory;
use super::receiver::{BOOT_US, Receiver, Seen, Taken};
use super::serial::Serial;

/// Its first motor packet goes out shortly before it is ready, µs.
const BOOT_PACKET_US: u64 = BOOT_US - 10_000;
/// The mixer's period and the serial port's, µs.
const MIXER_US: u64 = 1000;
const SERIAL_US: u64 = 10_000;
/// The longest wait for a state.
const WAIT: Duration = Duration::from_micros(300);

/// The sockets of one executable.
#[derive(Debug)]
pub(crate) struct Sockets {
    fdm: UdpSocket,
    rc: UdpSocket,
    /// Bound when it has booted, not before.
    tcp: Option<TcpListener>,
    tcp_port: u16,
    /// Where its motors go: values, pulses.
    motors: SocketAddr,
    raw: SocketAddr,
}

/// Its four ports in, out and beside: raw, motors, states, RC; and TCP.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Ports {
    pub(crate) raw: u16,
    pub(crate) motors: u16,
    pub(crate) fdm: u16,
    pub(crate) rc: u16,
    pub(crate) tcp: u16,
}

impl Sockets {
    /// Binds the sockets of packets; ports 0 are the system's choice.
    pub(crate) fn bind(ports: Ports) -> std::io::Result<Self> {
        let (fdm, rc) = (UdpSocket::bind(here(ports.fdm))?, UdpSocket::bind(here(ports.rc))?);
        fdm.set_nonblocking(true)?;
        rc.set_nonblocking(true)?;
        let (motors, raw) = (here(ports.motors), here(ports.raw));
        Ok(Self { fdm, rc, tcp: None, tcp_port: ports.tcp, motors, raw })
    }

    /// Takes clients from now on.
    pub(crate) fn listen(&mut self) -> std::io::Result<()> {
        let tcp = TcpListener::bind(here(self.tcp_port))?;
        tcp.set_nonblocking(true)?;
        self.tcp_port = tcp.local_addr()?.port();
        self.tcp = Some(tcp);
        Ok(())
    }

    /// Drops what waits, and the clients' port.
    pub(crate) fn forget(&mut self) {
        self.tcp = None;
        let mut buffer = [0; 512];
        while self.fdm.recv(&mut buffer).is_ok() || self.rc.recv(&mut buffer).is_ok() {}
    }

    /// The ports that were bound.
    pub(crate) fn ports(&self) -> Ports {
        Ports {
            raw: self.raw.port(),
            motors: self.motors.port(),
            fdm: self.fdm.local_addr().unwrap().port(),
            rc: self.rc.local_addr().unwrap().port(),
            tcp: self.tcp_port,
        }
    }

    /// One motor packet of a craft at rest, and its pulses when both go out.
    fn send_motors(&self, pulses_too: bool) {
        // Nobody may be there.
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

/// Why a life ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum End {
    Reboot,
    /// A state came before it had booted, which it does not survive.
    EarlyState,
    Stopped,
}

/// What the other side sees of a life while it lasts.
#[derive(Debug, Default)]
pub(crate) struct Shared {
    pub(crate) stop: AtomicBool,
    /// Stands still, and does not answer.
    pub(crate) hangs: AtomicBool,
    pub(crate) seen: Mutex<Seen>,
    /// How far its clock is from the wall's, µs.
    pub(crate) clock_error_us: Mutex<f64>,
}

/// Lives once: boots, answers, until it is stopped or reboots. The memory is what it keeps.
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

    /// Takes what waits; whether there was anything.
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

    /// One turn of the serial port: one client, every other one is accepted and closed.
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
