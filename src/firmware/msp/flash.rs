//! The flash memory for logs.

use super::{Call, MspAction, Refused};
use crate::firmware::blackbox::{FLASH_BYTES, FLASH_SECTORS};
use crate::msp::Writer;

/// The flags of the summary.
const READY: i64 = 1;
const SUPPORTED: i64 = 2;
/// The most bytes of a reply.
const MAX_BYTES: u16 = 4096;
/// The bytes of a request that names no number.
const USUAL_BYTES: u16 = 128;
/// The data are as they are in the memory.
const UNCOMPRESSED: i64 = 0;

/// Reports the memory; zeros without one.
pub(super) fn summary(call: &mut Call<'_>) {
    let flash = call.facts.flash;
    if !flash.is_present {
        return call.reply.zeros(13);
    }
    call.reply.u8(READY | SUPPORTED);
    for number in [FLASH_SECTORS, FLASH_BYTES, flash.used] {
        call.reply.u32(number as u32);
    }
}

/// Passes the address and the number of bytes on to the owner of the memory. Compression is allowed by the request, and
/// not used.
pub(super) fn read(call: &mut Call<'_>) -> Result<(), Refused> {
    if !call.facts.flash.is_present {
        return Err(Refused);
    }
    let address = call.request.u32();
    let length = if call.request.remaining() == 0 { USUAL_BYTES } else { call.request.u16() };
    call.action = Some(MspAction::ReadFlash { address, length: length.min(MAX_BYTES) });
    Ok(())
}

/// Returns the reply to a request for these bytes at an address.
#[doc(hidden)]
pub fn flash_reply(address: u32, bytes: &[u8]) -> Vec<u8> {
    let mut reply = Writer::default();
    reply.u32(address);
    reply.u16(bytes.len() as u32);
    reply.u8(UNCOMPRESSED);
    reply.bytes(bytes);
    reply.into_bytes()
}

/// Erases the memory, but not in flight, because it holds the log of the flight.
pub(super) fn erase(call: &mut Call<'_>) -> Result<(), Refused> {
    if !call.facts.flash.is_present || call.facts.armed {
        return Err(Refused);
    }
    call.action = Some(MspAction::EraseFlash);
    Ok(())
}
