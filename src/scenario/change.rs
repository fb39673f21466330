//! Applies the values of a campaign's inputs to a flight.

use super::air::{Air, WindProblem};
use super::case::{Case, OWN_LINES};
use super::varied::{Change, Tolerance};
use crate::flight::setup::BootLines;
use crate::sim::{Airframe, Switches};

impl Tolerance {
    /// Changes the airframe by so many per cent.
    pub(super) fn apply(self, percent: f64, airframe: &mut Airframe, switches: &mut Switches) {
        let factor = 1.0 + percent / 100.0;
        match self {
            Self::Mass => airframe.mass_kg *= factor,
            Self::Thrust => airframe.thrust_coeff *= factor,
            Self::Drag => {
                airframe.body_drag *= factor;
                airframe.rotor_drag_coeff *= factor;
            }
            Self::Inertia => airframe.inertia_kgm2 *= factor,
            Self::Battery => {
                airframe.battery.capacity_ah *= factor;
                if let Some(capacity) = &mut switches.battery_capacity_ah {
                    *capacity *= factor;
                }
            }
        }
    }
}

impl Change {
    /// Changes the case and the air of a flight. The air has its seed.
    ///
    /// # Errors
    /// Returns a sentence if the value does not fit this flight.
    pub fn apply(&self, case: &mut Case, air: &mut Air) -> Result<(), String> {
        let world = &mut case.setup.world;
        match self {
            Self::Airframe(airframe) => world.airframe.clone_from(airframe),
            Self::Tolerance(of, percent) => of.apply(*percent, &mut world.airframe, &mut world.switches),
            Self::Wind(text) => {
                air.wind = text.of_seed(air.seed).map_err(|WindProblem { message, .. }| message)?;
            }
            Self::WindIs(wind) => air.wind = *wind,
            Self::Gust(gust_mps) => air.gust_mps = *gust_mps,
            Self::Turbulence(turbulence) => air.turbulence = *turbulence,
            Self::Noise(noise) => air.noise = *noise,
            Self::World(text) => {
                world.switches.set(text).map_err(|error| error.problem().to_owned())?;
            }
            Self::Takeoff(takeoff_m) => case.options.takeoff_m = *takeoff_m,
            Self::Heading(heading_deg) => world.home.heading_deg = *heading_deg,
            Self::Rate(rate_hz) => world.rate_hz = *rate_hz,
            Self::Setting(setting) => set(&mut case.setup.boot_lines, setting),
            Self::Fault(fault) => world.faults.push(*fault),
        }
        Ok(())
    }
}

/// Adds a setting to those of the scenario itself.
fn set(boot_lines: &mut Vec<BootLines>, setting: &str) {
    let line = format!("set {setting}\n");
    match boot_lines.iter_mut().find(|lines| lines.source == OWN_LINES[0]) {
        Some(own) => own.text.push_str(&line),
        None => boot_lines.push(BootLines { source: OWN_LINES[0].to_owned(), text: line }),
    }
}

#[cfg(test)]
mod tests {
    use strum::IntoEnumIterator as _;

    use super::*;

    #[test]
    fn every_built_in_craft_takes_every_tolerance_of_twenty_per_cent() {
        for name in crate::sim::BUILTIN_NAMES {
            for (of, percent) in Tolerance::iter().flat_map(|of| [(of, -20.0), (of, 20.0)]) {
                let airframe = name.parse().unwrap();
                let mut world = crate::sim::WorldConfig { airframe, ..Default::default() };
                of.apply(percent, &mut world.airframe, &mut world.switches);
                for rate_hz in [400, 500, 1000, 8000] {
                    world.rate_hz = rate_hz;
                    assert_eq!(world.check(), Ok(()), "{name} {} {percent} {rate_hz}", of.key());
                }
            }
        }
    }
}
