//! The battery.

use super::wire::{Reader, Writer, steps};

/// The state of a battery. The discriminant is the code on the wire.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, strum::FromRepr, strum::IntoStaticStr)]
#[strum(serialize_all = "SCREAMING_SNAKE_CASE")]
#[repr(u8)]
pub enum BatteryState {
    Ok = 0,
    /// Below the warning voltage.
    Warning = 1,
    /// Below the lowest voltage.
    Critical = 2,
    #[strum(to_string = "NOT PRESENT")]
    NotPresent = 3,
    /// Not measured yet.
    #[default]
    Init = 4,
}

/// `BATTERY_STATE`.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct BatteryReading {
    /// The number of cells in series, once counted.
    pub cells: Option<u8>,
    /// The capacity that is set, mAh.
    pub capacity_mah: u16,
    /// Voltage, V.
    pub voltage_v: f64,
    /// Charge drawn, mAh.
    pub drawn_mah: f64,
    /// Current, A.
    pub current_a: f64,
    /// The state, if it is a known one.
    pub state: Option<BatteryState>,
}

impl BatteryReading {
    pub fn decode(payload: &[u8]) -> Option<Self> {
        let mut reader = Reader::new(payload);
        let cells = Some(reader.u8()?).filter(|cells| *cells > 0);
        let capacity_mah = reader.u16()?;
        let coarse_v = f64::from(reader.u8()?) / 10.0;
        let drawn_mah = f64::from(reader.u16()?);
        let current_a = f64::from(reader.i16()?) / 100.0;
        let state = reader.u8().and_then(BatteryState::from_repr);
        let voltage_v = reader.u16().map_or(coarse_v, |fine| f64::from(fine) / 100.0);
        Some(Self { cells, capacity_mah, voltage_v, drawn_mah, current_a, state })
    }

    pub fn encode(&self, writer: &mut Writer) {
        writer.u8(self.cells.unwrap_or_default());
        writer.u16(self.capacity_mah);
        writer.u8(steps(self.voltage_v, 10.0));
        writer.u16(steps(self.drawn_mah, 1.0));
        writer.i16(steps(self.current_a, 100.0));
        writer.u8(self.state.unwrap_or(BatteryState::NotPresent) as u8);
        writer.u16(steps(self.voltage_v, 100.0));
    }

    /// Returns `true` if there is a battery: its cells were counted, or it has a voltage.
    pub fn is_present(&self) -> bool {
        self.state != Some(BatteryState::NotPresent) && (self.cells.is_some() || self.voltage_v > 0.0)
    }
}
