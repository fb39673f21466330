//! The memory that hostile input can cause.

mod cli;
mod inputs;
mod logs;
