//! Command lines on this program's own server, in all three ways.

use betadeck::fc::client::{Answer, Ask, CliAccess, Unanswered};
use betadeck::msp::Decoder;
use betadeck::plan::format::{self, Format};
use betadeck::plan::plan_lines;

use crate::protocols::fc_client::board::{Bench, Manners};

const STATUS_EX: u16 = 150;

#[test]
fn a_framed_line_leaves_msp_as_it_was() {
    let mut bench = Bench::new(Manners::default());
    assert_eq!(bench.msp(2).unwrap(), b"BTFL");
    assert!(bench.line("version").contains("MSP API: 1.49"));
    assert_eq!(bench.line("# a comment"), "");
    assert_eq!(bench.msp(3).unwrap()[0], 26);
    let unknown = bench.ask(Ask::Line("nonsense".to_owned()));
    let text = "ERR_CMD_NA: nonsense\r\n".to_owned();
    assert_eq!(unknown, Answer::Line { text, failed: true, restarted: false });
    let refused = bench.ask(Ask::Line("waypoint insert 0 1".to_owned()));
    assert!(matches!(refused, Answer::Line { failed: true, .. }), "{refused:?}");
}

#[test]
fn a_plan_goes_up_and_comes_back_in_every_way() {
    let text = include_str!("../../../../plans/square.toml");
    let plan = format::parse("square.toml", text, Format::Toml).unwrap().plan;
    let ways = [
        (Manners::default(), CliAccess::Framed, false),
        (Manners { no_framing: true, ..Manners::default() }, CliAccess::Interactive, false),
        (Manners { cli_is_shut: true, ..Manners::default() }, CliAccess::Framed, false),
        (Manners { cli_is_shut: true, ..Manners::default() }, CliAccess::Interactive, true),
    ];
    for (manners, access, armed) in ways {
        let mut bench = Bench::new(manners);
        bench.client.set_cli(access);
        bench.client.set_armed(armed);
        let lines: Vec<String> = plan_lines(&plan).collect();
        for line in &lines {
            bench.line(line);
        }
        let list = bench.line("waypoint list");
        assert_eq!(format::parse("list", &list, Format::CliText).unwrap().plan, plan, "{manners:?}");
        assert_eq!(bench.board.firmware.stored_plan(), &plan);
        assert_eq!(bench.client.is_in_cli(), manners.no_framing);
    }
}

#[test]
fn long_output_comes_in_pages_and_a_cut_one_is_reported() {
    let mut bench = Bench::new(Manners::default());
    let by_message = |line: &str| Ask::MessageLine(line.to_owned());
    let ap = bench.line("get throttle");
    assert!((513..2048).contains(&ap.len()), "{}", ap.len());
    assert!(!bench.board.asked.contains(&0x3012));
    let paged = bench.ask(by_message("get throttle"));
    assert_eq!(paged, Answer::Line { text: ap, failed: false, restarted: false });
    assert!(bench.board.asked.contains(&0x3012));
    let cut = bench.ask(by_message("dump all"));
    let Answer::Line { text, failed: true, .. } = cut else { panic!("{cut:?}") };
    assert!(text.len() > 2048 && text.ends_with("TOO LONG FOR A MESSAGE###\r\n"), "{text}");
    let refused = bench.ask(by_message("bl"));
    assert!(matches!(refused, Answer::Line { failed: true, .. }), "{refused:?}");
    let long = bench.ask(by_message(&"x".repeat(250)));
    assert_eq!(long, Answer::NotAnswered(Unanswered::CliClosed));
}

#[test]
fn a_save_that_restarts_is_answered_and_the_next_request_waits_for_the_new_connection() {
    let mut bench = Bench::new(Manners { save_restarts: true, ..Manners::default() });
    bench.line("set ap_max_angle = 33");
    let saved = bench.ask(Ask::Line("save".to_owned()));
    let text = "\r\n# saving\r\n\r\nRebooting".to_owned();
    assert_eq!(saved, Answer::Line { text, failed: false, restarted: true });
    assert!(bench.line("get ap_max_angle").contains("ap_max_angle = 33\r\n"));
    let saved = bench.line("save noreboot");
    assert_eq!(saved, "\r\n# saving\r\n");
}

#[test]
fn msp_rests_at_the_prompt_until_the_flight_controller_restarts() {
    let mut bench = Bench::new(Manners { no_framing: true, ..Manners::default() });
    bench.client.set_cli(CliAccess::Interactive);
    let dump = bench.line("dump");
    assert!(dump.len() > 10_000 && dump.contains("\r\n# version\r\n"), "{}", dump.len());
    assert!(!dump.starts_with("dump") && dump.ends_with("\r\n"), "neither echo nor prompt");
    assert!(bench.client.is_in_cli() && !bench.client.is_idle());
    let message = Ask::Msp { code: STATUS_EX, payload: Vec::new() };
    assert_eq!(bench.ask(message.clone()), Answer::NotAnswered(Unanswered::InCli));
    assert!(bench.line("get ap_max_angle").starts_with("ap_max_angle = "));
    let unknown = bench.ask(Ask::Line("nonsense".to_owned()));
    assert!(matches!(unknown, Answer::Line { failed: true, .. }), "{unknown:?}");
    let left = bench.ask(Ask::Line("exit".to_owned()));
    assert!(matches!(left, Answer::Line { restarted: true, .. }), "{left:?}");
    assert!(!bench.client.is_in_cli());
    assert!(matches!(bench.ask(message.clone()), Answer::Msp(Some(_))));
    // Leaves the prompt without a restart.
    bench.line("version");
    bench.line("exit noreboot");
    assert!(matches!(bench.ask(message), Answer::Msp(Some(_))));
}

#[test]
fn a_typed_line_is_answered_by_the_prompt_itself_which_can_be_left() {
    let mut bench = Bench::new(Manners::default());
    assert_eq!(
        bench.ask(Ask::LeavePrompt),
        Answer::Line { text: String::new(), failed: false, restarted: false }
    );
    let unknown = bench.ask(Ask::Typed("nonsense".to_owned()));
    let text = "###ERROR IN input: UNKNOWN COMMAND, TRY 'HELP'###".to_owned();
    assert_eq!(unknown, Answer::Line { text, failed: true, restarted: false });
    assert!(bench.client.is_in_cli());
    let Answer::Line { text, .. } = bench.ask(Ask::Typed("get ap_max_angle".to_owned())) else { panic!() };
    assert!(text.starts_with("ap_max_angle = ") && text.ends_with("\r\n"), "{text:?}");
    bench.ask(Ask::LeavePrompt);
    assert!(!bench.client.is_in_cli());
    assert!(bench.msp(STATUS_EX).is_some());
}

#[test]
fn a_command_line_that_does_not_open_is_reported() {
    let shut = Manners { cli_is_shut: true, no_message_lines: true, ..Manners::default() };
    for access in [CliAccess::Framed, CliAccess::Interactive] {
        let mut bench = Bench::new(shut);
        bench.client.set_cli(access);
        let closed = Answer::NotAnswered(Unanswered::CliClosed);
        assert_eq!(bench.ask(Ask::Line("waypoint list".to_owned())), closed);
        assert_eq!(bench.board.ran, [] as [&str; 0]);
        assert_eq!(bench.ask(Ask::MessageLine("waypoint status".to_owned())), closed);
        let asked = bench.board.asked.iter().filter(|code| **code == 0x3012).count();
        assert_eq!(asked, 1, "not asked a second time");
        assert!(bench.msp(STATUS_EX).is_some());
    }
}

#[test]
fn nothing_of_a_line_reaches_a_firmware_that_does_not_open_its_command_line() {
    let mut bench = Bench::new(Manners { no_framing: true, no_message_lines: true, ..Manners::default() });
    // `R` restarts into the boot loader, `#` opens the prompt.
    bench.ask(Ask::Line("waypoint insert 0 1 2 3 4 FLYOVER 0 ORBIT # R".to_owned()));
    let mut decoder = Decoder::server();
    for &byte in &bench.sent {
        assert!(!decoder.is_between_frames() || [b'$', 0x02].contains(&byte), "{:?}", bench.sent);
        decoder.push(byte);
    }
}
