use super::*;
use crate::firmware::estimate::DueTasks;

const DT: f64 = 0.001;
const DUE: DueTasks = DueTasks { attitude: true, navigation: false };

fn flying() -> ControlInput {
    ControlInput { armed: true, airmode: true, throttle_us: 1525.0, due: DUE, ..ControlInput::default() }
}

fn run(controller: &mut Controller, input: &ControlInput, steps: usize) -> ControlState {
    for _ in 0..steps {
        controller.step(input, &Estimate::default(), DT);
    }
    *controller.state()
}

#[test]
fn disarmed_motors_stand_or_follow_the_motor_command() {
    let mut controller = Controller::new(Tuning::default(), DT);
    assert_eq!(run(&mut controller, &ControlInput::default(), 10).motors.0, [0.0; 4]);
    let test = ControlInput { motor_test_us: [1100.0, 1000.0, 1000.0, 1250.0], ..ControlInput::default() };
    assert_eq!(run(&mut controller, &test, 1).motors.0, [0.1, 0.0, 0.0, 0.25]);
}

#[test]
fn half_stick_is_half_throttle_above_idle() {
    let mut controller = Controller::new(Tuning::default(), DT);
    let state = run(&mut controller, &flying(), 1000);
    for motor in state.motors_us {
        assert!((motor - (1055.0 + 945.0 * 0.5)).abs() < 0.1, "{motor}");
    }
    assert!((state.throttle_us - 1525.0).abs() < 0.1);
}

#[test]
fn right_sticks_roll_right_pitch_down_and_turn_clockwise() {
    for (stick, raised) in [(0, [2, 3]), (1, [0, 2]), (2, [1, 2])] {
        let mut controller = Controller::new(Tuning::default(), DT);
        let mut input = flying();
        *[&mut input.stick_roll, &mut input.stick_pitch, &mut input.stick_yaw][stick] = 100.0;
        let state = run(&mut controller, &input, 300);
        let mean = state.motors_us.iter().sum::<f64>() / 4.0;
        for (motor, pulse) in state.motors_us.iter().enumerate() {
            assert_eq!(*pulse > mean, raised.contains(&motor), "stick {stick} motor {motor}");
        }
        assert!(state.setpoint_dps[stick] > 10.0);
    }
}

#[test]
fn a_demanded_tilt_takes_the_place_of_the_sticks() {
    let mut controller = Controller::new(Tuning::default(), DT);
    let tilt = crate::firmware::control::TiltDemand { roll_rad: 0.2, pitch_down_rad: -0.1 };
    let input = ControlInput { tilt: Some(tilt), stick_roll: -500.0, throttle: Some(0.4), ..flying() };
    let state = run(&mut controller, &input, 100);
    assert!(state.setpoint_dps[0] > 0.0 && state.setpoint_dps[1] < 0.0);
    let [roll, pitch] = state.angle_demand_rad.unwrap();
    assert!((roll - 0.2).abs() < 1e-9 && (pitch + 0.1).abs() < 1e-9);
    assert!((state.throttle_us - (1050.0 + 950.0 * 0.4)).abs() < 0.1);
}

#[test]
fn integrals_are_empty_before_the_throttle_is_raised() {
    let mut controller = Controller::new(Tuning::default(), DT);
    let low = ControlInput { airmode: false, throttle_us: 1000.0, stick_yaw: 100.0, ..flying() };
    run(&mut controller, &low, 500);
    let once = controller.state().pid_sum[2];
    run(&mut controller, &low, 500);
    assert!((controller.state().pid_sum[2] - once).abs() < 0.2);
    let stopped = ControlInput { motor_stop: true, ..low };
    assert_eq!(run(&mut controller, &stopped, 1).motors_us, [1000.0; 4]);
}

#[test]
fn a_slower_rate_loop_hears_every_fresh_attitude() {
    let mut settings = crate::firmware::settings::Settings::default();
    settings.set_number("pid_process_denom", 2).unwrap();
    let tuning = Tuning::from_settings(&settings, crate::firmware::config::MixerKind::QuadX, &[]);
    for first in 0..2 {
        let mut controller = Controller::new(tuning, DT);
        for step in 0..20 {
            let due = DueTasks { attitude: step % 2 == first, navigation: false };
            let input = ControlInput { mode: StickMode::Angle, stick_roll: 200.0, due, ..flying() };
            controller.step(&input, &Estimate::default(), DT);
        }
        assert!(controller.state().setpoint_dps[0] > 1.0);
    }
}

/// Creates a controller with these settings.
fn tuned(changes: &[(&str, i64)]) -> Controller {
    let mut settings = crate::firmware::settings::Settings::default();
    for (name, value) in changes {
        settings.set_number(name, *value).unwrap();
    }
    let kind = crate::firmware::config::MixerKind::QuadX;
    Controller::new(Tuning::from_settings(&settings, kind, &[]), DT)
}

#[test]
fn a_limited_acceleration_lets_the_setpoint_follow_the_stick_slowly() {
    let reached = [0, 50, 20, 5].map(|limit| {
        let mut controller = tuned(&[("acc_limit", limit), ("acc_limit_yaw", limit)]);
        let input = ControlInput { stick_roll: 500.0, stick_yaw: 500.0, rc_frame: true, ..flying() };
        run(&mut controller, &input, 100).setpoint_dps
    });
    for axis in [0, 2] {
        assert!(reached.windows(2).all(|pair| pair[0][axis] > pair[1][axis] + 1.0), "{reached:?}");
        assert!((reached[3][axis] - 500.0 * 0.1).abs() < 1.0, "5 × 100 °/s² for 0.1 s: {reached:?}");
    }
    let mut controller = tuned(&[("acc_limit", 5)]);
    let input = ControlInput { stick_roll: 500.0, rc_frame: true, ..flying() };
    assert!((run(&mut controller, &input, 3000).setpoint_dps[0] - 670.0).abs() < 1.0, "it gets there");
}

#[test]
fn race_mode_levels_roll_and_leaves_pitch_to_the_stick() {
    for (race, angle) in [(0, Some(0)), (1, None)] {
        let mut controller = tuned(&[("level_race_mode", race)]);
        let input = ControlInput { mode: StickMode::Angle, stick_pitch: 250.0, rc_frame: true, ..flying() };
        let estimate = Estimate { roll_rad: 0.3, pitch_down_rad: 0.3, ..Estimate::default() };
        for _ in 0..500 {
            controller.step(&input, &estimate, DT);
        }
        let setpoint = controller.state().setpoint_dps;
        assert!(setpoint[0] < -10.0, "roll is levelled: {setpoint:?}");
        let by_rate = (setpoint[1] - Tuning::default().rates[1].rate_dps(0.5)).abs() < 1.0;
        assert_eq!(by_rate, angle.is_none(), "{setpoint:?}");
        let tilt = crate::firmware::control::TiltDemand { roll_rad: 0.0, pitch_down_rad: 0.0 };
        controller.step(&ControlInput { tilt: Some(tilt), ..input }, &estimate, DT);
        for _ in 0..100 {
            controller.step(&ControlInput { tilt: Some(tilt), ..input }, &estimate, DT);
        }
        assert!(controller.state().setpoint_dps[1] < -10.0, "the autopilot levels both");
    }
}

#[test]
fn tilt_adds_throttle_in_level_modes() {
    let throttle = |value: i64, tilt_deg: f64, mode: StickMode| {
        let mut controller = tuned(&[("thr_corr_value", value), ("thr_corr_angle", 400)]);
        let estimate = Estimate { cos_tilt: tilt_deg.to_radians().cos(), ..Estimate::default() };
        for _ in 0..500 {
            controller.step(&ControlInput { mode, ..flying() }, &estimate, DT);
        }
        controller.state().throttle_us
    };
    let plain = throttle(0, 40.0, StickMode::Angle);
    let by_tilt = [0.0, 10.0, 25.0, 40.0].map(|tilt| throttle(100, tilt, StickMode::Angle));
    assert!((by_tilt[0] - plain).abs() < 0.1);
    assert!(by_tilt.windows(2).all(|pair| pair[0] < pair[1]), "{by_tilt:?}");
    assert!((by_tilt[3] - plain - 95.0).abs() < 0.1, "a tenth of the throttle's 950 µs: {by_tilt:?}");
    assert!((throttle(100, 70.0, StickMode::Angle) - by_tilt[3]).abs() < 0.1);
    assert!((throttle(100, 40.0, StickMode::Acro) - plain).abs() < 0.1);
}

#[test]
fn a_punch_leads_the_throttle_unless_somebody_holds_it() {
    let highest = |held: Option<f64>, failsafe: bool| {
        let mut controller = tuned(&[("throttle_boost", 20)]);
        run(&mut controller, &ControlInput { throttle: held, failsafe, ..flying() }, 1000);
        let punch =
            ControlInput { throttle_us: 1800.0, rc_frame: true, throttle: held, failsafe, ..flying() };
        (0..300).map(|_| run(&mut controller, &punch, 1).throttle_us).fold(0.0, f64::max)
    };
    assert!(highest(None, false) > 1850.0);
    assert!(highest(None, true) < 1801.0);
    assert!((highest(Some(0.5), false) - 1525.0).abs() < 0.1);
}

#[test]
fn anti_gravity_pushes_harder_during_a_punch() {
    let integral = |anti_gravity: bool, held: Option<f64>| {
        let mut controller = tuned(&[("iterm_relax", 0)]);
        let mut estimate = Estimate::default();
        run(&mut controller, &flying(), 1000);
        estimate.rates.roll = -0.1;
        let input =
            ControlInput { throttle_us: 1900.0, anti_gravity, throttle: held, rc_frame: true, ..flying() };
        for _ in 0..200 {
            controller.step(&input, &estimate, DT);
        }
        controller.state().pid_sum[0]
    };
    assert!(integral(true, None) > integral(false, None) + 2.0);
    assert_eq!(integral(true, Some(0.5)), integral(false, Some(0.5)));
}

#[test]
fn a_new_flight_knows_nothing_of_the_throttle_of_the_last() {
    let landed = ControlInput { throttle_us: 1000.0, stick_roll: 100.0, anti_gravity: true, ..flying() };
    let first_sum = |flown: bool| {
        let mut controller = Controller::new(Tuning::default(), DT);
        if flown {
            run(&mut controller, &ControlInput { throttle_us: 1900.0, ..landed }, 1000);
        }
        // Long enough for the smoothed sticks; nothing that could reset the state runs meanwhile.
        run(&mut controller, &ControlInput { armed: false, ..landed }, 1000);
        run(&mut controller, &landed, 1).pid_sum[0]
    };
    assert!((first_sum(true) - first_sum(false)).abs() < 1e-6);
}

#[test]
fn gains_fall_with_throttle_and_before_take_off() {
    let mut controller = Controller::new(Tuning::default(), DT);
    assert!((controller.tpa(0.0) - 0.8).abs() < 1e-9);
    assert!((controller.tpa(0.2) - 1.0).abs() < 1e-9);
    assert!((controller.tpa(0.0) - 1.0).abs() < 1e-9);
    assert!((controller.tpa(1.0) - 0.35).abs() < 1e-9);
}

#[test]
fn a_limited_acceleration_bears_nonsense() {
    let mut controller = tuned(&[("acc_limit", 5)]);
    run(&mut controller, &ControlInput { stick_roll: f64::NAN, rc_frame: true, ..flying() }, 3);
}

#[test]
fn a_lost_gyro_leaves_finite_outputs() {
    let mut controller = Controller::new(Tuning::default(), DT);
    let mut estimate = Estimate::default();
    estimate.rates.roll = f64::NAN;
    for _ in 0..10 {
        let state = controller.step(&flying(), &estimate, DT);
        assert!(state.motors.0.iter().all(|motor| motor.is_finite()));
    }
}
