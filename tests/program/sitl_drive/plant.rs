//! The project's plant, and the packets that a simulator sends about it.

use betadeck::link::conventions::Dialect;
use betadeck::link::proto::fdm::{GZ_PLUGIN_SIZE, State, mirrored, pressure_pa};
use betadeck::signals::MotorCommand;
use betadeck::sim::{Noise, World, WorldConfig, WorldEventKind};

/// A craft at home, or in flight.
pub(crate) struct Plant {
    pub(crate) world: World,
    dialect: Dialect,
    crash: Option<String>,
    impact_mps: f64,
}

impl Plant {
    /// Returns a craft at home.
    pub(crate) fn new(dialect: Dialect) -> Self {
        let world =
            World::new(WorldConfig { noise: Noise::None, ..WorldConfig::default() }).expect("a world");
        Self { world, dialect, crash: None, impact_mps: 0.0 }
    }

    /// Returns the simulated time, ms.
    pub(crate) fn time_ms(&self) -> u64 {
        self.world.time().0 / 1000
    }

    /// Lets this much time pass with these motors.
    pub(crate) fn advance(&mut self, ms: u64, motors: [f32; 4]) {
        let command = MotorCommand(motors.map(f64::from));
        for _ in 0..ms {
            self.world.step(&command);
            while let Some(event) = self.world.take_event() {
                match event.kind {
                    WorldEventKind::Crash { cause } => self.crash = Some(cause.to_string()),
                    WorldEventKind::Contact { impact_mps } => self.impact_mps = impact_mps,
                    WorldEventKind::Diverged { cause } => self.crash = Some(cause.to_string()),
                    WorldEventKind::Touchdown { .. }
                    | WorldEventKind::BatteryEmpty { .. }
                    | WorldEventKind::Fault { .. } => {}
                }
            }
        }
    }

    /// Returns the cause of a crash, if there was one.
    pub(crate) fn crash(&self) -> Option<&str> {
        self.crash.as_deref()
    }

    /// Returns the speed of the last contact with the ground, m/s.
    pub(crate) fn impact_mps(&self) -> f64 {
        self.impact_mps
    }

    /// Returns the height above home, m.
    pub(crate) fn height_m(&self) -> f64 {
        self.world.truth().pos_enu.z - self.world.airframe().standing_height_m()
    }

    /// Encodes the state of the craft in the dialect, with positions mirrored about home if the dialect does so.
    pub(crate) fn packet(&self) -> Vec<u8> {
        let (truth, frame) = (self.world.truth(), self.world.local_frame());
        let (lat_deg, lon_deg, alt_m) = frame.to_geodetic(truth.pos_enu);
        let wire = |home: f64, value: f64| if self.dialect.mirrors() { mirrored(home, value) } else { value };
        let state = State {
            stamp_s: self.time_ms() as f64 * 1e-3,
            rate_flu: truth.rate_flu,
            specific_force_flu: truth.specific_force_flu,
            attitude: truth.attitude,
            vel_enu: truth.vel_enu,
            lon_deg: wire(frame.lon_deg, lon_deg),
            lat_deg: wire(frame.lat_deg, lat_deg),
            alt_m,
            pressure_pa: pressure_pa(alt_m),
        };
        let mut bytes = self.dialect.encode(&state).to_bytes().to_vec();
        if self.dialect == Dialect::GzPlugin {
            // The plugin leaves these bytes uninitialised.
            bytes.resize(GZ_PLUGIN_SIZE, 0xff);
        }
        bytes
    }
}
