//! A stand-in for the public executable.

pub(crate) mod packet;
pub(crate) mod receiver;
