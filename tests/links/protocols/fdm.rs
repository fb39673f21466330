//! The link to an external simulator, in simulated wall time, without sockets.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

mod hostile;
mod lossy;
mod plugin;
mod sensors;
mod stalls;
mod timing;

use crate::protocols::at_rest::at_rest;
use betadeck::link::conventions::Dialect;
use betadeck::link::proto::fdm::{GZ_PLUGIN_SIZE, State};
use betadeck::link::proto::fdm_link::{FdmLink, FdmLinkConfig};

const MS: u64 = 1000;

fn bytes(dialect: Dialect, state: &State) -> Vec<u8> {
    let mut bytes = dialect.encode(state).to_bytes().to_vec();
    if dialect == Dialect::GzPlugin {
        bytes.resize(GZ_PLUGIN_SIZE, 0xff);
    }
    bytes
}

fn packet(stamp_s: f64) -> Vec<u8> {
    bytes(Dialect::SitlGz, &at_rest(stamp_s))
}

/// Returns a link after `count` packets, one per millisecond, and the time after them.
fn flowing(config: FdmLinkConfig, dialect: Dialect, count: u64) -> (FdmLink, u64) {
    let mut link = FdmLink::new(config, 0);
    for ms in 0..count {
        link.receive(&bytes(dialect, &at_rest(ms as f64 * 1e-3)), ms * MS);
    }
    (link, count * MS)
}

fn default_flow(count: u64) -> (FdmLink, u64) {
    flowing(FdmLinkConfig::default(), Dialect::SitlGz, count)
}

/// A small generator, so that the losses are the same in every run.
struct SeededChance(u64);

impl SeededChance {
    fn happens(&mut self, probability: f64) -> bool {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 33) as f64 / f64::from(1_u32 << 31)) < probability
    }
}
