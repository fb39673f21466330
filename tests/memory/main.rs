//! The memory that hostile input can cause.

#![allow(unsafe_code, reason = "an allocator that measures cannot be written without it")]

mod cli;
mod inputs;
mod logs;
mod meter;
