//! The physics of a vehicle: the simulated world, or an external simulator.

mod external;

pub(super) use external::ExternalPhysics;

use nalgebra::Vector2;

use crate::geo::LocalFrame;
use crate::signals::{MotorCommand, SensorFrame, SimTime};
use crate::sim::{Fault, LinkFaults, Noise, World, WorldCommand, WorldError, WorldEvent};
use crate::telemetry::snapshot::{FaultView, TruthView, WindView, WorldView};

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

    /// Carries out a motor command over one step. An external simulator gets it through the link.
    pub(super) fn step(&mut self, motors: &MotorCommand) {
        if let Self::World(world) = self {
            world.step(motors);
        }
    }

    /// Returns the part with the time and the faults.
    fn clockwork(&self) -> &World {
        match self {
            Self::World(world) => world,
            Self::External(external) => external.links(),
        }
    }

    fn clockwork_mut(&mut self) -> &mut World {
        match self {
            Self::World(world) => world,
            Self::External(external) => external.links_mut(),
        }
    }

    /// Returns the simulated world, if it moves the craft.
    pub(super) fn world(&self) -> Option<&World> {
        match self {
            Self::World(world) => Some(world),
            Self::External(_) => None,
        }
    }

    /// Returns the external simulator, if it moves the craft.
    pub(super) fn external_mut(&mut self) -> Option<&mut ExternalPhysics> {
        match self {
            Self::World(_) => None,
            Self::External(external) => Some(external),
        }
    }

    pub(super) fn time(&self) -> SimTime {
        self.clockwork().time()
    }

    pub(super) fn step_us(&self) -> u64 {
        self.clockwork().step_us()
    }

    pub(super) fn seed(&self) -> u64 {
        self.clockwork().seed()
    }

    pub(super) fn airframe(&self) -> &str {
        self.world().map_or(EXTERNAL, |world| &world.airframe().name)
    }

    pub(super) fn apply(&mut self, command: WorldCommand) -> Result<(), WorldError> {
        self.clockwork_mut().apply(command)
    }

    pub(super) fn set_engaged(&mut self, time: SimTime) {
        self.clockwork_mut().set_engaged(time);
    }

    pub(super) fn take_event(&mut self) -> Option<WorldEvent> {
        self.clockwork_mut().take_event()
    }

    /// Returns `true` if no RC frame reaches the receiver.
    pub(super) fn rx_lost(&self) -> bool {
        self.clockwork().rx_lost()
    }

    /// Returns the fraction of RC frames that are dropped at random, 0…1.
    pub(super) fn rx_drop_fraction(&self) -> f64 {
        self.clockwork().rx_drop_fraction()
    }

    /// Returns the effects of active faults on the packets of an external simulator.
    pub(super) fn link_faults(&self) -> LinkFaults {
        self.clockwork().link_faults()
    }

    /// Returns the frame with its origin at the boot place, or `None` before an external simulator has reported that
    /// place.
    pub(super) fn local_frame(&self) -> Option<&LocalFrame> {
        match self {
            Self::World(world) => Some(world.local_frame()),
            Self::External(external) => external.frame(),
        }
    }

    /// Returns `true` if the craft has crashed.
    pub(super) fn crashed(&self) -> bool {
        self.world().is_some_and(|world| world.truth().crashed)
    }

    /// Returns `true` if the simulation has left the range in which its numbers are meaningful.
    pub(super) fn diverged(&self) -> bool {
        self.world().is_some_and(|world| world.truth().diverged)
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
        let status = self.clockwork().status();
        let view =
            |&(fault, left_s): &(Fault, _)| FaultView { kind: fault.kind(), value: fault.value(), left_s };
        let view = WorldView {
            airframe: self.airframe().to_owned(),
            faults: status.faults.iter().map(view).collect(),
            ..WorldView::default()
        };
        if self.world().is_none() {
            return view;
        }
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
        on_ground: truth.on_ground,
        crashed: truth.crashed,
        diverged: truth.diverged,
    }
}
