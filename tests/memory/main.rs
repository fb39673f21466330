//! The memory that hostile input can cause, and ticks that allocate nothing.

#![allow(unsafe_code, reason = "an allocator that measures cannot be written without it")]

mod input;
mod meter;
mod ticks;
