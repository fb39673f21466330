//! The link with a flood from the other end.

use tokio::sync::mpsc;

use super::*;

#[test]
#[allow(clippy::disallowed_methods, reason = "an instant to count from")]
fn a_peer_that_floods_is_read_a_part_at_a_time() {
    let ((to, _sent), (pieces, from)) = (mpsc::channel(1), mpsc::channel(MAX_READ));
    while pieces.try_send(StreamEvent::Bytes(vec![b'$'; 4096])).is_ok() {}
    let stream = FcStream { to, from, place: "tcp:here:1".to_owned(), bytes_per_s: None };
    let ends = RemoteEnds { name: "the board".to_owned(), stream, peer: None, child: None };
    let mut vehicle = Vehicle::elsewhere().unwrap();
    let now = Instant::now();
    let mut link = RemoteLink::new(ends, now);
    link.exchange(&mut vehicle, None, now);
    assert_eq!(pieces.capacity(), 2, "pieces read");
    link.exchange(&mut vehicle, None, now);
    assert_eq!(pieces.capacity(), 4, "pieces read");
}
