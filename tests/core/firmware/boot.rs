//! Boot, arming and restart of the firmware on a bench: level, still, with a fix.

use betadeck_core::firmware::cli::Interpreter;
use betadeck_core::firmware::config::{Configuration, MixerKind};
use betadeck_core::firmware::{Firmware, FirmwareOptions};
use betadeck_core::geo::LatLon;
use betadeck_core::signals::{GpsSample, RcFrame, RcSource, SensorFrame, SimTime};
use betadeck_core::telemetry::{DisarmReason, FirmwareEvent, FirmwareNotice};

/// A firmware on a bench.
struct Bench {
    firmware: Firmware,
    sticks: RcFrame,
    time: SimTime,
    events: Vec<FirmwareEvent>,
}

impl Bench {
    fn new() -> Self {
        let mut configuration = Configuration::default();
        configuration.starter_modes();
        Self {
            firmware: Firmware::new(configuration, FirmwareOptions::default()),
            sticks: RcFrame::SAFE,
            time: SimTime::ZERO,
            events: Vec::new(),
        }
    }

    fn run(&mut self, until_s: f64) -> &mut Self {
        while self.time.as_secs_f64() < until_s {
            if self.time.0.is_multiple_of(20_000) {
                self.firmware.receive_rc(&self.sticks, RcSource::Sticks);
            }
            let fix = GpsSample {
                fix: true,
                sats: 12,
                position: LatLon::new(404_635_000, -795_182_000),
                alt_amsl_cm: 30_000,
                ..GpsSample::default()
            };
            let frame = SensorFrame {
                time: self.time,
                pressure_pa: (self.time.0.is_multiple_of(20_000)).then_some(97_772.0),
                mag_flu: (self.time.0.is_multiple_of(10_000))
                    .then(|| nalgebra::Vector3::new(2046.8, -71.5, -3547.2)),
                gps: (self.time.0.is_multiple_of(100_000)).then_some(fix),
                ..SensorFrame::default()
            };
            self.firmware.step(&frame);
            while let Some(event) = self.firmware.take_event() {
                self.events.push(event);
            }
            self.time.0 += 1000;
        }
        self
    }

    fn flags(&self) -> String {
        let names: Vec<_> = self.firmware.arming_flags().iter().map(|flag| flag.to_string()).collect();
        names.join(" ")
    }

    fn type_line(&mut self, line: &str) -> String {
        let reply = self.firmware.run_cli(&mut Interpreter::default(), line);
        assert!(!reply.failed, "{line}: {}", reply.text);
        reply.text
    }
}

#[test]
fn flags_go_one_by_one_after_boot() {
    let mut bench = Bench::new();
    for (at, flags) in [
        (0.1, "RXLOSS BOOTGRACE CALIB"),
        (0.45, "RXLOSS BOOTGRACE CALIB"),
        (0.55, "BOOTGRACE CALIB"),
        (1.2, "BOOTGRACE CALIB"),
        (1.3, "BOOTGRACE"),
        (4.97, "BOOTGRACE"),
        (5.03, ""),
    ] {
        bench.run(at);
        assert_eq!(bench.flags(), flags, "{at}");
    }
}

#[test]
fn arms_by_the_switch_and_disarms_by_it() {
    let mut bench = Bench::new();
    bench.run(5.1);
    bench.sticks.channels[4] = 2000;
    bench.run(5.2);
    assert!(bench.firmware.is_armed());
    assert_eq!(bench.firmware.home(), Some(LatLon::new(404_635_000, -795_182_000)));
    bench.sticks.channels[4] = 1000;
    bench.run(5.26);
    assert!(bench.firmware.is_armed(), "three frames are not enough");
    bench.run(5.4);
    assert_eq!(bench.firmware.last_disarm(), Some(DisarmReason::Switch));
}

#[test]
fn switch_that_comes_too_early_must_be_cycled() {
    let mut bench = Bench::new();
    bench.sticks.channels[4] = 2000;
    bench.run(7.0);
    assert_eq!(bench.flags(), "NOT_DISARMED ARM_SWITCH");
    bench.sticks.channels[4] = 1000;
    bench.run(7.1);
    assert_eq!(bench.flags(), "");
    bench.sticks.channels[4] = 2000;
    bench.run(7.2);
    assert!(bench.firmware.is_armed());
}

#[test]
fn restart_boots_again_and_drops_what_was_not_stored() {
    let mut bench = Bench::new();
    bench.run(5.1);
    let stored = bench.firmware.configuration().clone();
    bench.type_line("set ap_max_angle = 33");
    bench.type_line("set max_aux_channels = 8");
    bench.firmware.cli_opened();
    bench.sticks.channels[4] = 2000;
    bench.run(5.2);
    assert_eq!(bench.flags(), "CLI REBOOT_REQD ARM_SWITCH");
    bench.sticks.channels[4] = 1000;
    bench.firmware.restart(stored);
    bench.run(6.0);
    assert_eq!(bench.flags(), "BOOTGRACE CALIB");
    bench.run(10.3);
    assert_eq!(bench.flags(), "");
    assert_ne!(bench.firmware.parameters().nav.max_angle, 33);
    assert!(bench.type_line("status").contains("System Uptime: 5 seconds"));
}

#[test]
fn restart_in_flight_disarms_with_its_reason() {
    let mut bench = Bench::new();
    bench.run(5.1);
    bench.sticks.channels[4] = 2000;
    bench.run(5.2);
    bench.firmware.restart_in_place();
    bench.run(5.3);
    assert!(bench.events.contains(&FirmwareEvent::Disarmed(DisarmReason::System)));
    assert!(!bench.firmware.is_armed());
}

#[test]
fn settings_and_switches_typed_in_are_in_force_at_once_but_boot_choices_wait() {
    let mut bench = Bench::new();
    bench.run(5.1);
    bench.type_line("set ap_max_angle = 33");
    bench.type_line("aux 0 0 7 1700 2100 0 0");
    bench.type_line("set max_aux_channels = 10");
    assert_eq!(bench.firmware.parameters().nav.max_angle, 33);
    bench.sticks.channels[11] = 2000;
    bench.run(5.3);
    assert!(!bench.firmware.is_armed(), "channel 12 is not looked at before the restart");
    bench.firmware.restart_in_place();
    bench.sticks.channels[11] = 1000;
    bench.run(10.5);
    bench.sticks.channels[11] = 2000;
    bench.run(10.7);
    assert!(bench.firmware.is_armed());
}

#[test]
fn virtual_sticks_give_way_to_udp_unless_they_take_over() {
    let mut bench = Bench::new();
    bench.run(1.0);
    let mut script = RcFrame::SAFE;
    script.channels[0] = 1700;
    bench.firmware.receive_rc(&script, RcSource::Udp);
    bench.run(1.05);
    assert_eq!(bench.firmware.craft_view().channels.unwrap()[0], 1700);
    assert_eq!(bench.firmware.craft_view().rc_source, Some(RcSource::Udp));
    bench.firmware.take_over_sticks(true);
    bench.run(1.1);
    assert_eq!(bench.firmware.craft_view().channels.unwrap()[0], 1500);
}

#[test]
fn view_lists_channels_in_wire_order() {
    let mut bench = Bench::new();
    bench.sticks.channels[..4].copy_from_slice(&[1100, 1200, 1300, 1400]);
    bench.run(0.1);
    assert_eq!(bench.firmware.craft_view().channels.unwrap()[..4], [1100, 1200, 1300, 1400]);
}

#[test]
fn motor_command_turns_motors_until_the_session_ends() {
    let mut bench = Bench::new();
    bench.run(1.0);
    bench.type_line("motor 1 1200");
    bench.run(1.01);
    assert_eq!(bench.firmware.craft_view().motors, Some([0.0, 0.2, 0.0, 0.0]));
    bench.firmware.cli_closed();
    bench.run(1.02);
    assert_eq!(bench.firmware.craft_view().motors, Some([0.0; 4]));
}

#[test]
fn mixer_that_cannot_fly_is_reported_at_boot() {
    let configuration = Configuration { mixer: MixerKind::Hex6, ..Configuration::default() };
    let mut firmware = Firmware::new(configuration, FirmwareOptions::default());
    assert!(matches!(firmware.take_event(), Some(FirmwareEvent::Notice(_))));
    assert_eq!(firmware.take_event(), None);
}

#[test]
fn tasks_and_smoothing_tell_the_rates_of_this_firmware() {
    let mut bench = Bench::new();
    bench.type_line("set pid_process_denom = 2");
    bench.type_line("set imu_process_denom = 4");
    let running = bench.type_line("tasks");
    let rate = |tasks: &str, name: &str| {
        let row = tasks.lines().find(|line| line.contains(&format!("{name})"))).expect("a row");
        row[22..].split_ascii_whitespace().next().expect("a rate").to_owned()
    };
    assert_eq!((rate(&running, "GYRO"), rate(&running, "PID")), ("1000".to_owned(), "1000".to_owned()));
    assert_eq!(rate(&running, "ATTITUDE"), "250", "in force at once");
    bench.firmware.restart_in_place();
    let restarted = bench.type_line("tasks");
    assert_eq!((rate(&restarted, "GYRO"), rate(&restarted, "PID")), ("1000".to_owned(), "500".to_owned()));
    bench.run(3.0);
    let info = bench.type_line("rc_smoothing_info");
    assert!(info.contains("50Hz") && info.contains("FF cutoff: 19Hz (auto)"), "{info}");
    bench.type_line("set rc_smoothing_setpoint_cutoff = 33");
    bench.run(3.1);
    assert!(bench.type_line("rc_smoothing_info").contains("FF cutoff: 33Hz (manual)"));
}

#[test]
fn losing_the_gps_to_a_real_quads_receiver_is_reported() {
    let reported = |bench: &Bench| {
        bench
            .events
            .iter()
            .filter(|event| matches!(event, FirmwareEvent::Notice(FirmwareNotice::GpsSwitchedOff)))
            .count()
    };
    let mut bench = Bench::new();
    bench.run(0.1);
    bench.type_line("set gps_provider = UBLOX");
    bench.run(0.2);
    assert_eq!(reported(&bench), 0, "not before it happens");
    bench.type_line("save");
    bench.run(0.3);
    assert_eq!(reported(&bench), 1);
    bench.firmware.restart_in_place();
    bench.run(0.4);
    assert_eq!(reported(&bench), 1, "it was off already");
    let mut asked = Configuration::default();
    let provider = betadeck_core::firmware::settings::find("gps_provider").expect("a setting");
    asked.settings.assign(provider, "UBLOX").expect("a provider");
    bench.firmware.restart(asked);
    bench.run(0.5);
    assert_eq!(reported(&bench), 2);
}

#[test]
fn a_value_that_current_firmware_refuses_is_taken_with_a_notice() {
    let reported = |bench: &Bench| -> Vec<String> {
        let notices = bench.events.iter().filter_map(|event| match event {
            FirmwareEvent::Notice(notice @ FirmwareNotice::BeyondCurrentFirmware { .. }) => {
                Some(notice.to_string())
            }
            _ => None,
        });
        notices.collect()
    };
    let mut bench = Bench::new();
    bench.run(0.1);
    assert_eq!(bench.type_line("set ap_position_cutoff = 5"), "ap_position_cutoff set to 5");
    bench.run(0.2);
    let notice =
        "ap_position_cutoff = 5 is taken here, but current Betaflight refuses it: it allows 10 to 50.";
    assert_eq!(reported(&bench), [notice]);
    bench.type_line("set ap_position_cutoff = 20");
    bench.run(0.3);
    assert_eq!(reported(&bench).len(), 1, "a value that current firmware takes");
    bench.type_line("set ap_velocity_drag_coeff = 101");
    bench.run(0.4);
    assert_eq!(reported(&bench).len(), 2);
}

#[test]
fn get_says_that_a_setting_has_no_effect_and_set_answers_as_before() {
    let mut bench = Bench::new();
    bench.run(0.1);
    let block = "ap_nav_preturn_dist = 1500\r\nAllowed range: 500 - 5000\r\n";
    assert_eq!(bench.type_line("get ap_nav_preturn_dist"), format!("{block}No effect here\r\n"));
    assert_eq!(bench.type_line("set ap_nav_preturn_dist"), block);
    assert!(!bench.type_line("get ap_max_velocity").contains("No effect"));
}
