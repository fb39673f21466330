//! The physics of a vehicle: the simulated world, or an external simulator.

mod external;

pub(super) use external::ExternalPhysics;

use nalgebra::{Vector2, Vector3};

use crate::geo::LocalFrame;
use crate::signals::{MotorCommand, SensorFrame};
use crate::sim::{Airframe, Clock, Noise, Truth, World, WorldCommand, WorldConfig, WorldError, WorldStatus};
use crate::telemetry::snapshot::{BatteryView, FaultView, TruthView, WindView, WorldView};

/// The name of the airframe if an external simulator has it.
const EXTERNAL: &str = "external";

/// The physics that moves the craft. A clone continues identically.
#[derive(Debug, Clone)]
pub(super) enum Physics {
    World(Box<World>),
    External(Box<ExternalPhysics>),
}

impl Physics {
    /// Returns the sensor frame of the present instant; of an external simulator, the last one received.
    pub(super) fn sensors(&self) -> &SensorFrame {
        match self {
            Self::World(world) => world.sensors(),
            Self::External(external) => external.sensors(),
        }
    }

    /// Returns the world at boot again, as [`World::again`] does; `None` for an external simulator.
    ///
    /// # Errors
    /// Fails if a changed value is not allowed.
    pub(super) fn again(&self, change: impl FnOnce(&mut WorldConfig)) -> Result<Option<Self>, WorldError> {
        match self {
            Self::World(world) => Ok(Some(Self::World(Box::new(world.again(change)?)))),
            Self::External(_) => Ok(None),
        }
    }

    /// Carries out a motor command over one step. An external simulator gets it through the link.
    pub(super) fn step(&mut self, motors: &MotorCommand) {
        if let Self::World(world) = self {
            world.step(motors);
        }
    }

    /// Returns time, seed and faults.
    pub(super) fn clock(&self) -> &Clock {
        match self {
            Self::World(world) => world.clock(),
            Self::External(external) => external.clock(),
        }
    }

    /// Returns the clock, to report the engagement to it and to take its events.
    pub(super) fn clock_mut(&mut self) -> &mut Clock {
        match self {
            Self::World(world) => world.clock_mut(),
            Self::External(external) => external.clock_mut(),
        }
    }

    /// Returns the external simulator, if it moves the craft.
    pub(super) fn external_mut(&mut self) -> Option<&mut ExternalPhysics> {
        match self {
            Self::World(_) => None,
            Self::External(external) => Some(external),
        }
    }

    /// Returns the name of the airframe.
    pub(super) fn airframe_name(&self) -> &str {
        self.airframe().map_or(EXTERNAL, |airframe| &airframe.name)
    }

    /// Returns the airframe, if its motion is simulated here.
    pub(super) fn airframe(&self) -> Option<&Airframe> {
        match self {
            Self::World(world) => Some(world.airframe()),
            Self::External(_) => None,
        }
    }

    /// Returns the true state of the craft, if its motion is simulated here.
    pub(super) fn truth(&self) -> Option<&Truth> {
        match self {
            Self::World(world) => Some(world.truth()),
            Self::External(_) => None,
        }
    }

    /// Returns the settings of air and noise, if they are simulated here.
    pub(super) fn status(&self) -> Option<WorldStatus> {
        match self {
            Self::World(world) => Some(world.status()),
            Self::External(_) => None,
        }
    }

    /// Returns the maximum thrust over weight in the air at the craft, if its motion is simulated here.
    pub(super) fn thrust_to_weight(&self) -> Option<f64> {
        match self {
            Self::World(world) => Some(world.thrust_to_weight()),
            Self::External(_) => None,
        }
    }

    /// Changes air, noise or faults.
    pub(super) fn apply(&mut self, command: WorldCommand) -> Result<(), WorldError> {
        match self {
            Self::World(world) => world.apply(command),
            Self::External(external) => external.clock_mut().apply(command),
        }
    }

    /// Adds a wind to the air at the craft, if its motion is simulated here.
    pub(super) fn set_added_wind(&mut self, vel_enu: Vector3<f64>) -> Result<(), WorldError> {
        match self {
            Self::World(world) => world.set_added_wind(vel_enu),
            Self::External(_) => Err(WorldError::Outside),
        }
    }

    /// Puts the craft back at home. A craft that an external simulator moves starts where it is seen next.
    pub(super) fn reset(&mut self) {
        match self {
            Self::World(world) => world.reset_to_home(),
            Self::External(external) => external.reset(),
        }
    }

    /// Returns the frame with its origin at the boot place, or `None` before an external simulator has reported that
    /// place.
    pub(super) fn local_frame(&self) -> Option<&LocalFrame> {
        match self {
            Self::World(world) => Some(world.local_frame()),
            Self::External(external) => external.frame(),
        }
    }

    /// Returns the true motion of the craft under these motor commands, as far as it is known.
    pub(super) fn truth_view(&self, motors: MotorCommand) -> Option<TruthView> {
        match self {
            Self::World(world) => Some(world_truth_view(world)),
            Self::External(external) => external.truth_view(motors.0),
        }
    }

    /// Returns air, noise and faults.
    pub(super) fn world_view(&self) -> WorldView {
        let faults = self.clock().active_faults();
        let view = WorldView {
            airframe: self.airframe_name().to_owned(),
            faults: faults
                .map(|(fault, left_s)| FaultView { kind: fault.kind(), value: fault.value(), left_s })
                .collect(),
            ..WorldView::default()
        };
        let Some(status) = self.status() else { return view };
        WorldView {
            wind: Some(WindView { speed_mps: status.wind.speed_mps, from_deg: status.wind.from_deg }),
            gust_mps: status.gust_mps,
            turbulence: status.turbulence,
            noise: status.noise == Noise::Real,
            ..view
        }
    }
}

fn world_truth_view(world: &World) -> TruthView {
    let truth = world.truth();
    let (lat_deg, lon_deg, _) = world.local_frame().to_geodetic(truth.pos_enu);
    TruthView {
        lat_deg,
        lon_deg,
        n: truth.pos_enu.y,
        e: truth.pos_enu.x,
        alt: truth.pos_enu.z - world.airframe().standing_height_m(),
        vn: truth.vel_enu.y,
        ve: truth.vel_enu.x,
        vu: truth.vel_enu.z,
        roll_deg: truth.roll_deg(),
        pitch_deg: truth.pitch_deg(),
        heading_deg: truth.heading_deg(),
        motors: truth.motor_command,
        wind_ne: Some(Vector2::new(truth.wind_enu.y, truth.wind_enu.x)),
        wind_mps: Some(truth.wind_enu.norm()),
        force_mps2: Some(truth.specific_force_flu.norm()),
        battery: Some(BatteryView {
            voltage_v: truth.battery.voltage_v,
            current_a: truth.battery.current_a,
            drawn_mah: truth.battery.drawn_mah,
            capacity_mah: truth.battery.capacity_mah,
        }),
        on_ground: truth.on_ground,
        crashed: truth.crashed,
        diverged: truth.diverged,
    }
}
