//! A serial stream over a pseudo-terminal pair in place of a serial cable.

use crate::protocols::fc_streams::{PATIENCE, bytes, connected, lost, open, send};
use test_support::Cable;

/// Returns the bytes that come out of the cable, at least as many as expected.
async fn received(cable: &mut Cable, count: usize) -> Vec<u8> {
    let mut all = Vec::new();
    let wait = async {
        while all.len() < count {
            all.extend(cable.received());
            tokio::time::sleep(std::time::Duration::from_millis(1)).await;
        }
    };
    tokio::time::timeout(PATIENCE, wait).await.expect("bytes");
    all
}

/// The bytes that a terminal would change if it were not raw: line ends, control characters, bytes above 127.
const ANY: &[u8] = b"\r\n\x03\x04\x11\x13\x1a\x7f\x00\xff$M<";

#[tokio::test]
async fn every_byte_goes_through_unchanged_and_a_cable_that_was_pulled_comes_back() {
    let mut cable = Cable::unplugged();
    cable.plug_in();
    let place = format!("serial:{},57600", cable.device().display());
    let mut stream = open(&place);
    assert_eq!((stream.place.as_str(), stream.bytes_per_s), (place.as_str(), Some(5760)));
    for _ in 0..2 {
        connected(&mut stream).await;
        send(&stream, ANY).await;
        assert_eq!(received(&mut cable, ANY.len()).await, ANY);
        assert!(cable.send(ANY).is_empty());
        assert_eq!(bytes(&mut stream, ANY.len()).await, ANY);
        cable.pull();
        assert_eq!(lost(&mut stream).await, "it was unplugged");
        let reason = lost(&mut stream).await;
        assert!(reason.starts_with(&format!("there is no {}: plug", cable.device().display())), "{reason}");
        cable.plug_in();
    }
}
