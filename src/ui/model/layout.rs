//! The arrangement of the panels: their sizes, their places, and the layouts with names.

mod arrangement;
pub(in crate::ui) mod named;
mod saved;
mod slots;

pub(crate) use arrangement::Arrangement;
pub(in crate::ui) use arrangement::Split;
pub use saved::SavedLayouts;
pub(crate) use slots::Slots;
