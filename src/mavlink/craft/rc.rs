//! Sticks and channels that a ground station sends.

use super::super::message::{ManualControl, RcChannelsOverride};

/// A channel of an override.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ChannelOverride {
    /// The channel stays as it is.
    #[default]
    Keep,
    /// The channel is the transmitter's again.
    Release,
    /// The channel has this value, µs.
    Set(u16),
}

/// Sticks or channels from a ground station.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum RcInput {
    /// Channels to override.
    Override([ChannelOverride; 18]),
    /// Sticks, each −1…1, and `None` if the ground station has none; buttons, one bit each.
    Manual {
        /// Pitch: forward is positive.
        pitch: Option<f64>,
        /// Roll: right is positive.
        roll: Option<f64>,
        /// Throttle, 0…1.
        throttle: Option<f64>,
        /// Yaw: clockwise is positive.
        yaw: Option<f64>,
        /// Buttons.
        buttons: u16,
    },
}

impl RcInput {
    pub(super) fn from_override(message: &RcChannelsOverride) -> Self {
        let first = message.chan_raw.0.map(|value| match value {
            0 => ChannelOverride::Release,
            u16::MAX => ChannelOverride::Keep,
            value => ChannelOverride::Set(value),
        });
        // The later channels are extension fields, which are 0 if they were not sent.
        let later = message.chan9_to_18_raw.map(|value| match value {
            0 | u16::MAX => ChannelOverride::Keep,
            0xfffe => ChannelOverride::Release,
            value => ChannelOverride::Set(value),
        });
        let mut channels = [ChannelOverride::Keep; 18];
        for (channel, value) in channels.iter_mut().zip(first.into_iter().chain(later)) {
            *channel = value;
        }
        Self::Override(channels)
    }

    pub(super) fn from_manual(message: &ManualControl) -> Self {
        let stick = |value: i16, least: f64| {
            (value != i16::MAX).then(|| (f64::from(value) / 1000.0).clamp(least, 1.0))
        };
        Self::Manual {
            pitch: stick(message.x, -1.0),
            roll: stick(message.y, -1.0),
            throttle: stick(message.z, 0.0),
            yaw: stick(message.r, -1.0),
            buttons: message.buttons,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::wire::Series;
    use super::*;

    #[test]
    fn an_override_sets_releases_and_keeps_channels() {
        let mut message =
            RcChannelsOverride { chan_raw: Series([1500, 0, 65535, 1, 2, 3, 4, 5]), ..Default::default() };
        message.chan9_to_18_raw[1] = 1900;
        message.chan9_to_18_raw[2] = 65534;
        let RcInput::Override(channels) = RcInput::from_override(&message) else { panic!() };
        assert_eq!(
            channels[..3],
            [ChannelOverride::Set(1500), ChannelOverride::Release, ChannelOverride::Keep]
        );
        assert_eq!(
            channels[8..11],
            [ChannelOverride::Keep, ChannelOverride::Set(1900), ChannelOverride::Release]
        );
    }

    #[test]
    fn sticks_are_limited() {
        let message =
            ManualControl { x: 500, y: -2000, z: -5, r: i16::MAX, buttons: 3, ..Default::default() };
        let expected = RcInput::Manual {
            pitch: Some(0.5),
            roll: Some(-1.0),
            throttle: Some(0.0),
            yaw: None,
            buttons: 3,
        };
        assert_eq!(RcInput::from_manual(&message), expected);
    }
}
