use super::*;
use crate::firmware::cli::{CliMode, Interpreter};
use crate::firmware::config::Configuration;
use crate::firmware::{Firmware, FirmwareOptions};

const GUIDE: &str = include_str!("../../../tests/vectors/guide-step5.txt");
const PLAN: &str = include_str!("../../../tests/vectors/guide-step7.txt");
const MODES: [&str; 3] = ["aux 0 0 0 1700 2100 0 0", "aux 1 56 1 1700 2100", "aux 2 1 2 1700 2100 0 0"];

/// A flight controller with an embedded firmware. It does not know lines that begin with one of `lacks`.
struct Craft {
    firmware: Firmware,
    console: Interpreter,
    lacks: Vec<&'static str>,
    ran: Vec<String>,
}

impl Craft {
    fn new() -> Self {
        Self {
            firmware: Firmware::new(Configuration::default(), FirmwareOptions::default()),
            console: Interpreter::new(CliMode::Interactive),
            lacks: Vec::new(),
            ran: Vec::new(),
        }
    }

    fn answer(&mut self, line: &str) -> Answer {
        self.ran.push(line.to_owned());
        if let Some(name) = self.lacks.iter().find(|name| line.contains(**name)) {
            let text = format!("###ERROR IN get: INVALID NAME: {name}###\r\n");
            return Answer::Line { text, failed: true, restarted: false };
        }
        let reply = self.firmware.run_cli(&mut self.console, line);
        Answer::Line { text: reply.text, failed: reply.failed, restarted: line == SAVE && !reply.failed }
    }

    /// Answers all requests.
    fn run(&mut self, provision: &mut Provision) {
        while provision.result().is_none() {
            while let Some(Ask::Line(line)) = provision.next() {
                let answer = self.answer(&line);
                provision.take(&answer);
            }
            if matches!(provision.phase, Phase::Restart) {
                self.firmware.restart_in_place();
                provision.reconnected();
            }
        }
    }
}

fn wanted() -> Vec<String> {
    GUIDE.lines().chain(MODES).chain(PLAN.lines()).map(str::to_owned).collect()
}

fn of_user<L: AsRef<str>>(lines: impl IntoIterator<Item = L>) -> ProvisionLines {
    let of_user = lines.into_iter().map(|line| line.as_ref().to_owned()).collect();
    ProvisionLines { usual: Vec::new(), of_user }
}

fn set(craft: &mut Craft, lines: &[String], may_write: bool) -> ProvisionReport {
    let mut provision = Provision::new(of_user(lines), may_write);
    craft.run(&mut provision);
    provision.result().unwrap().unwrap().clone()
}

#[test]
fn the_guides_settings_modes_and_plan_are_written_saved_and_read_back() {
    let mut craft = Craft::new();
    let report = set(&mut craft, &wanted(), true);
    // Some of the guide's 24 settings have their default values; all are written because they belong
    // together.
    assert_eq!(report, ProvisionReport { written: 24 + 3 + 5, ..ProvisionReport::default() });
    assert_eq!(craft.ran.iter().filter(|line| *line == SAVE).count(), 1);
    assert_eq!(craft.firmware.stored_plan().waypoints.len(), 4);
    assert_eq!(craft.firmware.parameters().nav.max_angle, 25);
    assert_eq!(craft.firmware.mode_ranges().len(), 3);
    assert_eq!(
        report.sentences(),
        ["The firmware accepted 32 lines of settings, and they read back as written."]
    );
    // The second time there is nothing to do, and no restart.
    craft.ran.clear();
    let again = set(&mut craft, &wanted(), true);
    assert_eq!(again.unset(), None);
    assert_eq!((again, craft.ran.contains(&SAVE.to_owned())), (ProvisionReport::default(), false));
}

#[test]
fn without_permission_it_is_only_looked() {
    let mut craft = Craft::new();
    let report = set(&mut craft, &wanted(), false);
    assert!(report.may_not_write && report.written == 0 && report.differences.len() > 5, "{report:?}");
    let looks = ["get ", "aux", "waypoint list"];
    assert!(craft.ran.iter().all(|line| looks.iter().any(|look| line.starts_with(look))), "{:?}", craft.ran);
    let sentences = report.sentences().join(" ");
    assert!(sentences.contains("`set ap_max_angle = 25` is required, it holds 50"), "{sentences}");
    assert!(sentences.contains("not changed without permission"), "{sentences}");
    assert_eq!(report.unset(), Some(Unset::Everything(sentences)));
}

#[test]
fn what_this_version_does_not_know_is_listed_and_not_written() {
    let mut craft = Craft::new();
    craft.lacks = vec!["ap_l1_period", "ap_position_a"];
    let report = set(&mut craft, &wanted(), true);
    assert_eq!(report.unknown, ["ap_position_a", "ap_l1_period"]);
    assert!(report.is_as_wanted() && report.written == 30, "{report:?}");
    assert!(!craft.ran.iter().any(|line| line.starts_with("set ap_l1_period")));
    assert!(report.sentences()[1].contains("does not know ap_position_a, ap_l1_period."));
    let Some(Unset::Lines(lines)) = report.unset() else { panic!("{report:?}") };
    let lines: Vec<&str> = lines.iter().map(|unset| &*unset.line).collect();
    assert_eq!(lines, ["set ap_position_a", "set ap_l1_period"]);
}

#[test]
fn a_refused_line_is_reported_and_the_others_are_kept() {
    let mut craft = Craft::new();
    let lines =
        ["set ap_max_angle = 999", "set ap_max_velocity = 700", "feature NONSENSE"].map(str::to_owned);
    let report = set(&mut craft, &lines, true);
    let refused: Vec<&str> = report.refused.iter().map(|refused| &*refused.line).collect();
    assert_eq!((report.written, refused), (1, vec!["set ap_max_angle = 999", "feature NONSENSE"]));
    assert_eq!(report.refused[0].reason, "ERROR IN set: INVALID VALUE");
    let [difference] = &report.differences[..] else { panic!("{report:?}") };
    assert_eq!((&*difference.line, &*difference.held), ("set ap_max_angle = 999", "50"));
    assert!(report.sentences().iter().any(|sentence| sentence.starts_with("It differs when read back")));
    let unset = |line: &str, why: &str| UnsetLine { line: line.to_owned(), why: why.to_owned() };
    let Some(Unset::Lines(lines)) = report.unset() else { panic!("{report:?}") };
    let refused = "the firmware refused it: ERROR IN set: INVALID VALUE";
    assert_eq!((lines.len(), &lines[0]), (2, &unset("set ap_max_angle = 999", refused)), "each once");
}

#[test]
fn of_two_wishes_for_the_same_the_last_counts() {
    let mut craft = Craft::new();
    let lines =
        ["set ap_max_angle = 20", "SET AP_MAX_ANGLE=022", "aux 0 0 0 1700 2100", "aux 0 1 1 900 1200"];
    let report = set(&mut craft, &lines.map(str::to_owned), true);
    assert!(report.is_as_wanted() && report.written == 2, "{report:?}");
    assert_eq!(craft.firmware.parameters().nav.max_angle, 22);
}

#[test]
fn a_save_that_is_refused_ends_it_and_a_lost_answer_too() {
    let mut provision = Provision::new(of_user(["set ap_max_angle = 20"]), true);
    let line = |text: &str, failed| Answer::Line { text: text.to_owned(), failed, restarted: false };
    let armed = "###ERROR IN save: NOT WHILE ARMED###\r\n";
    for answer in [line("ap_max_angle = 30\r\n", false), line("", false), line(armed, true)] {
        provision.next().unwrap();
        provision.take(&answer);
    }
    let report = provision.result().unwrap().unwrap();
    assert_eq!(report.refused[0].reason, "ERROR IN save: NOT WHILE ARMED");
    let mut lost = Provision::new(of_user(["set ap_max_angle = 20"]), true);
    for _ in 0..=MAX_LOST {
        assert!(lost.result().is_none(), "it begins again");
        assert_eq!(lost.next(), Some(Ask::Line("get ap_max_angle".to_owned())));
        lost.take(&Answer::NotAnswered(Unanswered::LinkLost));
    }
    let why = lost.result().unwrap().unwrap_err();
    assert!(why.starts_with("`get ap_max_angle` was not answered: there is no connection"), "{why}");
    assert_eq!(lost.next(), None);
}

#[test]
fn master_gets_other_settings_than_the_guides_and_the_user_has_the_last_word() {
    let mut craft = Craft::new();
    let usual: Vec<String> = GUIDE.lines().map(str::to_owned).collect();
    let of_user = vec!["set ap_altitude_d = 20".to_owned()];
    let mut provision = Provision::new(ProvisionLines { usual, of_user }, true);
    provision.replace_settings();
    craft.run(&mut provision);
    let report = provision.result().unwrap().unwrap();
    let parameters = craft.firmware.parameters();
    assert_eq!((parameters.nav.altitude_p, parameters.nav.altitude_d), (2, 20));
    let reported = report.sentences().join(" ");
    assert!(
        reported.contains("falls in LAND")
            && reported.contains("gets ap_position_cutoff = 30, ap_altitude_p = 2 instead"),
        "{reported}"
    );
}

/// Configures a craft with unknown history. The line for a fresh one is a switch for ARM.
fn set_unsure(craft: &mut Craft) -> ProvisionReport {
    let fresh = ProvisionLines { usual: vec![MODES[0].to_owned()], of_user: Vec::new() };
    let mut provision = Provision::new(ProvisionLines::default(), false).or_when_bare(fresh);
    craft.run(&mut provision);
    provision.result().unwrap().unwrap().clone()
}

#[test]
fn one_that_was_never_set_is_set_as_a_fresh_one_is() {
    let mut craft = Craft::new();
    let report = set_unsure(&mut craft);
    assert_eq!((report.was_bare, report.written), (true, 1));
    assert_eq!(craft.firmware.mode_ranges().len(), 1);
    assert!(report.sentences()[0].contains("set up like a fresh one"), "{:?}", report.sentences());
}

#[test]
fn one_with_a_setting_a_switch_or_a_plan_of_its_own_is_left_alone() {
    let waypoint = PLAN.lines().find(|line| line.starts_with("waypoint insert")).unwrap();
    for own in ["set ap_max_angle = 33", "aux 0 0 0 1700 2100 0 0", waypoint] {
        let mut craft = Craft::new();
        craft.answer(own);
        craft.ran.clear();
        let modes = craft.firmware.mode_ranges().len();
        assert_eq!(set_unsure(&mut craft), ProvisionReport::default(), "{own}");
        assert_eq!((craft.firmware.mode_ranges().len(), &craft.ran[..]), (modes, &["diff".to_owned()][..]));
    }
    // Nor is a craft that does not answer.
    let fresh = ProvisionLines { usual: vec![MODES[0].to_owned()], of_user: Vec::new() };
    let mut provision = Provision::new(ProvisionLines::default(), false).or_when_bare(fresh);
    assert_eq!(provision.next(), Some(Ask::Line("diff".to_owned())));
    provision.take(&Answer::NotAnswered(Unanswered::CliClosed));
    assert_eq!(provision.next(), None);
    assert_eq!(provision.result(), Some(Ok(&ProvisionReport::default())));
}

#[test]
fn one_that_answers_nothing_to_diff_is_not_taken_for_a_bare_one() {
    let fresh = ProvisionLines { usual: vec![MODES[0].to_owned()], of_user: Vec::new() };
    for (text, failed) in [("", false), ("\r\n# ", false), ("###ERROR IN diff: UNKNOWN COMMAND###\r\n", true)]
    {
        let mut provision = Provision::new(ProvisionLines::default(), false).or_when_bare(fresh.clone());
        assert_eq!(provision.next(), Some(Ask::Line("diff".to_owned())));
        provision.take(&Answer::Line { text: text.to_owned(), failed, restarted: false });
        assert_eq!(provision.next(), None, "{text:?}: nothing is written");
        assert_eq!(provision.result(), Some(Ok(&ProvisionReport::default())), "{text:?}");
    }
}
