//! Functions over the state of the screen: the effects of keys, clock and session, and values derived from it.

pub(in crate::ui) mod arming_hint;
pub(in crate::ui) mod availability;
pub(in crate::ui) mod diff;
pub(in crate::ui) mod estimate_basis;
pub(in crate::ui) mod estimate_line;
pub(in crate::ui) mod findings;
pub(in crate::ui) mod forecasts;
pub(in crate::ui) mod ghost_path;
pub(in crate::ui) mod ground_under;
pub(in crate::ui) mod intent;
pub(in crate::ui) mod map_edit;
pub(in crate::ui) mod named_layouts;
pub(in crate::ui) mod named_signal;
pub(in crate::ui) mod origin;
pub(in crate::ui) mod past_flight;
pub(in crate::ui) mod plan_edits;
pub mod screen_layout;
pub(in crate::ui) mod setting_changes;
pub(in crate::ui) mod setting_list;
pub(in crate::ui) mod setting_reading;
pub(in crate::ui) mod settings_in_force;
pub mod status_message;
pub(in crate::ui) mod stick_keys;
pub(in crate::ui) mod surveys;
pub(in crate::ui) mod transmitter;
pub(in crate::ui) mod viewport;
pub(in crate::ui) mod zones;
