//! Flights without a screen: one, the scenarios of files, the many flights of a campaign, two firmwares on one plan.
//!
//! `setup` makes the start of a flight from the options, `report` what the pages and lines about a flight have in common.
//! One file a command: `fly`, `check`, `campaign` and `compare`, with its parts in the folder of its name.

pub(crate) mod campaign;
pub(crate) mod check;
pub(crate) mod compare;
pub(crate) mod fly;
pub(crate) mod lab;
pub(crate) mod report;
pub(crate) mod rescue;
pub(crate) mod scenario_folder;
pub(crate) mod setup;
