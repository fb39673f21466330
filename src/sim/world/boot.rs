//! A world at boot: the checked configuration, a craft on its legs, a full battery.

use std::sync::Arc;

use nalgebra::{UnitQuaternion, Vector2, Vector3};

use crate::geo::LatLon;
use crate::signals::{SensorFrame, SimTime};
use crate::sim::air::Air;
use crate::sim::airframe::{Airframe, ROTORS};
use crate::sim::battery::Battery;
use crate::sim::body::BodyState;
use crate::sim::clock::{Clock, FaultHost as _};
use crate::sim::command::check_wind;
use crate::sim::config::{Home, WorldConfig, step_us};
use crate::sim::error::{WorldError, in_range};
use crate::sim::fault::FaultLink;
use crate::sim::landform::{Landform, LocalRelief};
use crate::sim::plant::Plant;
use crate::sim::sensors::Sensors;
use crate::sim::surface::Surface;
use crate::sim::switches::Switches;
use crate::sim::touchdown::TouchdownDetector;
use crate::sim::truth::{Truth, level_attitude};
use crate::sim::wind::Wind;
use crate::terrain::Relief;

use super::{World, WorldStatus};

impl World {
    /// Returns a world at boot, with the craft on its legs at home.
    ///
    /// # Errors
    /// Fails if a value of the configuration is not allowed.
    pub fn new(config: WorldConfig) -> Result<Self, WorldError> {
        config.check()?;
        let relief = relief(&config);
        Self::build(config, relief)
    }

    /// Returns the same craft at boot at the same place, in the present air with the present switches and without faults.
    /// `change` may change these values before; terrain stays as it is.
    ///
    /// # Errors
    /// Fails if a changed value is not allowed.
    pub fn again(&self, change: impl FnOnce(&mut WorldConfig)) -> Result<Self, WorldError> {
        let frame = self.local_frame();
        let WorldStatus { gust_mps, turbulence, noise, switches, .. } = self.status();
        let mut config = WorldConfig {
            airframe: self.airframe.clone(),
            home: Home {
                lat_deg: frame.lat_deg,
                lon_deg: frame.lon_deg,
                alt_amsl_m: frame.alt_amsl_m,
                heading_deg: self.heading_deg,
            },
            rate_hz: (1_000_000 / self.clock.step_us()) as u32,
            seed: self.clock.seed(),
            noise,
            wind: self.air.wind_that_was_set(),
            gust_mps,
            turbulence,
            switches,
            faults: Vec::new(),
            terrain: None,
        };
        change(&mut config);
        config.check()?;
        let mut world = Self::build(config, self.relief.clone())?;
        world.sensors.gps.set_rate(self.sensors.gps.rate_hz());
        world.air.added = self.air.added;
        Ok(world)
    }

    fn build(config: WorldConfig, relief: Option<LocalRelief>) -> Result<Self, WorldError> {
        let clock = Clock::new(config.rate_hz, config.seed, FaultLink::Embedded, config.faults.clone())?;
        let step_s = clock.step_us() as f64 * 1e-6;
        let heading_deg = config.home.heading_deg;
        let landform = Landform::new(config.switches.ground, relief.as_ref())?;
        let start = standing(&config.airframe, &landform, &Vector2::zeros(), heading_deg);
        let mut plant = Plant::new(&config.airframe, step_s);
        plant.set_landform(landform);
        let air = Air::new(&config, start.pos_enu.z);
        let air_now = air.sample(SimTime::ZERO);
        let craft = plant.at_rest(start);
        let mut sensors = Sensors::new(&config, step_s);
        sensors.settle(start.pos_enu, start.vel_enu);
        let present = plant.present(&craft, &air_now);
        let contact = plant.ground().contact(&start);
        let battery = full_battery(&config.airframe, &config.switches);
        let WorldConfig { airframe, switches, .. } = config;
        let mut world = Self {
            airframe,
            start,
            heading_deg,
            switches,
            relief,
            clock,
            plant,
            craft,
            battery,
            command: [0.0; ROTORS],
            refused_commands: 0,
            contact,
            touchdown: TouchdownDetector::STANDING,
            crashed: false,
            diverged: false,
            air,
            air_now,
            present,
            rate_before: Vector3::zeros(),
            truth: truth_at_boot(&start),
            sensors,
            frame: SensorFrame::default(),
        };
        world.update_battery_truth();
        world.set_ground_effect();
        world.run_faults();
        world.update_outputs();
        Ok(world)
    }
}

impl WorldConfig {
    /// Checks the values without building the world.
    ///
    /// # Errors
    /// Fails if a value is not allowed.
    pub fn check(&self) -> Result<(), WorldError> {
        let step_s = step_us(self.rate_hz)? as f64 * 1e-6;
        if let Some(fault) = self.airframe.fault(step_s) {
            return Err(WorldError::Airframe(self.airframe.name.clone(), fault));
        }
        self.home.check()?;
        check_wind(self.wind)?;
        in_range("gust", self.gust_mps, 0.0, Wind::MAX_MPS)?;
        self.switches.check()
    }
}

/// Returns the relief around home, if there are tiles that know its height.
fn relief(config: &WorldConfig) -> Option<LocalRelief> {
    let home = LatLon::from_degrees(config.home.lat_deg, config.home.lon_deg);
    let relief = Relief::new(Arc::clone(config.terrain.as_ref()?), home)?;
    Some(LocalRelief::new(relief, &config.home))
}

/// Returns a craft on its legs at a place east and north of home, m.
pub(super) fn standing(
    airframe: &Airframe,
    landform: &Landform,
    place: &Vector2<f64>,
    heading_deg: f64,
) -> BodyState {
    let plane = landform.tangent_at(&Vector3::new(place.x, place.y, landform.elevation_m(place)));
    let up_m = airframe.standing_height_m() / plane.normal().z;
    let level = level_attitude(heading_deg);
    let attitude = match landform.surface() {
        Surface::Flat => level,
        Surface::Slope(_) | Surface::Terrain => {
            // A shortest rotation between two vectors that point up always exists.
            UnitQuaternion::rotation_between(&Vector3::z(), plane.normal()).unwrap_or_default() * level
        }
    };
    BodyState {
        pos_enu: plane.point_at(place) + Vector3::new(0.0, 0.0, up_m),
        vel_enu: Vector3::zeros(),
        attitude,
        rate_flu: Vector3::zeros(),
    }
}

pub(super) fn full_battery(airframe: &Airframe, switches: &Switches) -> Battery {
    let mut spec = airframe.battery;
    if let Some(capacity_ah) = switches.battery_capacity_ah {
        spec.capacity_ah = capacity_ah;
    }
    Battery::full(spec)
}

fn truth_at_boot(state: &BodyState) -> Truth {
    let BodyState { pos_enu, vel_enu, attitude, rate_flu } = *state;
    Truth { pos_enu, vel_enu, attitude, rate_flu, on_ground: true, ..Truth::default() }
}
