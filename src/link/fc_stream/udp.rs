//! Datagrams from craft that speak MAVLink.

use std::net::SocketAddr;

use tokio::net::UdpSocket;
use tokio::sync::mpsc;

use super::{Ended, StreamEvent, reason};
use crate::mavlink::frame::is_start;

/// The senders that get answers. A craft may send from several ports, and is answered at each.
const MAX_PEERS: usize = 8;
/// The greatest length of a datagram, bytes.
const MAX_DATAGRAM: usize = 65_536;

/// Opens the port.
pub(super) async fn bind(address: SocketAddr) -> Result<UdpSocket, String> {
    UdpSocket::bind(address).await.map_err(|error| format!("cannot listen at {address}: {}", reason(&error)))
}

/// Moves datagrams until the session no longer needs them. Those that do not begin with a frame are dropped: a web page can
/// send datagrams of other protocols to any port.
pub(super) async fn pump(
    socket: &UdpSocket,
    to: &mut mpsc::Receiver<Vec<u8>>,
    from: &mpsc::Sender<StreamEvent>,
) -> Ended {
    let mut datagram = vec![0; MAX_DATAGRAM];
    let mut peers: Vec<SocketAddr> = Vec::new();
    loop {
        tokio::select! {
            received = socket.recv_from(&mut datagram) => {
                // A peer that no longer listens is reported as an error of a later call.
                let Ok((length, peer)) = received else { continue };
                let bytes = datagram.get(..length).unwrap_or_default();
                if !bytes.first().is_some_and(|first| is_start(*first)) {
                    continue;
                }
                if !peers.contains(&peer) {
                    peers.truncate(MAX_PEERS - 1);
                    peers.insert(0, peer);
                }
                if from.send(StreamEvent::Bytes(bytes.to_vec())).await.is_err() {
                    return Ended::Dropped;
                }
            }
            bytes = to.recv() => {
                let Some(bytes) = bytes else { return Ended::Dropped };
                for peer in &peers {
                    // A datagram may be lost on its way, too.
                    drop(socket.send_to(&bytes, peer).await);
                }
            }
            () = from.closed() => return Ended::Dropped,
        }
    }
}
