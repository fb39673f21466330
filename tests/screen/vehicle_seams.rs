//! The seams of a vehicle: a flight controller connected by a mailbox flies the simulated world, and values that it
//! does not report are unknown.
#![allow(clippy::unwrap_used, reason = "a test may stop")]

use betadeck::firmware::FirmwareOptions;
use betadeck::firmware::config::Configuration;
use betadeck::report::json;
use betadeck::session::SessionView;
use betadeck::signals::{RcFrame, RcSource};
use betadeck::sim::{WorldCommand, WorldConfig};
use betadeck::telemetry::Snapshot;
use betadeck::ui::{AppState, Msg, update};
use betadeck::vehicle::{
    Answer, FrameOut, LateAnswer, RemoteTelemetry, Vehicle, VehicleCommand, VehicleConfig,
};

mod clients;
mod stand_in;

use crate::ui::fixture;
use stand_in::{DELAY, StandIn};

const THROTTLE: usize = 2;
const ARM: usize = 4;
const LEVELLED: usize = 6;

/// A craft in the simulated world with the stand-in as its flight controller.
#[derive(Debug, Clone)]
struct Rig {
    vehicle: Vehicle,
    stand_in: StandIn,
}

impl Rig {
    fn new() -> Self {
        let vehicle = Vehicle::with_remote_controller(WorldConfig::default()).unwrap();
        Self { vehicle, stand_in: StandIn::new() }
    }

    fn run(&mut self, seconds: f64) {
        for _ in 0..(seconds * 1000.0) as usize {
            self.vehicle.tick();
            self.stand_in.exchange(self.vehicle.remote_mut().unwrap());
        }
    }

    fn set(&mut self, channel: usize, us: u16) {
        let mut sticks = self.vehicle.transmitter().sticks();
        sticks.channels[channel] = us;
        self.vehicle.apply(&VehicleCommand::Sticks(sticks));
    }

    /// Arms and climbs in ALTHOLD, then hovers.
    fn hover(&mut self) {
        // Waits for the boot grace, the calibration and the first fix.
        self.run(10.0);
        self.set(ARM, 2000);
        self.run(0.5);
        assert!(self.stand_in.firmware.is_armed(), "{:?}", self.stand_in.firmware.arming_flags());
        self.set(THROTTLE, 1600);
        self.run(0.5);
        self.set(LEVELLED, 2000);
        self.set(THROTTLE, 1900);
        self.run(5.0);
        self.set(THROTTLE, self.stand_in.firmware.hover_stick_us());
        self.run(6.0);
    }
}

fn truth_altitude(snapshot: &Snapshot) -> f64 {
    snapshot.truth.unwrap().alt
}

#[test]
fn a_remote_flight_controller_flies_the_simulated_world() {
    let mut rig = Rig::new();
    rig.hover();
    let hovering = rig.vehicle.snapshot();
    let truth = hovering.truth.unwrap();
    assert!((1.0..30.0).contains(&truth.alt), "{truth:?}");
    assert!(truth.vu.abs() < 0.5 && truth.roll_deg.abs() < 10.0 && truth.pitch_deg.abs() < 10.0, "{truth:?}");
    assert!(
        hovering.craft.motors.is_some_and(|motors| motors.iter().all(|&motor| motor > 0.1)),
        "{:?}",
        hovering.craft.motors
    );
    assert!((hovering.estimate.pitch_deg.unwrap() - truth.pitch_deg).abs() < 3.0, "its attitude arrives");
    rig.run(2.0);
    assert!((truth_altitude(&rig.vehicle.snapshot()) - truth.alt).abs() < 2.0, "it holds the altitude");
}

#[test]
fn a_copy_of_the_vehicle_goes_on_identically() {
    let mut rig = Rig::new();
    rig.hover();
    let mut copy = rig.clone();
    rig.run(2.0);
    copy.run(2.0);
    assert_eq!(rig.vehicle.snapshot(), copy.vehicle.snapshot());
}

#[test]
fn a_remote_flight_controller_hears_one_transmitter_at_a_time() {
    let mut rig = Rig::new();
    let sources = |rig: &mut Rig, script: Option<u16>, frames: u32| {
        let mut seen = Vec::new();
        for _ in 0..frames {
            if let Some(roll_us) = script {
                let mut frame = RcFrame::SAFE;
                frame.channels[0] = roll_us;
                rig.vehicle.apply(&VehicleCommand::Rc(frame, RcSource::Udp));
            }
            for _ in 0..20 {
                rig.vehicle.tick();
                let mailbox = rig.vehicle.remote_mut().unwrap();
                while let Some(frame) = mailbox.take_frame() {
                    if let FrameOut::Rc(frame, source) = frame {
                        seen.push((source, frame.channels[0]));
                    }
                }
            }
        }
        seen
    };
    assert_eq!(sources(&mut rig, None, 3), [(RcSource::Sticks, 1500); 3]);
    assert_eq!(sources(&mut rig, Some(1600), 20), [(RcSource::Udp, 1600); 20]);
    assert_eq!(rig.vehicle.controller().rc_source(), None, "it has not reported that it takes RC from here");
    let reported = RemoteTelemetry { takes_rc: true, ..RemoteTelemetry::default() };
    rig.vehicle.remote_mut().unwrap().deliver_telemetry(reported);
    assert_eq!(rig.vehicle.snapshot().craft.rc_source, Some(RcSource::Udp));
    assert!(rig.vehicle.snapshot().craft.rc_age_s.unwrap() < 0.1);
    rig.vehicle.apply(&VehicleCommand::SticksFirst(true));
    assert_eq!(sources(&mut rig, Some(1600), 3).last(), Some(&(RcSource::Sticks, 1500)));
    rig.vehicle.apply(&VehicleCommand::SticksFirst(false));
    let after = sources(&mut rig, None, 30);
    assert_eq!(after.last(), Some(&(RcSource::Sticks, 1500)), "the script is gone");
}

#[test]
fn a_command_line_is_answered_later_by_its_ticket() {
    let mut rig = Rig::new();
    let mut ask = |line: &str| match rig.vehicle.apply(&VehicleCommand::single_line(line)) {
        Answer::Later(ticket) => ticket,
        Answer::Now(reply) => panic!("{reply:?}"),
    };
    let (first, second) = (ask("get ap_max_angle"), ask("nonsense"));
    assert_eq!(rig.vehicle.take_answer(), None);
    rig.run(0.001 * (DELAY + 2) as f64);
    let Some((ticket, LateAnswer::Cli(reply))) = rig.vehicle.take_answer() else { panic!() };
    assert!(ticket == first && reply.text.contains("ap_max_angle = "), "{reply:?}");
    let Some((ticket, LateAnswer::Cli(reply))) = rig.vehicle.take_answer() else { panic!() };
    assert!(ticket == second && reply.failed, "{reply:?}");
}

#[test]
fn what_the_flight_controller_does_not_tell_is_shown_as_unknown() {
    let mut rig = Rig::new();
    rig.run(1.0);
    let snapshot = rig.vehicle.snapshot();
    assert!(snapshot.nav.is_none() && snapshot.settings.is_none() && snapshot.stored_plan.is_none());
    assert!(snapshot.craft.arming_blocked_by.is_none() && snapshot.craft.rc_link.is_none());
    assert_eq!((snapshot.estimate.alt, snapshot.estimate.climb_mps), (None, None));
    let line = json::sample_line(&snapshot);
    for unknown in ["state", "l1_mode", "est_alt", "throttle_us", "hold_remaining_ds", "target_alt"] {
        assert!(line.contains(&format!("\"{unknown}\":null")), "{unknown} in {line}");
    }
    let screen = screen(snapshot);
    assert!(screen.contains("◆ — "), "the state of the machine:\n{screen}");
    assert!(screen.contains("— m/s") && screen.contains("reports no state"), "{screen}");
}

#[test]
fn a_silent_flight_controller_is_shown_as_unknown_and_not_as_disarmed() {
    let vehicle = Vehicle::with_remote_controller(WorldConfig::default()).unwrap();
    let screen = screen(vehicle.snapshot());
    for unknown in
        [" ○ — ", "⊕ —   — sats", " — V ", "The flight controller does not report", "— on the craft?"]
    {
        assert!(screen.contains(unknown), "{unknown}:\n{screen}");
    }
    for claim in ["ARMED", "No GPS", "Arming is blocked", "not on the craft", "Ready"] {
        assert!(!screen.contains(claim), "{claim}:\n{screen}");
    }
}

#[test]
fn unknown_wind_is_unknown_and_not_calm() {
    let mut vehicle = Vehicle::with_external_physics(VehicleConfig {
        world: WorldConfig::default(),
        firmware: FirmwareOptions::default(),
        configuration: Configuration::default(),
        live: true,
    })
    .unwrap();
    vehicle.tick();
    vehicle.see(betadeck::signals::Pose {
        place_deg: Some((40.0, -79.5)),
        alt_m: 250.0,
        vel_enu: nalgebra::Vector3::zeros(),
        attitude: nalgebra::UnitQuaternion::identity(),
    });
    let snapshot = vehicle.snapshot();
    assert!(snapshot.truth.is_some());
    let line = json::sample_line(&snapshot);
    assert!(line.contains(r#""wind_n":null,"wind_e":null"#), "{line}");
    let screen = screen(snapshot);
    assert!(screen.contains("wind —") && !screen.contains("calm"), "{screen}");
}

fn screen(snapshot: Snapshot) -> String {
    let mut state: AppState = fixture::state((120, 40), fixture::colour());
    let vehicle = std::sync::Arc::new(snapshot);
    update(&mut state, Msg::View(SessionView { vehicle, ..SessionView::default() }));
    crate::ui::hands::screen(&state)
}

#[test]
fn rx_jitter_drops_its_fraction_of_the_rc_frames() {
    for (fault, expected) in [(None, 1000..=1000), (Some("fault=rx-jitter,,0.2"), 740..=860)] {
        let mut vehicle = Vehicle::with_remote_controller(WorldConfig::default()).unwrap();
        if let Some(fault) = fault {
            vehicle.apply(&VehicleCommand::from(WorldCommand::parse(fault).unwrap())).accepted().unwrap();
        }
        let mut frames = 0;
        for _ in 0..20_000 {
            vehicle.tick();
            let mailbox = vehicle.remote_mut().unwrap();
            while let Some(frame) = mailbox.take_frame() {
                frames += usize::from(matches!(frame, FrameOut::Rc(..)));
            }
        }
        assert!(expected.contains(&frames), "{frames} frames of 1000 with {fault:?}");
    }
}

#[test]
fn the_altitude_shown_is_zero_where_the_craft_is() {
    let vehicle = Vehicle::with_remote_controller(WorldConfig::default()).unwrap();
    assert!(truth_altitude(&vehicle.snapshot()).abs() < 0.02, "{:?}", vehicle.snapshot().truth);
}
