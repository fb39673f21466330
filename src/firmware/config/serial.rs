//! Serial ports.

/// The speeds that a port row accepts; 0 = automatic.
pub const BAUD_RATES: &[u32] = &[
    0, 9600, 19200, 38400, 57600, 115_200, 230_400, 250_000, 400_000, 460_800, 500_000, 921_600, 1_000_000,
    1_500_000, 2_000_000, 2_470_000,
];

/// The functions and speeds of one port. It does not include the MSP function, which the settings `msp_uart_*` control.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct SerialRow {
    /// The bits of the functions other than MSP (bit 0).
    pub functions: u32,
    /// The speed of MSP, baud.
    pub msp_baud: u32,
    /// The speed of GPS, baud.
    pub gps_baud: u32,
    /// The speed of telemetry, baud; 0 = automatic.
    pub telemetry_baud: u32,
    /// The speed of the flight recorder, baud.
    pub blackbox_baud: u32,
}

impl Default for SerialRow {
    fn default() -> Self {
        Self { functions: 0, msp_baud: 115_200, gps_baud: 57_600, telemetry_baud: 0, blackbox_baud: 115_200 }
    }
}
