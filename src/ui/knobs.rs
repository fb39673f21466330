//! The knobs of the World panel: air, noise and faults, and the requests to the session when one is turned.

use crossterm::event::{KeyCode, KeyEvent};
use strum::IntoEnumIterator as _;

use super::formatting::fixed;
use super::shared::Shared;
use super::text_field::TextField;
use super::units::Units;
use crate::sim::{FAULTS, FaultInfo};
use crate::telemetry::snapshot::{FaultView, WindView, WorldView};
use crate::telemetry::{FaultValue, Turbulence};
use crate::ui::model::effect::Effect;
use crate::ui::model::message::{Change, Request};

/// A step of the wind's speed and of gusts, m/s.
const SPEED_STEP: f64 = 0.5;
/// The strongest wind that the user can set, m/s.
const MAX_MPS: f64 = 60.0;
/// The height above the ground from which the mean wind is the given one, m. It is weaker below.
const FULL_WIND_M: f64 = 10.0;
/// A step of the wind's direction, degrees.
const DIRECTION_STEP: f64 = 15.0;

/// The state of the World panel.
#[derive(Debug, Default)]
pub struct KnobsState {
    /// Index of the selected knob.
    pub selected: usize,
    /// The value being typed.
    pub field: Option<TextField>,
}

/// Something in the world that can be changed in flight.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Knob {
    WindSpeed,
    WindFrom,
    Gust,
    Turbulence,
    Noise,
    Fault(&'static FaultInfo),
}

/// Returns the knobs that have an effect in the current world, in display order.
pub(super) fn knobs(state: &Shared) -> Vec<Knob> {
    knobs_of(state.view.simulator.is_some()).collect()
}

/// Returns the knobs of a world with an external simulator, or without one, in display order.
pub(super) fn knobs_of(external: bool) -> impl Iterator<Item = Knob> {
    let faults = FAULTS.iter().filter(move |fault| external || !fault.needs_link()).map(Knob::Fault);
    [Knob::WindSpeed, Knob::WindFrom, Knob::Gust, Knob::Turbulence, Knob::Noise].into_iter().chain(faults)
}

/// Returns the active fault of this kind, if there is one.
pub(super) fn active(world: &WorldView, fault: &FaultInfo) -> Option<FaultView> {
    world.faults.iter().find(|active| active.kind == fault.kind).copied()
}

impl Knob {
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::WindSpeed => "wind speed",
            Self::WindFrom => "wind from",
            Self::Gust => "gusts",
            Self::Turbulence => "turbulence",
            Self::Noise => "sensor noise",
            Self::Fault(fault) => fault.name(),
        }
    }

    /// Returns its value with the unit, or a dash if nothing reports it.
    pub(super) fn value(self, state: &Shared) -> String {
        self.value_in(&state.view.vehicle.world, state.units)
    }

    /// Returns its value in a world.
    pub(super) fn value_in(self, world: &WorldView, units: Units) -> String {
        let speed = |speed: Option<f64>| {
            let shown = speed.map(|speed| units.speed(speed));
            format!("{} {}", fixed(shown, 6, 1), units.speed_unit())
        };
        match self {
            Self::WindSpeed => speed(world.wind.map(|wind| wind.speed_mps)),
            Self::WindFrom => format!("{}°", fixed(world.wind.map(|wind| wind.from_deg), 6, 0)),
            Self::Gust => speed(world.wind.map(|_| world.gust_mps)),
            Self::Turbulence if world.wind.is_some() => world.turbulence.to_string(),
            Self::Noise if world.wind.is_some() => if world.noise { "real" } else { "none" }.to_owned(),
            Self::Turbulence | Self::Noise => "—".to_owned(),
            Self::Fault(fault) => match active(world, fault) {
                None => "—".to_owned(),
                Some(FaultView { value, left_s, .. }) => {
                    let value = if value == FaultValue::None { String::new() } else { format!(" {value}") };
                    let left = left_s.map_or_else(String::new, |left| format!(" for {left:.1} s"));
                    format!("on{value}{left}")
                }
            },
        }
    }

    /// Returns `true` if the knob is at its default.
    pub(super) fn is_default(self, world: &WorldView) -> bool {
        let Some(wind) = world.wind else {
            return !matches!(self, Self::Fault(fault) if active(world, fault).is_some());
        };
        match self {
            Self::WindSpeed => wind.speed_mps == 0.0,
            Self::WindFrom => wind.speed_mps == 0.0 || wind.from_deg == 0.0,
            Self::Gust => world.gust_mps == 0.0,
            Self::Turbulence => world.turbulence == Turbulence::None,
            Self::Noise => world.noise,
            Self::Fault(fault) => active(world, fault).is_none(),
        }
    }

    /// Returns the meaning of its value, or the form in which it is written.
    pub(super) fn help(self, units: Units) -> String {
        match self {
            Self::WindSpeed => {
                let most = units.speed_text(MAX_MPS, 0);
                format!("wind from {} up, 0 to {most}, over two seconds", units.length_text(FULL_WIND_M, 0))
            }
            Self::WindFrom => "the direction it blows from, degrees".to_owned(),
            Self::Gust => format!("strength of random gusts, 0 to {}", units.speed_text(MAX_MPS, 0)),
            Self::Turbulence => "none, light, moderate, severe".to_owned(),
            Self::Noise => "sensor errors: real, none".to_owned(),
            Self::Fault(fault) if fault.value.is_empty() => format!("{}; = types SECONDS", fault.help),
            Self::Fault(fault) => format!("{}; = types [SECONDS],VALUE: {}", fault.help, fault.value),
        }
    }
}

impl KnobsState {
    fn selected(&self, state: &Shared) -> Option<Knob> {
        knobs(state).get(self.selected).copied()
    }

    /// Turns the selected knob by steps. A fault is switched on or off.
    pub(super) fn turn(&mut self, state: &Shared, steps: i32) -> Vec<Request> {
        let Some(knob) = self.selected(state) else { return Vec::new() };
        let world = &state.view.vehicle.world;
        let wind = world.wind.unwrap_or(WindView { speed_mps: 0.0, from_deg: 0.0 });
        let step = f64::from(steps);
        let stepped = |speed: f64| (speed + step * SPEED_STEP).clamp(0.0, MAX_MPS);
        match knob {
            Knob::WindSpeed => set_wind(state, WindView { speed_mps: stepped(wind.speed_mps), ..wind }),
            Knob::WindFrom => {
                let from_deg = (wind.from_deg + step * DIRECTION_STEP).rem_euclid(360.0);
                set_wind(state, WindView { from_deg, ..wind })
            }
            Knob::Gust => set_gust(state, stepped(world.gust_mps)),
            Knob::Turbulence => {
                let levels: Vec<Turbulence> = Turbulence::iter().collect();
                let at = levels.iter().position(|level| *level == world.turbulence).unwrap_or(0);
                let next = at.saturating_add_signed(steps as isize).min(levels.len() - 1);
                levels.get(next).map_or_else(Vec::new, |level| set_turbulence(state, *level))
            }
            Knob::Noise => set_noise(state, steps > 0),
            Knob::Fault(fault) => match (active(world, fault).is_some(), steps > 0) {
                (false, true) => self.begin(fault),
                (true, false) => end(fault),
                _ => Vec::new(),
            },
        }
    }

    /// Handles Enter: a level or a fault changes at once, a number is typed.
    pub(super) fn enter(&mut self, state: &Shared) -> Vec<Request> {
        match self.selected(state) {
            Some(Knob::Noise) => set_noise(state, !state.view.vehicle.world.noise),
            Some(Knob::Turbulence) => {
                let levels: Vec<Turbulence> = Turbulence::iter().collect();
                let now = state.view.vehicle.world.turbulence;
                let next =
                    levels.iter().position(|level| *level == now).map_or(0, |at| (at + 1) % levels.len());
                levels.get(next).map_or_else(Vec::new, |level| set_turbulence(state, *level))
            }
            Some(Knob::Fault(fault)) if active(&state.view.vehicle.world, fault).is_some() => end(fault),
            Some(Knob::Fault(fault)) => self.begin(fault),
            Some(_) => self.edit(),
            None => Vec::new(),
        }
    }

    /// Returns `true` if the value of the selected knob is a number.
    pub(super) fn is_number(&self, state: &Shared) -> bool {
        matches!(self.selected(state), Some(Knob::WindSpeed | Knob::WindFrom | Knob::Gust))
    }

    /// Opens the field for a value of the selected knob.
    pub(super) fn edit(&mut self) -> Vec<Request> {
        self.field = Some(TextField::default());
        Vec::new()
    }

    /// Sets the selected knob to its default.
    pub(super) fn reset(&mut self, state: &Shared) -> Vec<Request> {
        let Some(knob) = self.selected(state) else { return Vec::new() };
        if knob.is_default(&state.view.vehicle.world) {
            return Vec::new();
        }
        match knob {
            Knob::WindSpeed | Knob::WindFrom => set_wind(state, WindView { speed_mps: 0.0, from_deg: 0.0 }),
            Knob::Gust => set_gust(state, 0.0),
            Knob::Turbulence => set_turbulence(state, Turbulence::None),
            Knob::Noise => set_noise(state, true),
            Knob::Fault(fault) => end(fault),
        }
    }

    /// Handles a key while a value is typed.
    pub(super) fn field_key(&mut self, state: &Shared, event: KeyEvent) -> Vec<Request> {
        let Some(field) = &mut self.field else { return Vec::new() };
        match event.code {
            KeyCode::Esc => {
                self.field = None;
                Vec::new()
            }
            KeyCode::Enter => {
                let typed = field.take();
                self.field = None;
                self.take_typed(state, typed.trim())
            }
            _ => {
                field.key(event);
                Vec::new()
            }
        }
    }

    /// Requests the typed value. A speed is typed in the shown units.
    fn take_typed(&self, state: &Shared, typed: &str) -> Vec<Request> {
        let Some(knob) = self.selected(state).filter(|_| !typed.is_empty()) else { return Vec::new() };
        let wind = state.view.vehicle.world.wind.unwrap_or(WindView { speed_mps: 0.0, from_deg: 0.0 });
        let number: Result<f64, _> = typed.parse();
        let speed = number.as_ref().map(|number| number / state.units.speed(1.0));
        match (knob, speed) {
            (Knob::WindSpeed, Ok(speed_mps)) => world(format!("wind={}@{}", tidy(speed_mps), wind.from_deg)),
            (Knob::WindFrom, _) => world(format!("wind={}@{typed}", wind.speed_mps)),
            (Knob::WindSpeed, Err(_)) => world(format!("wind={typed}")),
            (Knob::Gust, Ok(speed)) => world(format!("gust={}", tidy(speed))),
            (Knob::Gust, Err(_)) => world(format!("gust={typed}")),
            (Knob::Turbulence, _) => world(format!("turbulence={typed}")),
            (Knob::Noise, _) => world(format!("noise={typed}")),
            (Knob::Fault(fault), _) => world(format!("fault={},{typed}", fault.name())),
        }
    }

    fn begin(&mut self, fault: &FaultInfo) -> Vec<Request> {
        if fault.value.is_empty() || !fault.default.is_empty() {
            return world(format!("fault={}", fault.name()));
        }
        // The fault needs a value.
        self.field = Some(TextField::new(","));
        Vec::new()
    }
}

/// Removes the rounding noise of a unit conversion.
fn tidy(speed_mps: f64) -> f64 {
    (speed_mps * 1000.0).round() / 1000.0
}

fn end(fault: &FaultInfo) -> Vec<Request> {
    world(format!("end={}", fault.name()))
}

fn set_wind(state: &Shared, wind: WindView) -> Vec<Request> {
    let line = format!("wind={}@{}", wind.speed_mps, wind.from_deg);
    changed(state, line, |world| world.wind = world.wind.map(|_| wind))
}

fn set_gust(state: &Shared, speed_mps: f64) -> Vec<Request> {
    changed(state, format!("gust={speed_mps}"), |world| world.gust_mps = speed_mps)
}

fn set_turbulence(state: &Shared, level: Turbulence) -> Vec<Request> {
    changed(state, format!("turbulence={level}"), |world| world.turbulence = level)
}

fn set_noise(state: &Shared, on: bool) -> Vec<Request> {
    changed(state, format!("noise={}", if on { "real" } else { "none" }), |world| world.noise = on)
}

/// Returns the requests that change the world by `line`, and show the change at once.
fn changed(state: &Shared, line: String, change: impl FnOnce(&mut WorldView)) -> Vec<Request> {
    let mut shown = state.view.vehicle.world.clone();
    change(&mut shown);
    vec![Change::World(Box::new(shown)).into(), Effect::World(line).into()]
}

fn world(line: String) -> Vec<Request> {
    vec![Effect::World(line).into()]
}
