//! Flights on other processors.

use crate::binary::support::Sandbox;

/// The setting of the GNU C library that hides fused multiplication and wide vectors from it, as on an older processor.
const OLDER_PROCESSOR: (&str, &str) = ("GLIBC_TUNABLES", "glibc.cpu.hwcaps=-FMA,-AVX2,-FMA4,-AVX");

/// Flies a short noisy flight in turbulence. Returns its lines without the wall clock.
fn fly(environment: &[(&str, &str)]) -> Vec<String> {
    let sandbox = Sandbox::new();
    let arguments =
        ["fly", "land", "--json", "-", "--wind=4@200", "--gust=1", "--turbulence=light", "--seed=3"];
    let output = sandbox.command(&arguments).envs(environment.iter().copied()).output().expect("it runs");
    let out = String::from_utf8(output.stdout).expect("UTF-8");
    assert_eq!(output.status.code(), Some(0), "{out}");
    let mut lines: Vec<String> = out.lines().map(str::to_owned).collect();
    let end = lines.pop().expect("an end");
    let hash = end.split_once(",\"hash\":").expect("a hash").1;
    lines.push(hash.to_owned());
    lines
}

#[test]
fn a_flight_has_the_same_bits_on_an_older_processor() {
    let (here, there) = (fly(&[]), fly(&[OLDER_PROCESSOR]));
    assert!(here.len() > 10, "{here:?}");
    assert_eq!(here, there);
}
