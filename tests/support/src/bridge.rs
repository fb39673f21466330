//! A board on a cable, which carries the bytes of a TCP door.
#![allow(clippy::disallowed_methods, reason = "bytes are looked for in wall time")]

use std::io::{ErrorKind, Read as _, Write as _};
use std::net::{SocketAddr, TcpStream};
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::JoinHandle;
use std::time::Duration;

use super::cable::Cable;

/// The interval between two checks for bytes.
const LOOK: Duration = Duration::from_millis(1);

/// A cable from a device file to a TCP door, unplugged at first.
pub struct Bridge {
    door: SocketAddr,
    device: PathBuf,
    cable: Option<Cable>,
    carrying: Option<(Arc<AtomicBool>, JoinHandle<Cable>)>,
}

impl Bridge {
    pub fn new(door: SocketAddr) -> Self {
        let cable = Cable::unplugged();
        Self { door, device: cable.device(), cable: Some(cable), carrying: None }
    }

    /// Returns the path of the device file.
    pub fn device(&self) -> PathBuf {
        self.device.clone()
    }

    /// Plugs the cable in. The board has power, and no program has talked to it yet.
    pub fn plug_in(&mut self) {
        let Some(mut cable) = self.cable.take() else { return };
        let board = TcpStream::connect(self.door).expect("a door");
        board.set_nonblocking(true).expect("a socket");
        cable.plug_in();
        let stop = Arc::new(AtomicBool::new(false));
        let stopped = Arc::clone(&stop);
        let carry = std::thread::spawn(move || {
            carry(&mut cable, &board, &stopped);
            cable
        });
        self.carrying = Some((stop, carry));
    }

    /// Pulls the cable out, if it is plugged in.
    pub fn pull(&mut self) {
        let Some((stop, carry)) = self.carrying.take() else { return };
        stop.store(true, Ordering::Relaxed);
        let mut cable = carry.join().expect("the bridge works");
        cable.pull();
        self.cable = Some(cable);
    }
}

impl Drop for Bridge {
    fn drop(&mut self) {
        if let Some((stop, carry)) = self.carrying.take() {
            stop.store(true, Ordering::Relaxed);
            drop(carry.join());
        }
    }
}

/// Carries bytes both ways until `stop` is set.
fn carry(cable: &mut Cable, mut board: &TcpStream, stop: &AtomicBool) {
    let mut to_cable: Vec<u8> = Vec::new();
    while !stop.load(Ordering::Relaxed) {
        let mut bytes = [0; 4096];
        match board.read(&mut bytes) {
            Ok(count) => to_cable.extend(&bytes[..count]),
            Err(error) if error.kind() == ErrorKind::WouldBlock => {}
            Err(_) => return,
        }
        let left = cable.send(&to_cable).len();
        to_cable.drain(..to_cable.len() - left);
        // A few requests at a time: the socket takes them at once.
        if board.write_all(&cable.received()).is_err() {
            return;
        }
        std::thread::sleep(LOOK);
    }
}
