//! A flight of the guide's square as the user interface sees it: pictures and events, without firmware or physics.

#![allow(dead_code, unused_imports, reason = "tests and the bench share this file and use different parts")]

use betadeck::events::{Event, SessionEvent};
use betadeck::geo::{LatLon, LocalFrame};
use betadeck::link::endpoint::{ClientStats, EndpointKind, EndpointState, EndpointStatus, PacketStats};
use betadeck::plan::edit::{History, PlanDocument};
use betadeck::plan::{Altitude, FlightPlan, HoldPattern, Seconds, Waypoint, WaypointType};
use betadeck::session::SessionView;
use betadeck::signals::{RcFrame, RcSource, SimTime};
use betadeck::telemetry::snapshot::{ModeRange, SettingsView, TruthView};
use betadeck::telemetry::{
    ArmingFlag, EventKind, FirmwareEvent, Guard, L1Mode, Mode, ModeFlags, NavEvent, NavState, Snapshot,
};
use betadeck::ui::PlanId;
use betadeck::ui::keymap::Keymap;
use betadeck::ui::theme::{Charset, Palette};
use betadeck::ui::{AppState, CliHelp, EnteredLines, Msg, OpenPlan, Theme, UiConfig, Units, update};
use nalgebra::{Vector2, Vector3};

// Also correct for the bench, which names this file by its path.
#[path = "fixture/course.rs"]
mod course;

pub(crate) use course::{approach, branch, complete, land, orbit, rewind};

/// The position of the craft at boot.
pub(crate) const HOME: LatLon = LatLon::new(404_635_000, -795_182_000);

/// Returns the guide's square.
pub(crate) fn square() -> FlightPlan {
    let corner = |lat_e7, lon_e7, kind, seconds| Waypoint {
        position: LatLon::new(lat_e7, lon_e7),
        altitude: Altitude::above_home(50.0),
        duration: Seconds::new(seconds),
        kind,
        pattern: HoldPattern::Orbit,
        ..Waypoint::default()
    };
    let mut plan = FlightPlan::default();
    plan.waypoints.extend([
        corner(404_640_000, -795_175_000, WaypointType::Flyover, 0.0),
        corner(404_630_000, -795_175_000, WaypointType::Flyby, 0.0),
        corner(404_630_000, -795_190_000, WaypointType::Hold, 30.0),
        corner(404_640_000, -795_190_000, WaypointType::Land, 0.0),
    ]);
    plan
}

/// Returns an open plan that is stored in a file.
fn open(plan: FlightPlan) -> OpenPlan {
    let document = PlanDocument { name: "square".to_owned(), plan, ..PlanDocument::default() };
    OpenPlan::new(PlanId(1), Some("plans/square.toml".into()), History::new(document, true))
}

/// Returns an event as a short sentence.
fn sentence(event: &Event) -> String {
    let kind = match &event.kind {
        SessionEvent::Vehicle(kind) => kind,
        SessionEvent::Replay(notice) => return notice.to_string(),
        other => return format!("{other:?}"),
    };
    match kind {
        EventKind::Boot { airframe, .. } => format!("started, airframe {airframe}"),
        EventKind::Firmware(FirmwareEvent::Armed) => "armed (home 40.4635000,-79.5182000)".to_owned(),
        EventKind::Firmware(FirmwareEvent::Nav(NavEvent::State { from, to, wp, reason, .. })) => {
            format!("WP{wp} {reason}: {from} → {to}")
        }
        other => format!("{other:?}"),
    }
}

/// Returns a user interface of this size, before the first picture.
pub(crate) fn state(size: (u16, u16), theme: Theme) -> AppState {
    state_with(size, theme, square())
}

/// Returns the same with another plan open.
pub(crate) fn state_with(size: (u16, u16), theme: Theme, plan: FlightPlan) -> AppState {
    state_after(size, theme, plan, EnteredLines::default())
}

/// Returns the same after earlier runs in which these lines were entered.
pub(crate) fn state_after(
    size: (u16, u16),
    theme: Theme,
    plan: FlightPlan,
    entered: EnteredLines,
) -> AppState {
    let config = UiConfig {
        theme,
        units: Units::default(),
        max_altitude_m: betadeck::plan::estimate::MAX_ALTITUDE_M,
        ground: betadeck::ui::GroundConfig::default(),
        keymap: Keymap::default(),
        cli: CliHelp {
            complete: |line| {
                ["set ap_position_p", "set ap_position_i", "save", "status"]
                    .into_iter()
                    .filter(|known| known.starts_with(line))
                    .map(str::to_owned)
                    .collect()
            },
            hint: |line| line.starts_with("set ap_position_p").then(|| "0 … 200, default 30".to_owned()),
            check_setting: betadeck::flight::setup::check_setting,
        },
        given_settings: Vec::new(),
        sentence,
        go_sentence: |name, answer| betadeck::report::campaign::forecast_notice(name, answer, 0.95),
        plan: open(plan),
        mouse: true,
        entered,
        layouts: betadeck::ui::SavedLayouts::default(),
        kept: betadeck::ui::KeptScreens::default(),
        is_first_start: false,
    };
    AppState::new(config, size, view(&SimpleFlight::default()))
}

/// Returns the full theme.
pub(crate) fn colour() -> Theme {
    Theme::default()
}

/// Returns the seven-bit theme.
pub(crate) fn plain() -> Theme {
    Theme { palette: Palette::Mono, charset: Charset::Ascii, ..Theme::default() }
}

/// The values that differ between the pictures of the flight.
#[derive(Debug, Clone)]
pub(crate) struct SimpleFlight {
    pub(crate) time_s: f64,
    pub(crate) n: f64,
    pub(crate) e: f64,
    pub(crate) alt: f64,
    pub(crate) heading_deg: f64,
    pub(crate) speed: f64,
    pub(crate) armed: bool,
    pub(crate) fix: bool,
    pub(crate) state: NavState,
    pub(crate) wp: u8,
    pub(crate) guards: Vec<Guard>,
    pub(crate) hold_s: f64,
}

impl Default for SimpleFlight {
    fn default() -> Self {
        Self {
            time_s: 2.0,
            n: 0.0,
            e: 0.0,
            alt: 0.0,
            heading_deg: 0.0,
            speed: 0.0,
            armed: false,
            fix: false,
            state: NavState::Idle,
            wp: 0,
            guards: Vec::new(),
            hold_s: 0.0,
        }
    }
}

/// Returns the picture of a moment.
pub(crate) fn view(flight: &SimpleFlight) -> SessionView {
    let engaged = !matches!(flight.state, NavState::Idle);
    let plan = square();
    let frame = LocalFrame::new(HOME.lat_deg(), HOME.lon_deg(), 0.0);
    let (lat_deg, lon_deg, _) = frame.to_geodetic(Vector3::new(flight.e, flight.n, 0.0));
    let wp = plan.waypoints[usize::from(flight.wp)];
    let target = frame.to_enu(wp.position.lat_deg(), wp.position.lon_deg(), 0.0);
    let (dn, de) = (target.y - flight.n, target.x - flight.e);

    let mut snapshot = Snapshot { time: SimTime::from_secs_f64(flight.time_s), ..Snapshot::default() };
    snapshot.truth = Some(TruthView {
        lat_deg,
        lon_deg,
        n: flight.n,
        e: flight.e,
        alt: flight.alt,
        heading_deg: flight.heading_deg,
        wind_ne: Some(Vector2::new(-2.2, 2.3)),
        on_ground: flight.alt < 0.1,
        ..TruthView::default()
    });
    let estimate = &mut snapshot.estimate;
    if flight.fix {
        estimate.n = Some(flight.n + 0.3);
        estimate.e = Some(flight.e - 0.2);
    }
    estimate.alt = Some(flight.alt);
    estimate.ground_speed_mps = Some(flight.speed);
    estimate.climb_mps = Some(0.0);
    estimate.heading_deg = Some(flight.heading_deg);

    let craft = &mut snapshot.craft;
    craft.armed = Some(flight.armed);
    let mut modes = ModeFlags::NONE;
    for (mode, on) in [
        (Mode::Arm, flight.armed),
        (Mode::Angle, flight.armed),
        (Mode::AltHold, flight.armed),
        (Mode::PosHold, flight.armed),
        (Mode::Autopilot, engaged && flight.armed),
    ] {
        modes.set(mode, on);
    }
    craft.modes = Some(modes);
    craft.gps_fix = Some(flight.fix);
    craft.sats = Some(if flight.fix { 12 } else { 3 });
    craft.home = flight.fix.then_some(HOME);
    craft.battery_v = Some(11.4);
    craft.battery_cells = Some(3);
    craft.rc_source = Some(RcSource::Sticks);
    craft.rc_age_s = Some(0.02);
    craft.rc_link = Some(true);
    craft.throttle_us = Some(if flight.armed { 1500.0 } else { 1000.0 });
    let mut channels = RcFrame::SAFE.channels;
    if flight.armed {
        channels[2] = 1500;
        channels[4] = 1900;
        channels[5] = if engaged { 1900 } else { 1000 };
        channels[6] = 1900;
    }
    craft.channels = Some(channels);
    if !flight.fix {
        craft.arming_blocked_by.get_or_insert_default().set(ArmingFlag::BootGrace, true);
    }
    craft.mode_ranges = Some(
        [(Mode::Arm, 4), (Mode::Autopilot, 5), (Mode::Angle, 6), (Mode::AltHold, 6), (Mode::PosHold, 6)]
            .map(|(mode, channel)| ModeRange { mode_box: mode.into(), channel, start_us: 1700, end_us: 2100 })
            .to_vec(),
    );

    let nav = snapshot.nav.get_or_insert_default();
    nav.state = flight.state;
    nav.engaged = engaged && flight.armed;
    nav.wp = flight.wp;
    if nav.engaged {
        nav.count = 4;
        nav.kind = Some(wp.kind);
        nav.distance_m = Some(dn.hypot(de));
        nav.bearing_rad = Some(de.atan2(dn).rem_euclid(std::f64::consts::TAU));
        nav.xte_m = Some(0.31);
        nav.l1_mode = Some(L1Mode::Track);
        nav.aim_ne = Some(Vector2::new(flight.n + dn * 0.3, flight.e + de * 0.3));
        nav.home_distance_m = Some(flight.n.hypot(flight.e));
        nav.fence_margin_m = Some(500.0 - flight.n.hypot(flight.e));
        nav.eta_s = (flight.state == NavState::Approaching).then(|| dn.hypot(de) / flight.speed.max(0.5));
        nav.hold_remaining_s = Some(flight.hold_s);
        nav.guards = flight.guards.iter().copied().collect();
        let from = usize::from(flight.wp).checked_sub(1).map_or(HOME, |wp| plan.waypoints[wp].position);
        nav.leg_start = Some(from);
        snapshot.active_plan = Some(plan.clone());
    }
    snapshot.stored_plan = Some(plan);
    snapshot.settings = Some(SettingsView {
        profile: betadeck::telemetry::FirmwareProfile::Guide,
        arrival_radius_m: 5.0,
        hold_radius_m: 2.0,
        orbit_radius_m: 10.0,
        figure8_width_m: 20.0,
        fence_m: Some(500.0),
        max_angle_deg: 25.0,
        max_velocity_mps: 5.0,
        max_turn_rate_dps: 3.0,
        climb_mps: 5.0,
        landing_mps: 0.5,
        landing_alt_m: 4.0,
        min_nav_alt_m: 5.0,
        buildup_deg: 8.0,
        position_p: 30.0,
        return_flight: betadeck::plan::estimate::ReturnFlight::default(),
        touchdown_throttle: betadeck::plan::estimate::TouchdownThrottle::default(),
        hover_stick_us: 1500,
        raised_stick_us: 1300,
        sink_stick_us: Some(1410),
    });
    let endpoint = |kind, state| EndpointStatus { kind, address: String::new(), state };
    let clients = |clients| EndpointState::Clients(ClientStats { clients, ..ClientStats::default() });
    SessionView {
        vehicle: std::sync::Arc::new(snapshot),
        speed_wanted: 1.0,
        speed_achieved: 1.0,
        sticks: RcFrame::SAFE,
        endpoints: vec![
            endpoint(EndpointKind::WebSocket, clients(1)),
            endpoint(EndpointKind::Tcp, clients(0)),
            endpoint(EndpointKind::Rc, EndpointState::Packets(PacketStats::default())),
        ],
        ..SessionView::default()
    }
}

/// Sends an event with this time.
pub(crate) fn hear(state: &mut AppState, time_s: f64, kind: EventKind) {
    let event = Event { time: SimTime::from_secs_f64(time_s), kind: SessionEvent::Vehicle(kind) };
    update(state, Msg::Event(event));
}
