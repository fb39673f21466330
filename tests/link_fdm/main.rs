//! The link to an external simulator, in simulated wall time, without sockets.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

mod hostile;
mod lossy;
mod sensors;
mod timing;

use betadeck::link::proto::fdm::{GZ_PLUGIN_SIZE, State, pressure_pa};
use betadeck::link::proto::fdm_link::{FdmLink, FdmLinkConfig};
use betadeck::signals::fdm::Dialect;
use nalgebra::{UnitQuaternion, Vector3};

const MS: u64 = 1000;

/// A craft at rest, level, facing north.
fn at_rest(stamp_s: f64) -> State {
    State {
        stamp_s,
        rate_flu: Vector3::zeros(),
        specific_force_flu: Vector3::new(0.0, 0.0, betadeck::geo::GRAVITY),
        attitude: UnitQuaternion::from_axis_angle(&Vector3::z_axis(), std::f64::consts::FRAC_PI_2),
        vel_enu: Vector3::zeros(),
        lon_deg: -79.51825,
        lat_deg: 40.4635,
        alt_m: 0.0,
        pressure_pa: pressure_pa(0.0),
    }
}

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

/// A link with `count` packets behind it, one a millisecond, and the time after them.
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
