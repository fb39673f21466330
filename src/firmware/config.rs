//! The stored configuration: settings, modes, features, mixer, receiver set-up, flight plan, and the lines of other
//! builds that are kept.
//!
//! It is plain data. The command line, MSP and the stored image read and write it. The running firmware reads it at
//! boot, and again after every command line and every message that may have changed it.

use crate::plan::FlightPlan;

use super::modes::boxes;
use super::settings::Settings;

mod feature;
mod kept;
mod mixer;
mod mode;
mod receiver;
mod sanity;
mod serial;

pub use feature::{Feature, Features};
pub use kept::{KeptLine, KeptLines};
pub use mixer::{MAX_MIX_ROWS, MixRow, MixerKind};
pub use mode::{AdjustmentRange, ModeCondition, ModeLogic};
pub use receiver::{ChannelMap, RxFail, RxFailMode, RxRange};
pub use sanity::correct;
pub use serial::{BAUD_RATES, SerialRow};

/// The number of mode conditions.
pub const MODE_CONDITIONS: usize = 20;
/// The number of adjustment ranges.
pub const ADJUSTMENT_RANGES: usize = 30;
/// The number of channels with a range: the four sticks.
pub const RX_RANGES: usize = 4;
/// The number of channels with a loss rule.
pub const RX_FAIL_CHANNELS: usize = 18;
/// The number of serial ports.
pub const SERIAL_PORTS: usize = 8;
/// The maximum length of the board name, characters.
pub const BOARD_NAME_MAX: usize = 20;
/// The maximum length of the manufacturer id, characters.
pub const MANUFACTURER_ID_MAX: usize = 4;

/// Everything that `save` stores.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Configuration {
    /// The settings, with the active profiles.
    pub settings: Settings,
    /// The feature switches. They take effect at boot.
    pub features: Features,
    /// The airframe type. It takes effect at boot.
    pub mixer: MixerKind,
    /// The rows of the custom mix, up to the first with zero throttle.
    pub custom_mix: [MixRow; MAX_MIX_ROWS],
    /// The order of the stick channels on the wire.
    pub channel_map: ChannelMap,
    /// The mode conditions: the switches that turn modes on.
    pub modes: [ModeCondition; MODE_CONDITIONS],
    /// The in-flight adjustments. They are kept, not executed.
    pub adjustments: [AdjustmentRange; ADJUSTMENT_RANGES],
    /// The pulse ranges of the stick channels.
    pub rx_ranges: [RxRange; RX_RANGES],
    /// The behaviour of each channel after the link is lost.
    pub rx_fail: RxFailTable,
    /// The functions and speeds of the serial ports UART1 … UART8.
    pub serial: SerialTable,
    /// The stored flight plan.
    pub plan: FlightPlan,
    /// The name of the board, as in a real craft's configuration.
    pub board_name: String,
    /// The manufacturer of the board.
    pub manufacturer_id: String,
    /// The lines of other builds, kept for the next dump.
    pub kept: KeptLines,
    /// The records of the stored image that this version does not know. They are stored again unchanged.
    pub unknown_records: Vec<String>,
}

/// The loss rules of all channels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RxFailTable(pub [RxFail; RX_FAIL_CHANNELS]);

impl Default for RxFailTable {
    fn default() -> Self {
        Self(std::array::from_fn(RxFail::default_for))
    }
}

/// The rows of all serial ports; the index is the number of the UART minus one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SerialTable(pub [SerialRow; SERIAL_PORTS]);

impl Default for SerialTable {
    fn default() -> Self {
        Self([SerialRow::default(); SERIAL_PORTS])
    }
}

impl Configuration {
    /// Resets everything to a fresh vehicle, and lets readers of the settings notice it.
    pub fn reset(&mut self) {
        let mut settings = std::mem::take(&mut self.settings);
        settings.reset();
        *self = Self { settings, ..Self::default() };
    }

    /// The notice for a craft that got the starter modes.
    pub const STARTER_MODES_NOTICE: &str = "The craft had no modes: ARM is on AUX1, AUTOPILOT on AUX2, ANGLE, ALTHOLD \
         and POS HOLD on AUX3, each above 1700 µs; the CLI command save keeps them.";

    /// Gives a craft without any mode condition the modes that a pilot of the simulator needs: ARM on AUX1; AUTOPILOT
    /// on AUX2; ANGLE, ALTHOLD and POS HOLD on AUX3; each above 1700 µs. Returns `true` if it changed anything.
    pub fn starter_modes(&mut self) -> bool {
        if self.modes.iter().any(|condition| *condition != ModeCondition::default()) {
            return false;
        }
        let starters = [
            (boxes::ARM, 0),
            (boxes::AUTOPILOT, 1),
            (boxes::ANGLE, 2),
            (boxes::ALTHOLD, 2),
            (boxes::POS_HOLD, 2),
        ];
        for (slot, (box_id, aux_channel)) in self.modes.iter_mut().zip(starters) {
            *slot = ModeCondition {
                box_id,
                aux_channel,
                start_us: 1700,
                end_us: 2100,
                ..ModeCondition::default()
            };
        }
        true
    }
}
