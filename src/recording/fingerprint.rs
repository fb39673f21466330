//! Numbers that are equal for two flights that are the same to the last bit.

use crate::signals::SimTime;
use crate::vehicle::Vehicle;

/// The number of an instant: it depends on every bit of the true state of the craft and its motor commands.
pub type Fingerprint = u32;

const OFFSET: u64 = 0xcbf2_9ce4_8422_2325;
const PRIME: u64 = 0x0100_0000_01b3;

/// Adds eight bytes to a hash (FNV-1a, eight bytes at a time).
fn mixed(hash: u64, bits: u64) -> u64 {
    let hash = (hash ^ bits).wrapping_mul(PRIME);
    hash ^ (hash >> 29)
}

/// Returns the number of the present instant; `None` if an external simulator moves the craft.
pub(super) fn of(vehicle: &Vehicle) -> Option<Fingerprint> {
    let truth = vehicle.truth()?;
    let vectors = [&truth.pos_enu, &truth.vel_enu, &truth.rate_flu, &truth.wind_enu];
    let numbers = vectors.into_iter().flat_map(|vector| vector.iter().copied());
    let numbers = numbers.chain(truth.attitude.coords.iter().copied()).chain(truth.rotor_speeds);
    let numbers = numbers.chain(truth.motor_command).chain([truth.battery.drawn_mah]);
    let hash = numbers.fold(mixed(OFFSET, truth.time.0), |hash, number| mixed(hash, number.to_bits()));
    Some((hash ^ (hash >> 32)) as u32)
}

/// The hash of a flight, made from the numbers of its pictures.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FlightPrint(u64);

impl Default for FlightPrint {
    fn default() -> Self {
        Self(OFFSET)
    }
}

impl FlightPrint {
    /// Adds the number of the next picture.
    pub fn add(&mut self, time: SimTime, print: Fingerprint) {
        self.0 = mixed(mixed(self.0, time.0), u64::from(print));
    }

    /// Returns the hash as text.
    pub fn text(self) -> String {
        format!("{:016x}", self.0)
    }
}
