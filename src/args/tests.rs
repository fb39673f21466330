//! Tests of the whole command line.

use std::collections::BTreeMap;
use std::path::Path;

use super::*;
use crate::link::conventions::FirmwareClock;

fn parse_line(line: &str, layers: &Layers) -> Result<Cli, clap::Error> {
    parse(line.split(' ').map(OsString::from), layers)
}

fn fly(line: &str) -> FlyArgs {
    fly_over(line, &Layers::default())
}

fn fly_over(line: &str, layers: &Layers) -> FlyArgs {
    match parse_line(line, layers).unwrap_or_else(|error| panic!("{error}")).command {
        Some(Command::Fly(fly)) => *fly,
        other => panic!("{other:?}"),
    }
}

fn refusal(line: &str, layers: &Layers) -> String {
    let error = parse_line(line, layers).expect_err(line);
    assert_eq!(error.exit_code(), 2, "{error}");
    error.render().to_string()
}

fn layers(environment: &[(&str, &str)], file: &str) -> Layers {
    let pairs = environment.iter().map(|(name, value)| ((*name).to_owned(), (*value).to_owned()));
    Layers {
        environment: BTreeMap::from_iter(pairs),
        file_name: "config.toml".to_owned(),
        file: file.parse().unwrap_or_else(|error| panic!("{error}")),
    }
}

#[test]
fn the_definition_is_sound() {
    Cli::command().debug_assert();
}

#[test]
fn without_a_command_the_terminal_opens() {
    let cli = parse_line("betadeck", &Layers::default()).unwrap();
    assert!(cli.command.is_none() && cli.tui.plan.is_none());
    let cli = parse_line("betadeck square --seed 7", &Layers::default()).unwrap();
    assert_eq!(cli.tui.flight.seed, Some(7));
}

#[test]
fn fly_reads_every_option() {
    let fly = fly(
        "betadeck fly square --json - --samples 10 --gpx t.gpx --timeout 60 --takeoff 0 --tolerance 2.5 --rx-loss-at 14 \
         --gps-loss-at boot+20,6 --fault motor@10,,2:0.8 --fault gps-loss@1 --stick pitch=2000@30,2 \
         --set ap_max_angle=25 --set gps_sbas_mode=AUTO --settings diff.txt --seed 9 --rate 4000 --speed 2 --noise none \
         --wind 5@270 --gust 2 --turbulence light --world battery_sag=on --airframe five-inch \
         --home -40,-79,300 --heading -90 --fresh --arm-assist on --attitude truth",
    );
    assert_eq!(fly.json, Some(OutputFile::Stdout));
    assert_eq!(fly.trouble.faults().count(), 4);
    assert_eq!(fly.mission.set, ["ap_max_angle = 25", "gps_sbas_mode = AUTO"]);
    assert!(
        (fly.speed() - 2.0).abs() < 1e-9
            && fly.mission.takeoff_m().abs() < 1e-9
            && (fly.mission.tolerance_m() - 2.5).abs() < 1e-9
            && (fly.mission.timeout_s() - 60.0).abs() < 1e-9
    );
    assert_eq!(fly.flight.home.unwrap().to_string(), "-40.0000000,-79.0000000,300");
    assert!(fly.flight.fresh && fly.flight.arm_assist.is_some_and(OnOff::is_on));
    assert_eq!(fly.flight.attitude, Some(AttitudeChoice::Truth));
}

#[test]
fn the_firmware_can_be_remote() {
    let fly =
        fly("betadeck fly square --firmware ./sitl.elf --firmware-arg --ip --firmware-arg 127.0.0.1 --yes \
         --fdm-stamps sim --tcp-port 6000 --udp-ports 1,2,3,4 --fdm-dialect legacy --motor-order legacy");
    assert_eq!(fly.firmware.firmware, Some(FirmwareChoice::Executable("./sitl.elf".into())));
    assert_eq!(fly.firmware.link.firmware_arg, ["--ip", "127.0.0.1"]);
    assert!(fly.firmware.link.yes && fly.firmware.link.stamps().to_string() == "sim");
    assert_eq!((fly.firmware_ports.tcp_port, fly.firmware_ports.udp_ports.unwrap().rc), (Some(6000), 4));
    let layers =
        layers(&[("BETADECK_FIRMWARE", "attach")], "firmware-arg = [\"-a\", \"-b\"]\nbetaloop = \"x\"");
    let fly = fly_over("betadeck fly square", &layers);
    assert_eq!(fly.firmware.firmware, Some(FirmwareChoice::Attach));
    assert_eq!(fly.firmware.link.firmware_arg, ["-a", "-b"]);
    assert_eq!(fly.firmware.link.betaloop, None, "the environment decides");
    let fly = fly_over("betadeck fly square --betaloop config.txt", &layers);
    assert_eq!((fly.firmware.firmware, fly.firmware.link.betaloop), (None, Some("config.txt".into())));
}

#[test]
fn compare_takes_one_or_two_firmwares() {
    let compare = |line: &str, layers: &Layers| match parse_line(line, layers).unwrap().command {
        Some(Command::Compare(compare)) => *compare,
        other => panic!("{other:?}"),
    };
    let none = Layers::default();
    let two = compare(
        "betadeck compare square --firmware embedded --firmware ./x.elf --set ap_max_angle=25",
        &none,
    );
    assert_eq!(two.firmware, [FirmwareChoice::Embedded, FirmwareChoice::Executable("./x.elf".into())]);
    let times = |args: &CompareArgs, clock| {
        let of_each = args.firmware.iter().map(|firmware| args.flights_of(firmware, clock));
        of_each.collect::<Result<Vec<u32>, _>>()
    };
    assert_eq!((times(&two, FirmwareClock::Real), two.mission.set.len()), (Ok(vec![1, 3]), 1));
    assert_eq!(times(&two, FirmwareClock::Sim), Ok(vec![1, 1]));
    let of_launcher = compare("betadeck compare square --betaloop config.txt", &none);
    assert!(of_launcher.firmware.is_empty() && of_launcher.link.betaloop.is_some());
    let file = layers(&[], "seed = 9\ntakeoff = 5");
    let layered = compare("betadeck compare square --firmware ./x.elf --repeat 5", &file);
    assert_eq!((layered.flight.seed, times(&layered, FirmwareClock::Real)), (Some(9), Ok(vec![5])));
    let seeds = compare("betadeck compare square --firmware ./x.elf --seeds 2..4", &file);
    assert_eq!((seeds.flight.seed, seeds.seeds.map(|seeds| seeds.0)), (None, Some(vec![2, 3, 4])));
    assert!(
        (layered.mission.takeoff_m() - 5.0).abs() < 1e-9
            && (layered.mission.timeout_s() - 1800.0).abs() < 1e-9
    );
}

#[test]
fn a_firmware_that_runs_already_is_compared_by_one_flight() {
    let times = |line: &str| match parse_line(line, &Layers::default()).unwrap().command {
        Some(Command::Compare(compare)) => compare.flights_of(&compare.firmware[0], FirmwareClock::Real),
        other => panic!("{other:?}"),
    };
    assert_eq!(times("betadeck compare square --firmware attach"), Ok(1));
    assert_eq!(times("betadeck compare square --firmware attach --repeat 1"), Ok(1));
    let sentence = times("betadeck compare square --firmware attach --repeat 3").unwrap_err();
    assert!(sentence.contains("is not restarted") && sentence.contains("--repeat 1"), "{sentence}");
}

#[test]
fn a_comparison_starts_from_defaults_wherever_the_craft_is_stored() {
    // This key is for the other commands.
    let stored = layers(&[], "state-dir = \"x\"");
    match parse_line("betadeck compare square --firmware ./x.elf", &stored).unwrap().command {
        Some(Command::Compare(compare)) => assert_eq!(compare.flight.state_dir, None),
        other => panic!("{other:?}"),
    }
    let text = refusal("betadeck compare square --firmware ./x.elf --state-dir x", &Layers::default());
    assert!(text.contains("each flight starts from defaults"), "{text}");
}

#[test]
fn the_firmware_of_all_layers_reaches_check_and_nothing_else_does() {
    let check = |line: &str, layers: &Layers| match parse_line(line, layers).unwrap().command {
        Some(Command::Check(check)) => *check,
        other => panic!("{other:?}"),
    };
    let file = layers(
        &[],
        "firmware = \"./a.elf\"\nfirmware-arg = [\"-x\"]\nyes = true\nudp-ports = \"1,2,3,4\"\nseed = 9\njson = \"x\"\n",
    );
    let layered = check("betadeck check guide-1", &file);
    assert_eq!(layered.firmware.firmware, Some(FirmwareChoice::Executable("./a.elf".into())));
    assert_eq!(
        (&layered.firmware.link.firmware_arg[..], layered.firmware.link.yes),
        (&["-x".to_owned()][..], true)
    );
    assert_eq!((layered.firmware_ports.udp_ports.map(|ports| ports.rc), layered.json), (Some(4), None));
    let both = Layers { environment: layers(&[("BETADECK_FIRMWARE", "attach")], "").environment, ..file };
    assert_eq!(check("betadeck check guide-1", &both).firmware.firmware, Some(FirmwareChoice::Attach));
    let typed = check("betadeck check guide-1 --firmware embedded", &both);
    assert_eq!(typed.firmware.firmware, Some(FirmwareChoice::Embedded));
    let typed = check("betadeck check guide-1 --betaloop config.txt", &both);
    assert_eq!((typed.firmware.firmware, typed.firmware.link.betaloop), (None, Some("config.txt".into())));
}

#[test]
fn defaults_of_fly() {
    let fly = fly("betadeck fly -");
    assert_eq!(fly.plan, PlanArg::Stdin(None));
    assert!(fly.speed().is_infinite());
    assert!((fly.mission.takeoff_m() - 10.0).abs() < 1e-9 && (fly.mission.timeout_s() - 1800.0).abs() < 1e-9);
    assert!((fly.mission.tolerance_m() - 10.0).abs() < 1e-9);
}

#[test]
fn wrong_values_say_what_is_allowed() {
    let none = Layers::default();
    for (line, part) in [
        ("betadeck fly", "required"),
        ("betadeck fly sqare", "did you mean square?"),
        ("betadeck fly square --wnd 5@270", "--wind"),
        ("betadeck fly square --wind 5", "5@270"),
        ("betadeck fly square --rate 100", "2.5 ms"),
        ("betadeck fly square --fault motr@1", "motor"),
        ("betadeck fly square --samples 10", "--samples needs --json or --csv"),
        ("betadeck fly square --csv x.csv --samples 0", "--samples 0 leaves no rows"),
        ("betadeck fly square --set ap_max_angle", "write NAME=VALUE"),
        ("betadeck fly square --gust -1", "out of range"),
        ("betadeck fly square --wind -5@20", "wind"),
        ("betadeck fly square --rx-loss-at -1", "time T -1 is out of range"),
        ("betadeck fly square --seed -1", "whole numbers from 0"),
        ("betadeck fly square --speed -1", "0.05 to 1000"),
        ("betadeck fly square --gpx -", "not to standard output"),
        ("betadeck fly square --kml -", "not to standard output"),
        ("betadeck fly square --geojson -", "not to standard output"),
        ("betadeck fly square --track-hz 5", "--track-hz needs a track"),
        ("betadeck fly square --kml a --track-hz 0", "out of range"),
        ("betadeck fly square --fresh --state-dir x", "cannot be used with"),
        ("betadeck fly square --firmware attach --betaloop x", "cannot be used with"),
        ("betadeck fly square --firmware=", "the path of a SITL executable"),
        ("betadeck serve --fdm-stamps none", "--fdm-stamps <STAMPS>"),
        ("betadeck compare square --firmware a --firmware b --firmware c", "given once, to compare with"),
        ("betadeck compare square --firmware a --timeout 9000", "allowed are 1 to 7200 s"),
        ("betadeck compare square --firmware a --repeat 0", "1..=100"),
        ("betadeck comparre square --firmware a", "did you mean betadeck compare?"),
        ("betadeck fly square --home 95,1", "latitude 95 is out of range"),
        ("betadeck fly square --arm-assist maybe", "possible values: on, off"),
        ("betadeck flly square", "did you mean betadeck fly?"),
        ("betadeck convrt", "did you mean betadeck convert?"),
        ("betadeck convert a.txt -", "add --to with one of toml, txt"),
        ("betadeck convert a.txt b", "b has none of the extensions .toml, .txt"),
        ("betadeck convert a b.txt", "a: it is neither a built-in plan nor a file"),
        ("betadeck convert a.txt b.toml --from doc", "allowed are toml, txt"),
    ] {
        let text = refusal(line, &none);
        assert!(text.contains(part), "{line}:\n{text}");
    }
}

#[test]
fn convert_knows_its_formats() {
    use crate::plan::format::Format;
    let convert = |line: &str| match parse_line(line, &Layers::default()).unwrap().command {
        Some(Command::Convert(convert)) => (convert.source().unwrap(), convert.target().unwrap()),
        other => panic!("{other:?}"),
    };
    assert_eq!(convert("betadeck convert a.txt b.toml"), ("a.txt".parse().unwrap(), Format::Toml));
    assert_eq!(
        convert("betadeck convert - - --from TOML --to txt"),
        (PlanArg::Stdin(Some(Format::Toml)), Format::CliText)
    );
    assert_eq!(
        convert("betadeck convert a b --from txt --to toml").0,
        PlanArg::File("a".into(), Some(Format::CliText))
    );
    assert!(matches!(convert("betadeck convert square b.txt").0, PlanArg::Builtin(_)));
}

#[test]
fn the_command_line_wins_over_environment_over_file() {
    let layers = layers(
        &[("BETADECK_SEED", "2"), ("BETADECK_RX_LOSS_AT", "14"), ("HOME", "/"), ("BETADECK_WIND", "")],
        "seed = 3\nwind = \"5@270\"\nrate = 2000\ntakeoff = 12.5\ntolerance = 3\nset = [\"ap_max_angle=11\", \"ap_max_angle=12\"]\narm_assist = true\n",
    );
    let fly = fly_over("betadeck fly square --rate 500", &layers);
    assert_eq!(fly.flight.seed, Some(2));
    assert_eq!(fly.flight.rate, Some(500));
    assert_eq!(fly.flight.wind.unwrap().to_string(), "5@270");
    assert!((fly.mission.takeoff_m() - 12.5).abs() < 1e-9 && (fly.mission.tolerance_m() - 3.0).abs() < 1e-9);
    assert_eq!(fly.mission.set, ["ap_max_angle = 11", "ap_max_angle = 12"]);
    assert!(fly.trouble.rx_loss_at.is_some() && fly.flight.arm_assist == Some(OnOff::On));
    assert_eq!(
        fly_over("betadeck fly square --set ap_max_angle=13", &layers).mission.set,
        ["ap_max_angle = 13"]
    );
    // The terminal user interface has no --takeoff: this key is for other commands.
    let cli = parse_line("betadeck", &layers).unwrap();
    assert_eq!(cli.tui.flight.seed, Some(2));
}

#[test]
fn the_flights_are_listed_from_the_state_directory_that_the_screen_uses() {
    let of = |line: &str, layers: &Layers| match parse_line(line, layers).unwrap().command {
        Some(Command::Flights(flights)) => flights,
        other => panic!("{other:?}"),
    };
    // A key with the name of another command's option means that one.
    let file = layers(&[("BETADECK_JSON", "flight.jsonl")], "state-dir = \"x\"\nwind = \"5@270\"\n");
    let flights = of("betadeck flights", &file);
    assert_eq!((flights.state_dir.as_deref(), flights.json), (Some(Path::new("x")), false));
    assert_eq!(of("betadeck flights --state-dir y", &file).state_dir.as_deref(), Some(Path::new("y")));
    // So are the screens of flights that are over.
    for (line, expected) in [("open hold", "x"), ("replay a.bbl", "x"), ("open hold --state-dir y", "y")] {
        let state_dir = match parse_line(&format!("betadeck {line}"), &file).unwrap().command {
            Some(Command::Open(open)) => open.state_dir,
            Some(Command::Replay(replay)) => replay.state_dir,
            other => panic!("{other:?}"),
        };
        assert_eq!(state_dir.as_deref(), Some(Path::new(expected)), "{line}");
    }
    let most = |layers: &Layers| parse_line("betadeck", layers).unwrap().tui.recordings.most_bytes();
    assert_eq!(most(&layers(&[], "")), 200 << 20);
    assert_eq!(most(&layers(&[], "recordings_max_mb = 5")), 5 << 20);
}

#[test]
fn a_typed_option_silences_the_layered_one_it_conflicts_with() {
    let file = layers(&[], "state-dir = \"x\"\n");
    assert!(fly_over("betadeck fly square", &file).flight.state_dir.is_some());
    let fly = fly_over("betadeck fly square --fresh", &file);
    assert!(fly.flight.fresh && fly.flight.state_dir.is_none());
    let fresh = layers(&[("BETADECK_FRESH", "1")], "");
    assert!(fly_over("betadeck fly square", &fresh).flight.fresh);
    assert!(!fly_over("betadeck fly square --state-dir y", &fresh).flight.fresh);
    let both = layers(&[("BETADECK_FRESH", "1")], "state-dir = \"x\"\n");
    let fly = fly_over("betadeck fly square", &both);
    assert!(fly.flight.fresh && fly.flight.state_dir.is_none());
}

#[test]
fn a_list_of_scenarios_needs_no_ports_whatever_the_environment_says() {
    let ports = layers(&[("BETADECK_TCP_PORT", "0"), ("BETADECK_UDP_PORTS", "0,0,0,0")], "");
    assert!(parse_line("betadeck check --list", &ports).is_ok());
}

#[test]
fn wrong_layers_are_named() {
    for (environment, file, part) in [
        (&[("BETADECK_WIND", "5")][..], "", "environment variable BETADECK_WIND"),
        (&[("BETADECK_FRESH", "maybe")][..], "", "BETADECK_FRESH: maybe is neither true nor false"),
        (&[][..], "wind = \"x\"", "config.toml: wind"),
        (&[][..], "wnd = \"5@270\"", "config.toml: wnd is not an option; did you mean wind?"),
        (&[][..], "[wind]\nspeed = 5", "config.toml: wind: a table is not a value of --wind"),
        (&[][..], "seed = [1, 2]", "one value is expected, not 2"),
    ] {
        let text = refusal("betadeck fly square", &layers(environment, file));
        assert!(text.contains(part), "{text}");
    }
}

#[test]
fn all_problems_of_the_layers_are_found_at_once() {
    let layers = layers(
        &[("BETADECK_SEED", "x"), ("BETADECK_SEDE", "1"), ("BETADECK_RATE", "500"), ("HOME", "/")],
        "wnd = \"5@270\"\ngust = -1\nws-port = 70000\n",
    );
    let problems = layer_problems(&layers);
    let named = ["config.toml: wnd", "BETADECK_SEDE is not an option; did you mean BETADECK_SEED?"];
    let named = named.into_iter().chain(["environment variable BETADECK_SEED", "config.toml: gust"]);
    for part in named.chain(["config.toml: ws-port"]) {
        assert!(problems.iter().any(|problem| problem.contains(part)), "{part} in {problems:#?}");
    }
    assert_eq!(problems.len(), 5, "{problems:#?}");
    assert_eq!(layer_problems(&Layers::default()), Vec::<String>::new());
}

#[test]
fn layers_do_not_touch_commands_that_do_not_fly() {
    let layers = layers(&[("BETADECK_WIND", "nonsense")], "seed = 5\nnonsense = 1");
    assert!(matches!(parse_line("betadeck doctor", &layers).unwrap().command, Some(Command::Doctor)));
}

#[test]
fn help_and_version_are_no_errors() {
    for line in [
        "betadeck --help",
        "betadeck -h",
        "betadeck fly --help",
        "betadeck help",
        "betadeck help plan show",
        "betadeck -V",
    ] {
        let error = parse_line(line, &Layers::default()).expect_err(line);
        assert_eq!(error.exit_code(), 0, "{line}");
    }
}

#[test]
fn the_greatest_altitude_without_a_warning_comes_from_every_layer() {
    let of = |line: &str, layers: &Layers| match parse_line(line, layers).unwrap().command {
        Some(Command::Plan(PlanCommand::Show { review, .. })) => review.max_altitude_m(),
        Some(Command::Fly(fly)) => fly.review.max_altitude_m(),
        None => parse_line(line, layers).unwrap().tui.review.max_altitude_m(),
        other => panic!("{other:?}"),
    };
    let file = layers(&[], "max_altitude_m = 60");
    let both = layers(&[("BETADECK_MAX_ALTITUDE_M", "80")], "max_altitude_m = 60");
    for command in ["betadeck", "betadeck fly square", "betadeck plan show square"] {
        let typed = format!("{command} --max-altitude-m 90");
        let values = [(command, &layers(&[], "")), (command, &file), (command, &both), (&typed, &both)]
            .map(|(line, layers)| of(line, layers));
        assert!(
            values.iter().zip([120.0, 60.0, 80.0, 90.0]).all(|(a, b)| (a - b).abs() < 1e-9),
            "{values:?}"
        );
    }
}
