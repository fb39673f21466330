//! The sockets of the door: who is at the other end of each, and the bytes both ways.

use std::collections::BTreeMap;
use std::io;
use std::net::{IpAddr, Ipv4Addr, SocketAddr};

use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};
use tokio::net::{TcpListener, TcpStream, UdpSocket};
use tokio::sync::mpsc;
use tokio_util::sync::CancellationToken;
use tokio_util::task::TaskTracker;

use super::Place;
use crate::mavlink::craft::PeerId;
use crate::mavlink::frame;

/// The number of TCP connections and of known UDP senders at the same time.
const PEERS_MAX: usize = 16;
/// The number of packets that wait for a peer, and of those that wait to be read.
const QUEUE: usize = 256;
/// The most that is read at once, bytes.
const READ: usize = 4096;
const LOOPBACK: IpAddr = IpAddr::V4(Ipv4Addr::LOCALHOST);

/// The reason why a place is not open.
#[derive(Debug, thiserror::Error)]
#[error("MAVLink {place}: {error}; choose another place with --mavlink")]
pub struct DoorError {
    place: Place,
    error: io::Error,
}

/// An event of the sockets.
#[derive(Debug)]
pub(super) enum Incoming {
    /// A TCP client connected; packets for it go into the queue.
    Connected(PeerId, mpsc::Sender<Vec<u8>>),
    /// Bytes from a peer.
    Bytes(PeerId, Vec<u8>),
    /// A TCP client is gone.
    Disconnected(PeerId),
    /// A client whose first byte begins no frame was turned away.
    Stranger,
}

/// The open sockets.
#[derive(Debug)]
pub(super) struct Sockets {
    udp: Option<UdpSocket>,
    /// The addresses of UDP peers: first those where ground stations listen, then those that have sent.
    addresses: Vec<Option<SocketAddr>>,
    /// The number of the former.
    targets: u32,
    /// The queues of TCP clients.
    clients: BTreeMap<PeerId, mpsc::Sender<Vec<u8>>>,
    incoming: mpsc::Receiver<Incoming>,
    datagram: Vec<u8>,
    /// The addresses of the listeners.
    pub(super) listening: Vec<SocketAddr>,
}

/// The numbers of UDP peers begin here. TCP clients have lower ones.
const FIRST_UDP: u32 = 1 << 16;

impl Sockets {
    /// Opens the places. Tasks run in `tasks` until `stop`.
    pub(super) async fn open(
        places: &[Place],
        stop: &CancellationToken,
        tasks: &TaskTracker,
    ) -> (Self, Vec<DoorError>) {
        let (sender, incoming) = mpsc::channel(QUEUE);
        let mut sockets = Self {
            udp: None,
            addresses: Vec::new(),
            targets: 0,
            clients: BTreeMap::new(),
            incoming,
            datagram: vec![0; 65_536],
            listening: Vec::new(),
        };
        let mut errors = Vec::new();
        for &place in places {
            if let Err(error) = sockets.open_place(place, &sender, stop, tasks).await {
                errors.push(DoorError { place, error });
            }
        }
        (sockets, errors)
    }

    async fn open_place(
        &mut self,
        place: Place,
        sender: &mpsc::Sender<Incoming>,
        stop: &CancellationToken,
        tasks: &TaskTracker,
    ) -> io::Result<()> {
        match place {
            Place::Udp(port) => {
                if self.udp.is_none() {
                    self.udp = Some(UdpSocket::bind((LOOPBACK, 0)).await?);
                }
                self.addresses.push(Some((LOOPBACK, port).into()));
                self.targets += 1;
            }
            Place::Tcp(port) => {
                let listener = TcpListener::bind((LOOPBACK, port)).await?;
                self.listening.push(listener.local_addr()?);
                tasks.spawn(listen(listener, sender.clone(), stop.clone(), tasks.clone()));
            }
        }
        Ok(())
    }

    /// Returns the peers to which the door sends before they have sent anything.
    pub(super) fn targets(&self) -> impl Iterator<Item = PeerId> {
        (FIRST_UDP..FIRST_UDP + self.targets).map(PeerId)
    }

    /// Waits for what comes next.
    pub(super) async fn next(&mut self) -> Incoming {
        let Some(udp) = &self.udp else {
            return match self.incoming.recv().await {
                Some(incoming) => incoming,
                None => std::future::pending().await,
            };
        };
        loop {
            tokio::select! {
                Some(incoming) = self.incoming.recv() => return incoming,
                received = udp.recv_from(&mut self.datagram) => {
                    // A target without a listener is reported as an error of a later call.
                    let Ok((length, from)) = received else { continue };
                    let bytes = self.datagram.get(..length).unwrap_or_default();
                    if !begins_a_frame(bytes) {
                        continue;
                    }
                    let bytes = bytes.to_vec();
                    if let Some(peer) = udp_peer(&mut self.addresses, from) {
                        return Incoming::Bytes(peer, bytes);
                    }
                }
            }
        }
    }

    /// Forgets the UDP peers that the protocol no longer knows, except those where ground stations listen.
    pub(super) fn forget(&mut self, is_known: impl Fn(PeerId) -> bool) {
        for (peer, address) in (FIRST_UDP..).map(PeerId).zip(&mut self.addresses).skip(self.targets as usize)
        {
            if !is_known(peer) {
                *address = None;
            }
        }
    }

    /// Notes a client that connected or left.
    pub(super) fn note(&mut self, incoming: &Incoming) {
        match incoming {
            Incoming::Connected(peer, queue) => _ = self.clients.insert(*peer, queue.clone()),
            Incoming::Disconnected(peer) => _ = self.clients.remove(peer),
            Incoming::Bytes(..) | Incoming::Stranger => {}
        }
    }

    /// Sends a packet. One that cannot go at once is dropped, as on a radio.
    pub(super) fn send(&self, peer: PeerId, packet: Vec<u8>) {
        if let Some(queue) = self.clients.get(&peer) {
            queue.try_send(packet).ok();
        } else if let (Some(udp), Some(&Some(address))) =
            (&self.udp, peer.0.checked_sub(FIRST_UDP).and_then(|at| self.addresses.get(at as usize)))
        {
            udp.try_send_to(&packet, address).ok();
        }
    }
}

/// Returns the number of a UDP peer, which is noted; `None` if there are too many.
fn udp_peer(addresses: &mut Vec<Option<SocketAddr>>, from: SocketAddr) -> Option<PeerId> {
    let known = addresses.iter().position(|address| *address == Some(from));
    let at = known.or_else(|| addresses.iter().position(Option::is_none)).unwrap_or(addresses.len());
    if at >= PEERS_MAX {
        return None;
    }
    if at == addresses.len() {
        addresses.push(None);
    }
    *addresses.get_mut(at)? = Some(from);
    Some(PeerId(FIRST_UDP + at as u32))
}

/// Returns `true` if bytes may be those of a ground station. A web page can send a request to any TCP port, and by WebRTC a
/// datagram to any UDP port, with text of its own inside. The first byte of all these begins no frame.
fn begins_a_frame(bytes: &[u8]) -> bool {
    bytes.first().is_some_and(|&byte| frame::is_start(byte))
}

/// Serves TCP clients until the door closes.
async fn listen(
    listener: TcpListener,
    sender: mpsc::Sender<Incoming>,
    stop: CancellationToken,
    tasks: TaskTracker,
) {
    let seats = std::sync::Arc::new(tokio::sync::Semaphore::new(PEERS_MAX));
    let mut number = 0;
    loop {
        let accepted = tokio::select! {
            () = stop.cancelled() => return,
            accepted = listener.accept() => accepted,
        };
        let (Ok((stream, _)), Ok(seat)) = (accepted, std::sync::Arc::clone(&seats).try_acquire_owned())
        else {
            // Too many clients, or too many open files.
            tokio::task::yield_now().await;
            continue;
        };
        let peer = PeerId(number);
        number = (number + 1) % FIRST_UDP;
        let (sender, stop) = (sender.clone(), stop.clone());
        tasks.spawn(async move {
            tokio::select! {
                () = stop.cancelled() => {}
                () = serve(stream, peer, &sender) => {}
            }
            drop(seat);
        });
    }
}

/// Moves the bytes of a TCP client until it leaves.
async fn serve(mut stream: TcpStream, peer: PeerId, sender: &mpsc::Sender<Incoming>) {
    stream.set_nodelay(true).ok();
    let (queue, mut packets) = mpsc::channel(QUEUE);
    if sender.send(Incoming::Connected(peer, queue)).await.is_err() {
        return;
    }
    let (mut from, mut to) = stream.split();
    let reads = async {
        let (mut buffer, mut is_first) = (vec![0; READ], true);
        while let Ok(length @ 1..) = from.read(&mut buffer).await {
            let bytes = buffer.get(..length).unwrap_or_default();
            if is_first && !begins_a_frame(bytes) {
                sender.send(Incoming::Stranger).await.ok();
                return;
            }
            is_first = false;
            if sender.send(Incoming::Bytes(peer, bytes.to_vec())).await.is_err() {
                return;
            }
        }
    };
    let writes = async {
        while let Some(packet) = packets.recv().await {
            if to.write_all(&packet).await.is_err() {
                return;
            }
        }
    };
    tokio::select! {
        () = reads => {}
        () = writes => {}
    }
    sender.send(Incoming::Disconnected(peer)).await.ok();
}
