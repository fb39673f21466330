//! The firmware: boot, command line, MSP, control loops, and its pages.

mod boot;
mod cli_docs;
mod cli_files;
mod control_support;
mod docs;
mod estimate;
mod hold;
mod msp_requests;
mod msp_server;
mod states;
mod stick_flight;
mod uploads;
