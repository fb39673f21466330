//! Channel order, pulse ranges, and the behaviour of channels after the link is lost.

/// The letters of the map in the order of the internal channels.
const LETTERS: [u8; 8] = *b"AERT1234";

/// The lowest pulse of a loss rule, µs.
const FAIL_LOWEST_US: i64 = 750;
/// The highest pulse of a loss rule, µs.
const FAIL_HIGHEST_US: i64 = 2250;
/// The pulse step of a loss rule, µs.
const FAIL_STEP_US: i64 = 25;

/// The order of the stick and first switch channels on the wire. Entry i is the wire channel that carries the i-th of
/// roll, pitch, yaw, throttle, AUX1, AUX2, AUX3, AUX4.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct ChannelMap(pub [u8; 8]);

impl Default for ChannelMap {
    /// Returns AETR1234.
    fn default() -> Self {
        Self([0, 1, 3, 2, 4, 5, 6, 7])
    }
}

impl ChannelMap {
    /// Parses a permutation of `AERT1234`, in any case.
    pub fn parse(text: &str) -> Option<Self> {
        let text = text.to_ascii_uppercase();
        let place =
            |letter: u8| text.bytes().position(|found| found == letter).and_then(|at| u8::try_from(at).ok());
        let mut map = [0; 8];
        for (wire, letter) in map.iter_mut().zip(LETTERS) {
            *wire = place(letter)?;
        }
        (text.len() == LETTERS.len()).then_some(Self(map))
    }
}

impl std::fmt::Display for ChannelMap {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let mut wire = [b'?'; 8];
        for (letter, at) in LETTERS.into_iter().zip(self.0) {
            if let Some(place) = wire.get_mut(usize::from(at)) {
                *place = letter;
            }
        }
        wire.iter().try_for_each(|letter| write!(f, "{}", char::from(*letter)))
    }
}

/// The pulse range of a stick channel. It is stretched to 1000…2000 µs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct RxRange {
    /// The pulse that becomes 1000 µs.
    pub min_us: u16,
    /// The pulse that becomes 2000 µs.
    pub max_us: u16,
}

impl Default for RxRange {
    fn default() -> Self {
        Self { min_us: 1000, max_us: 2000 }
    }
}

/// The behaviour of a channel after the link is lost. The discriminant is the code on the wire.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, strum::FromRepr)]
#[repr(u8)]
pub enum RxFailMode {
    /// Sticks to the centre, throttle to the bottom. Only for the four stick channels.
    Auto = 0,
    /// The last value, for ever.
    Hold = 1,
    /// The channel takes a fixed value.
    Set = 2,
}

impl RxFailMode {
    /// Returns the letter used on the command line.
    pub const fn letter(self) -> char {
        match self {
            Self::Auto => 'a',
            Self::Hold => 'h',
            Self::Set => 's',
        }
    }
}

/// The loss rule of one channel.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct RxFail {
    /// The behaviour of the channel while the link is lost.
    pub mode: RxFailMode,
    /// The value of mode [`RxFailMode::Set`], µs; 1500 otherwise.
    pub value_us: u16,
}

impl RxFail {
    /// Returns the rule of a fresh vehicle: sticks automatic, other channels held.
    pub fn default_for(channel: usize) -> Self {
        Self::without_value(if channel < 4 { RxFailMode::Auto } else { RxFailMode::Hold })
    }

    /// Creates a rule that needs no value.
    pub const fn without_value(mode: RxFailMode) -> Self {
        Self { mode, value_us: 1500 }
    }

    /// Creates a rule with a value, limited and rounded down to the step in which values are stored.
    pub fn set_to(pulse_us: i64) -> Self {
        let clipped = pulse_us.clamp(FAIL_LOWEST_US, FAIL_HIGHEST_US);
        let snapped = clipped - (clipped - FAIL_LOWEST_US) % FAIL_STEP_US;
        Self { mode: RxFailMode::Set, value_us: snapped as u16 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_map_is_read_and_printed_the_same() {
        for order in ["AETR1234", "TAER1234", "1234RETA", "RETA4321"] {
            assert_eq!(ChannelMap::parse(order).map(|map| map.to_string()), Some(order.to_owned()));
        }
        assert_eq!(ChannelMap::parse("aetr1234"), Some(ChannelMap::default()));
        // Throttle is first on the wire: internal roll is wire channel 1, internal throttle is wire channel 0.
        assert_eq!(ChannelMap::parse("TAER1234"), Some(ChannelMap([1, 2, 3, 0, 4, 5, 6, 7])));
        for wrong in ["", "AETR", "AAAA1234", "AETR12345", "AETR123Ä"] {
            assert_eq!(ChannelMap::parse(wrong), None, "{wrong}");
        }
    }

    #[test]
    fn loss_values_are_stored_in_steps() {
        let stored = |pulse| RxFail::set_to(pulse).value_us;
        assert_eq!([stored(i64::MIN), stored(1012), stored(1025), stored(99_999)], [750, 1000, 1025, 2250]);
    }
}
