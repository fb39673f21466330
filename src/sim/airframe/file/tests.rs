//! Airframe files: complete, incomplete and wrong ones.

use super::*;

const WHOLE: &str = r#"
name = "copy"
mass_kg = 0.53
inertia_kgm2 = [0.00683, 0.00611, 0.01063]
rotor_pos_m_M1_to_M4_flu_from_com = [[-0.13, -0.2, 0.01866], [0.13, -0.22, 0.01866], [-0.13, 0.2, 0.01866], [0.13, 0.22, 0.01866]]
spin_sign_ccw_positive = [-1, 1, 1, -1]
k_t_N_per_rad2s2 = 1.06202e-5
kappa_m_torque_over_thrust = 0.016
j_rotor_kgm2 = 2.65e-5
k_z_inflow_kg_per_rad = 2e-4
k_d_rotor_drag_kg_per_rad = 8.06e-5
c_par_N_per_m2s2 = [0.006, 0.006, 0.012]
k_w_Nm_per_rads = [0.002, 0.002, 0.002]
omega_max_rads = 696
tau_up_s = 0.01197
tau_down_s = 0.01197
contact_points_m_flu_from_com = [[0.235, 0.235, -0.19934], [0.235, -0.235, -0.19934], [-0.235, 0.235, -0.19934], [-0.235, -0.235, -0.19934]]
k_n_N_per_m_per_point = 1299.4
c_n_Ns_per_m_per_point = 9.2
mu = 1.0

[battery]
cells = 3
resistance_ohm = 0.03
capacity_ah = 3.3
"#;

fn errors(text: &str) -> Vec<String> {
    let error = Airframe::from_toml(text).expect_err("a problem");
    error.problems.iter().map(|p| format!("{}:{}: {}", p.line, p.column, p.text)).collect()
}

#[test]
fn a_whole_file_is_an_airframe() {
    let read = Airframe::from_toml(WHOLE).unwrap_or_else(|error| panic!("{error}"));
    // The nominal voltage is the result of 3.7·3 in floating point.
    let nominal_v = read.battery.nominal_v;
    assert!((nominal_v - 11.1).abs() < 1e-9);
    let mut want = Airframe { name: "copy".to_owned(), ..Airframe::iris() };
    want.battery.nominal_v = nominal_v;
    assert_eq!(read, want);
}

#[test]
fn a_base_supplies_what_is_missing() {
    let read = Airframe::from_toml("base = \"five-inch\"\nmass_kg = 0.8\n").unwrap();
    assert_eq!(read, Airframe { mass_kg: 0.8, ..Airframe::five_inch() });
}

#[test]
fn every_key_but_the_optional_ones_is_required() {
    assert_eq!(errors("").len(), KEYS.iter().filter(|key| key.required).count());
    assert!(errors("").iter().any(|e| e.contains("mass_kg is missing")));
}

#[test]
fn problems_name_place_and_key() {
    let with = |line: &str| errors(&format!("base = \"iris\"\n{line}"));
    for (line, want) in [
        ("mass_kg = \"1\"", "2:11: mass_kg must be a number, not a TOML string"),
        ("mass_kg = -1", "2:11: mass_kg must be greater than 0, not -1"),
        ("mass_kg = nan", "2:11: mass_kg must be a finite number"),
        ("mass = 1", "2:1: mass is not a key of an airframe file"),
        ("mas_kg = 1", "2:1: mas_kg is not a key of an airframe file; did you mean mass_kg?"),
        ("inertia_kgm2 = [1, 2]", "2:16: inertia_kgm2 must be three numbers: [x, y, z], not 2 of them"),
        ("spin_sign_ccw_positive = [1, -1, -1, 1]", "2:26: spin_sign_ccw_positive must be [-1, 1, 1, -1]"),
        ("[battery]\ncells = 2.5", "3:9: battery.cells must be a whole number of cells, not 2.5"),
        ("[battery]\nvolts = 2", "3:1: battery.volts is not a key"),
        ("battery = 3", "2:11: battery must be a table"),
        ("mass_kg =", "2:10: "),
    ] {
        let found = with(line);
        assert!(found.len() == 1 && found[0].starts_with(want), "{line}: {found:?}");
    }
    assert!(errors("base = \"irsi\"")[0].contains("did you mean iris?"));
}

#[test]
fn the_message_shows_the_line_with_a_caret() {
    let error = Airframe::from_toml("base = \"iris\"\ntau_up_s = 0\n").unwrap_err();
    assert_eq!(
        error.in_file("x.toml"),
        "x.toml:2:12: tau_up_s must be at least 0.002, not 0\n  tau_up_s = 0\n             ^"
    );
}

#[test]
fn many_problems_in_one_long_line_are_counted_and_some_are_shown() {
    let keys: Vec<String> = (0..5000).map(|at| format!("key{at}=1")).collect();
    let error = Airframe::from_toml(&format!("battery = {{{}}}", keys.join(","))).unwrap_err();
    assert_eq!(error.problems.len(), MAX_LISTED);
    let message = error.to_string();
    let missing = KEYS.iter().filter(|key| key.required).count();
    assert!(message.ends_with(&format!("\nand {} more problems", 5000 + missing - MAX_LISTED)), "{message}");
    assert!(message.len() < 100_000, "{} bytes", message.len());

    let far_right = format!("base = \"iris\"\nbattery = {{{}volts = 2}}", " ".repeat(70_000));
    let message = Airframe::from_toml(&far_right).unwrap_err().to_string();
    assert!(message.starts_with("2:70012: battery.volts is not a key"), "{message}");
    assert!(message.ends_with(&format!("\n  {}^", " ".repeat(101))), "{message}");
}

proptest::proptest! {
    #[test]
    fn any_text_is_read_or_refused_without_panic(text in "(.|\n){0,80}", key in 0usize..KEYS.len()) {
        let _ = Airframe::from_toml(&text);
        let _ = Airframe::from_toml(&format!("{} = {text}", KEYS[key].name));
    }
}
