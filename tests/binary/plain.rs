//! `--plain`: the same flight as sentences, with commands on standard input and no terminal.

use crate::support::Sandbox;

const PLAIN: [&str; 4] = ["--plain", "--fresh", "--no-ports", "--speed=max"];

#[test]
fn commands_are_read_and_answered_in_their_order() {
    let sandbox = Sandbox::new();
    let input = "wnd 5@270\nwind 5@270\nset ap_max_angle=31\nset ap_max_angle\nhome\nquit\n";
    let ran = sandbox.run_with(&PLAIN, input).exits(0);
    let mut rest = ran.out.as_str();
    for part in
        ["did you mean wind?", "World: wind=5@270", "ap_max_angle set to 31", "ap_max_angle = 31", "disarmed"]
    {
        let at = rest.find(part).unwrap_or_else(|| panic!("no {part} in its place\n{}", ran.out));
        rest = &rest[at + part.len()..];
    }
    assert!(ran.out.lines().any(|line| line.contains(" s  Booted: airframe iris")), "{}", ran.out);
    assert!(!ran.out.contains('\u{1b}'), "no escape sequence\n{}", ran.out);
    assert_eq!(sandbox.names(), Vec::<String>::new());
}

#[test]
fn help_lists_the_commands_and_a_wrong_plan_is_an_input_error() {
    let sandbox = Sandbox::new();
    let ran = sandbox.run_with(&PLAIN, "help\nquit\n").exits(0);
    assert!(ran.out.contains("wind SPEED@FROM") && ran.out.contains("flight.fly — "), "{}", ran.out);
    sandbox.run_with(&["--plain", "no-such-file.toml"], "").exits(3);
}
