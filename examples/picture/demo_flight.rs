//! The demo plan in the user interface, with the craft that flies it.

use std::error::Error;
use std::sync::Arc;

use betadeck::firmware::cli;
use betadeck::flight::FlightSetup;
use betadeck::flight::forecast::ForecastRun;
use betadeck::lookahead::{ForecastReply, ForecastRequest};
use betadeck::plan::builtin::{BuiltinPlan, DEMO};
use betadeck::plan::edit::History;
use betadeck::plan::format::{self, Format};
use betadeck::plan::upload_lines;
use betadeck::report::sentence;
use betadeck::session::SessionView;
use betadeck::signals::SimTime;
use betadeck::sim::WorldConfig;
use betadeck::timeline::{Marks, Timeline, TimelineView};
use betadeck::ui::PlanId;
use betadeck::ui::backdrop::BackdropLayer;
use betadeck::ui::files::{Conversion, ConversionLosses, FileReply};
use betadeck::ui::keymap::Keymap;
use betadeck::ui::{
    AppState, CliHelp, Effect, EnteredLines, KeptScreens, Msg, OpenPlan, SavedLayouts, Theme, UiConfig,
    Units, update,
};
use betadeck::vehicle::{CliSession, Vehicle, VehicleCommand};
use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};

/// The altitude to which the pilot climbs before the engagement, m.
const TAKEOFF_M: f64 = 10.0;
/// Ticks between two pictures of the track.
const TICKS_A_VIEW: u32 = 50;
/// The time at which the craft on the ground has its fix, simulated s.
const READY_S: f64 = 12.0;

/// A craft with the demo plan, and the user interface that shows it.
pub(crate) struct DemoFlight {
    /// The user interface.
    pub(crate) state: AppState,
    vehicle: Vehicle,
    timeline: Timeline,
    marks: Marks,
}

impl DemoFlight {
    /// Returns a craft that is ready on the ground, with its plan estimated.
    pub(crate) fn on_the_ground(size: (u16, u16)) -> Result<Self, Box<dyn Error>> {
        let file = BuiltinPlan::find(DEMO)
            .ok_or("no demo plan")?
            .read()
            .map_err(|errors| betadeck::plan::format::report(&errors))?;
        let world = WorldConfig { wind: "3@230".parse()?, ..WorldConfig::default() };
        let (mut vehicle, _) = FlightSetup { world, ..FlightSetup::default() }.build()?;
        for line in upload_lines(file.plan.records(), &file.settings) {
            vehicle.apply(&VehicleCommand::line(CliSession::Console, line));
        }
        let config = UiConfig {
            theme: Theme::default(),
            units: Units::default(),
            max_altitude_m: betadeck::plan::estimate::MAX_ALTITUDE_M,
            ground: betadeck::ui::GroundConfig::default(),
            keymap: Keymap::default(),
            cli: CliHelp { complete: |line| cli::complete(line).lines(line), ..CliHelp::default() },
            given_settings: Vec::new(),
            sentence: |event| sentence::text(&event.kind).unwrap_or_default(),
            go_sentence: |_, _| String::new(),
            plan: OpenPlan::new(PlanId(1), None, History::new(file.into(), true)),
            mouse: true,
            is_first_start: false,
            entered: EnteredLines::default(),
            layouts: SavedLayouts::default(),
            kept: KeptScreens::none(),
        };
        let state = AppState::new(config, size, view(&vehicle));
        let timeline = Timeline::new(&mut vehicle).ok_or("a flight that cannot be recorded")?;
        let mut flight = Self { state, vehicle, timeline, marks: Marks::default() };
        flight.advance_to(READY_S)?;
        Ok(flight)
    }

    /// Takes off, engages the autopilot and flies until this simulated time, s.
    pub(crate) fn fly_to(&mut self, time_s: f64) -> Result<(), Box<dyn Error>> {
        self.vehicle.apply(&VehicleCommand::StartPilot(TAKEOFF_M)).accepted()?;
        self.advance_to(time_s)
    }

    fn advance_to(&mut self, time_s: f64) -> Result<(), Box<dyn Error>> {
        while self.vehicle.time().as_secs_f64() < time_s {
            for _ in 0..TICKS_A_VIEW {
                self.timeline.record(&mut self.vehicle);
                self.vehicle.tick();
            }
            let mut heard = Vec::new();
            self.vehicle.drain_events(|event| heard.push(event));
            for event in heard {
                self.marks.note(event.time, &event.kind);
                self.tell(Msg::Event(event.into()))?;
            }
            self.tell(Msg::View(view(&self.vehicle)))?;
        }
        Ok(())
    }

    /// Shows an earlier instant, simulated s.
    pub(crate) fn rewind(&mut self, time_s: f64) -> Result<(), Box<dyn Error>> {
        let head = self.vehicle.time();
        self.timeline.show(SimTime::from_secs_f64(time_s), head);
        let shown = self.timeline.shown().ok_or("nothing earlier")?;
        let recording =
            TimelineView { head, rewound: true, marks: self.marks.all(), ..TimelineView::default() };
        self.tell(Msg::View(SessionView { paused: true, timeline: Some(recording), ..view(shown) }))
    }

    /// Asks as if a file of another program had been chosen in the file browser.
    pub(crate) fn ask_about(&mut self, name: &str, text: &str) -> Result<(), Box<dyn Error>> {
        let format = Format::detect(name, text.as_bytes()).0;
        let file = format::parse(name, text, format).map_err(|errors| format::report(&errors))?;
        let losses = ConversionLosses {
            conversion: Conversion::Open(name.into()),
            lines: file.losses.findings.iter().map(ToString::to_string).collect(),
            summary: file.losses.counts(),
        };
        self.tell(Msg::Files(FileReply::Losses(Box::new(losses))))
    }

    /// Shows a map under the plan.
    pub(crate) fn put_under(&mut self, name: &str, text: &str) -> Result<(), Box<dyn Error>> {
        let features =
            format::read_features(name, text.as_bytes()).map_err(|errors| format::report(&errors))?;
        let layer = BackdropLayer::new(name.into(), features);
        self.tell(Msg::Files(FileReply::Backdrop { id: PlanId(1), layer, is_new: true }))
    }

    /// Types keys. A line end is the Enter key, and U+0008 is the backspace key.
    pub(crate) fn press(&mut self, keys: &str) -> Result<(), Box<dyn Error>> {
        for key in keys.chars() {
            let code = match key {
                '\n' => KeyCode::Enter,
                '\u{8}' => KeyCode::Backspace,
                key => KeyCode::Char(key),
            };
            self.tell(Msg::Key(KeyEvent::new(code, KeyModifiers::NONE)))?;
        }
        Ok(())
    }

    /// Passes a message on, and flies the requested estimates.
    fn tell(&mut self, msg: Msg) -> Result<(), Box<dyn Error>> {
        for effect in update(&mut self.state, msg) {
            let Effect::Forecast(job) = effect else { continue };
            let kind = job.request.kind();
            let ForecastRequest::PlanEstimate { plan, settings } = job.request else { continue };
            let mut run = ForecastRun::plan_estimate(self.vehicle.clone(), &plan, &settings, TAKEOFF_M)?;
            let forecast = loop {
                if let Some(forecast) = run.advance(TICKS_A_VIEW) {
                    break forecast;
                }
            };
            let reply = ForecastReply { revision: job.revision, kind, forecast: Ok(Box::new(forecast)) };
            update(&mut self.state, Msg::Forecast(reply));
        }
        Ok(())
    }
}

fn view(vehicle: &Vehicle) -> SessionView {
    SessionView {
        vehicle: Arc::new(vehicle.snapshot()),
        speed_wanted: 1.0,
        speed_achieved: 1.0,
        sticks: vehicle.transmitter().sticks(),
        pilot: vehicle.transmitter().pilot_doing(),
        ..SessionView::default()
    }
}
