use super::*;
use crate::args::{PhysicsChoice, Speed};

/// Returns the choice of a command with these options.
fn choice(
    args: &FirmwareArgs,
    flight: &FlightArgs,
    ports: &FirmwarePortArgs,
) -> (Result<Option<RemoteFirmware>, AppError>, Vec<String>) {
    let physics = PhysicsArgs::default();
    let mut notices = Vec::new();
    let beside = Beside { ports: ports.into(), flight, physics: &physics };
    (choose(args, beside, &mut notices), notices)
}

fn betaloop(file: PathBuf) -> FirmwareArgs {
    FirmwareArgs {
        link: FirmwareLinkArgs { betaloop: Some(file), ..FirmwareLinkArgs::default() },
        ..FirmwareArgs::default()
    }
}

#[test]
fn the_launchers_file_names_the_executable_and_what_is_not_used_is_reported() {
    let directory = tempfile::tempdir().expect("a directory");
    let own = std::env::current_exe().expect("a path");
    std::os::unix::fs::symlink(&own, directory.path().join("sitl.elf")).expect("a link");
    let file = directory.path().join("config.txt");
    std::fs::write(&file, "[Betaloop]\nWorld=x.sdf\nBetaflightElf=./sitl.elf\n").expect("written");
    let (found, notices) =
        choice(&betaloop(file.clone()), &FlightArgs::default(), &FirmwarePortArgs::default());
    let found = found.expect("found").expect("outside");
    assert_eq!(found.executable, Some(own.canonicalize().expect("a path")));
    assert_eq!((found.ports.tcp, found.ports.udp.fdm, found.ports.dialect), (5761, 9003, Dialect::SitlGz));
    assert_eq!(notices.len(), 1);
    assert!(notices[0].contains("Keys not used: World; the embedded physics flies"), "{notices:?}");

    let fast = FlightArgs { speed: Some(Speed(4.0)), ..FlightArgs::default() };
    let mut real = betaloop(file);
    let in_steps = choice(&real, &fast, &FirmwarePortArgs::default()).0.expect("found").expect("remote");
    assert_eq!(in_steps.clock, FirmwareClock::Sim);
    real.link.clock = Some(FirmwareClock::Real);
    let error = choice(&real, &fast, &FirmwarePortArgs::default()).0.expect_err("too fast");
    assert_eq!(error.code, 2);
    assert!(error.message.contains("--firmware embedded flies the embedded one)"), "{error}");
}

#[test]
fn a_file_that_is_asked_for_has_to_be_the_launchers() {
    let directory = tempfile::tempdir().expect("a directory");
    let file = directory.path().join("other.txt");
    let refusal = |file: &Path| {
        let (found, _) =
            choice(&betaloop(file.to_owned()), &FlightArgs::default(), &FirmwarePortArgs::default());
        found.expect_err("refused")
    };
    assert_eq!(refusal(&file).code, 3);
    std::fs::write(&file, "set ap_max_angle = 25\n").expect("written");
    let error = refusal(&file);
    assert!(error.code == 2 && error.message.ends_with("it has no section [Betaloop]"), "{error}");
}

#[test]
fn ports_of_a_remote_firmware_are_known() {
    let attach = FirmwareArgs { firmware: Some(FirmwareChoice::Attach), ..FirmwareArgs::default() };
    let any = FirmwarePortArgs { tcp_port: Some(0), ..FirmwarePortArgs::default() };
    let error = choice(&attach, &FlightArgs::default(), &any).0.expect_err("refused");
    assert!(error.code == 2 && error.message.contains("0 is not a port"), "{error}");
    let ports = FirmwarePortArgs {
        tcp_port: Some(6000),
        udp_ports: "1,2,3,4".parse().ok(),
        fdm_dialect: "legacy".parse().ok(),
        motor_order: Some(MotorOrder::Legacy),
    };
    let found = choice(&attach, &FlightArgs::default(), &ports).0.expect("found").expect("outside");
    assert_eq!(found.executable, None);
    let UdpPorts { raw, motors, fdm, rc } = found.ports.udp;
    assert_eq!((found.ports.tcp, [raw, motors, fdm, rc]), (6000, [1, 2, 3, 4]));
    assert_eq!((found.ports.dialect, found.ports.motor_order), (Dialect::Legacy, MotorOrder::Legacy));
}

#[test]
fn an_external_simulator_flies_the_embedded_firmware() {
    let physics = PhysicsArgs { physics: Some(PhysicsChoice::External), ..PhysicsArgs::default() };
    let (flight, ports) = (FlightArgs::default(), FirmwarePorts::from(&FirmwarePortArgs::default()));
    let beside = Beside { ports, flight: &flight, physics: &physics };
    assert_eq!(choose(&FirmwareArgs::default(), beside, &mut Vec::new()).expect("embedded"), None);
    let attach = FirmwareArgs { firmware: Some(FirmwareChoice::Attach), ..FirmwareArgs::default() };
    assert_eq!(choose(&attach, beside, &mut Vec::new()).expect_err("refused").code, 2);
}
