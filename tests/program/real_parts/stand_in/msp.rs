//! The MSP of the stand-in: takes frames of both versions and answers each once.

/// A request with the version of its frame.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct Request {
    pub(crate) version: u8,
    pub(crate) code: u16,
    pub(crate) payload: Vec<u8>,
}

/// The first item in the received bytes.
#[derive(Debug, PartialEq, Eq)]
pub(crate) enum Front {
    /// A whole request, and its size in bytes.
    Request(Request, usize),
    /// A request that is not complete yet.
    Partial,
    /// A damaged frame, and the number of bytes to drop.
    Damaged(usize),
}

/// Reads the first item of bytes that begin with `$`.
pub(crate) fn front(bytes: &[u8]) -> Front {
    let (head, size, code) = match *bytes {
        [_, b'M', b'<', size, code, ..] => (5, usize::from(size), u16::from(code)),
        [_, b'X', b'<', _, low, high, small, large, ..] => {
            (8, usize::from(u16::from_le_bytes([small, large])), u16::from_le_bytes([low, high]))
        }
        [_, b'M' | b'X', b'<', ..] | [_, b'M' | b'X'] | [_] => return Front::Partial,
        _ => return Front::Damaged(1),
    };
    let Some(frame) = bytes.get(..=head + size) else { return Front::Partial };
    let version = if head == 5 { 1 } else { 2 };
    if sum(version, &frame[3..head + size]) != frame[head + size] {
        return Front::Damaged(frame.len());
    }
    let payload = frame[head..head + size].to_vec();
    Front::Request(Request { version, code, payload }, frame.len())
}

/// Encodes an answer. A payload of `None` is a refusal.
pub(crate) fn answer(request: &Request, payload: Option<&[u8]>) -> Vec<u8> {
    let (kind, payload) = payload.map_or((b'!', &[][..]), |payload| (b'>', payload));
    let size = payload.len() as u16;
    let mut frame = if request.version == 2 {
        [&[b'$', b'X', kind, 0], &request.code.to_le_bytes()[..], &size.to_le_bytes()].concat()
    } else if size < 255 {
        vec![b'$', b'M', kind, size as u8, request.code as u8]
    } else {
        [&[b'$', b'M', kind, 255, request.code as u8][..], &size.to_le_bytes()].concat()
    };
    frame.extend(payload);
    frame.push(sum(request.version, &frame[3..]));
    frame
}

fn sum(version: u8, bytes: &[u8]) -> u8 {
    if version == 1 {
        return bytes.iter().fold(0, |sum, byte| sum ^ byte);
    }
    bytes.iter().fold(0, |sum, byte| {
        (0..8).fold(sum ^ byte, |sum, _| if sum & 0x80 == 0 { sum << 1 } else { (sum << 1) ^ 0xd5 })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn captured_exchanges() {
        let version_1 = b"$M<\x00\x01\x01";
        let Front::Request(request, 6) = front(version_1) else { panic!() };
        assert_eq!(answer(&request, Some(&[0, 1, 49])), b"$M>\x03\x01\x00\x01\x31\x32");
        let version_2 = b"$X<\x00\x01\x00\x00\x00\x45";
        let Front::Request(request, 9) = front(version_2) else { panic!() };
        assert_eq!(answer(&request, Some(&[0, 1, 49])), b"$X>\x00\x01\x00\x03\x00\x00\x01\x31\xb3");
        assert_eq!(front(b"$M<\x00\x01\x55"), Front::Damaged(6));
        assert_eq!(front(b"$M<\x05\x01\x55"), Front::Partial);
    }
}
