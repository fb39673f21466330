//! What the craft remembers: settings, modes, features, mixer, receiver set-up, flight plan, and the lines of other
//! builds that it keeps.
//!
//! Plain data. The command line, MSP and the stored image read and write it; the running firmware takes what it needs
//! from it at boot and again after every command line and every message that may have changed it.

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

pub const MODE_CONDITIONS: usize = 20;
pub const ADJUSTMENT_RANGES: usize = 30;
/// Channels with a range: the four sticks.
pub const RX_RANGES: usize = 4;
/// Channels with a loss rule.
pub const RX_FAIL_CHANNELS: usize = 18;
/// Serial ports of the vehicle.
pub const SERIAL_PORTS: usize = 8;
/// Most characters of the board name.
pub const BOARD_NAME_MAX: usize = 20;
/// Most characters of the manufacturer id.
pub const MANUFACTURER_ID_MAX: usize = 4;

/// Everything that `save` stores.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Configuration {
    /// The settings, with the active profiles.
    pub settings: Settings,
    /// Feature switches; they take effect at boot.
    pub features: Features,
    /// The airframe type; it takes effect at boot.
    pub mixer: MixerKind,
    /// Rows of the custom mix, up to the first with zero throttle.
    pub custom_mix: [MixRow; MAX_MIX_ROWS],
    /// Order of the stick channels on the wire.
    pub channel_map: ChannelMap,
    /// Which switch turns which mode on.
    pub modes: [ModeCondition; MODE_CONDITIONS],
    /// In-flight adjustments; kept, not executed.
    pub adjustments: [AdjustmentRange; ADJUSTMENT_RANGES],
    /// Pulse ranges of the stick channels.
    pub rx_ranges: [RxRange; RX_RANGES],
    /// What a channel does after the link is lost.
    pub rx_fail: RxFailTable,
    /// Functions and speeds of the serial ports UART1 … UART8.
    pub serial: SerialTable,
    /// The stored flight plan.
    pub plan: FlightPlan,
    /// Name of the board, as a real craft's configuration carries it.
    pub board_name: String,
    /// Manufacturer of the board.
    pub manufacturer_id: String,
    /// Lines of other builds, kept for the next dump.
    pub kept: KeptLines,
    /// Records of the stored image that this version does not know; they are stored again as they were.
    pub unknown_records: Vec<String>,
}

/// Loss rules of all channels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RxFailTable(pub [RxFail; RX_FAIL_CHANNELS]);

impl Default for RxFailTable {
    fn default() -> Self {
        Self(std::array::from_fn(RxFail::default_for))
    }
}

/// Rows of all serial ports; the index is the number of the UART minus one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SerialTable(pub [SerialRow; SERIAL_PORTS]);

impl Default for SerialTable {
    fn default() -> Self {
        Self([SerialRow::default(); SERIAL_PORTS])
    }
}

impl Configuration {
    /// Returns everything to a fresh vehicle, so that readers of the settings notice.
    pub fn reset(&mut self) {
        let mut settings = std::mem::take(&mut self.settings);
        settings.reset();
        *self = Self { settings, ..Self::default() };
    }

    /// What the user is told of a craft that got the starter modes.
    pub const STARTER_MODES_NOTICE: &str = "The craft had no modes: ARM is on AUX1, AUTOPILOT on AUX2, ANGLE, ALTHOLD \
         and POS HOLD on AUX3, each above 1700 µs; the CLI command save keeps them.";

    /// Gives a craft without any mode condition the modes a pilot of the simulator needs: ARM on AUX1, AUTOPILOT on
    /// AUX2; ANGLE, ALTHOLD and POS HOLD on AUX3, each above 1700 µs. Says whether it changed anything.
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
