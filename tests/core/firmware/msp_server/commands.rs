//! Messages that make the flight controller act: save, restart, calibrate, change profiles.

use betadeck_core::firmware::msp::{MspAction, MspFacts, handle};
use betadeck_core::firmware::settings::Scope;
use test_support::hex;

use super::{ask, craft, facts};

#[test]
fn commands_ask_the_owner() {
    let action = |code, payload: &[u8]| handle(code, payload, &mut craft(), &facts()).action;
    assert_eq!(action(250, &[]), Some(MspAction::Save));
    assert_eq!(action(68, &[]), Some(MspAction::Reboot));
    assert_eq!(action(208, &[]), Some(MspAction::SaveAndReboot));
    assert_eq!(action(205, &[]), Some(MspAction::CalibrateAcc));
    assert_eq!(action(206, &[]), Some(MspAction::CalibrateMag));
    assert_eq!(action(99, &[1, 0]), Some(MspAction::RunawayPrevention(true)));
    assert_eq!(action(99, &[1, 1]), Some(MspAction::RunawayPrevention(false)));
    assert_eq!(
        action(246, &hex::decode("00f15365f401")),
        Some(MspAction::SetClock { unix_s: 1_700_000_000, millis: 500 })
    );
    assert_eq!(action(211, &[0xa6, 0xff]), Some(MspAction::HoldHeading(-90)));
    assert_eq!(
        action(214, &[0, 4, 0, 8, 0x4c, 4, 0xe8, 3]),
        Some(MspAction::MotorTest([1024, 2000, 1100, 1000]))
    );
    let Some(MspAction::RawRc(frame)) = action(200, &[0xdc, 5, 0xdd, 5, 0xe8, 3]) else { panic!("no frame") };
    assert_eq!(frame.channels[..5], [1500, 1501, 1000, 0, 0]);
    let armed = MspFacts { armed: true, ..facts() };
    for code in [205, 206, 208, 250] {
        assert_eq!(handle(code, &[], &mut craft(), &armed).action, None, "message {code} while armed");
    }
    assert_eq!(handle(214, &[0; 8], &mut craft(), &armed).action, None);
    let reboot = handle(68, &[], &mut craft(), &armed);
    assert_eq!((reboot.reply, reboot.action), (None, None), "an armed craft is not restarted");
}

#[test]
fn profiles_are_chosen_copied_and_reset() {
    let mut configuration = craft();
    for (payload, scope, index) in [
        (2, Scope::Profile, 2),
        (9, Scope::Profile, 0),
        (0x81, Scope::RateProfile, 1),
        (0x42, Scope::BatteryProfile, 2),
    ] {
        ask(&mut configuration, 210, &[payload]);
        assert_eq!(configuration.settings.active(scope), index);
    }
    let armed = MspFacts { armed: true, ..facts() };
    assert!(handle(210, &[3], &mut configuration, &armed).reply.is_some());
    assert_eq!(configuration.settings.active(Scope::Profile), 0);

    configuration.settings.set_number("p_roll", 99).unwrap();
    ask(&mut configuration, 183, &[0, 3, 0]);
    ask(&mut configuration, 219, &[]);
    assert_eq!(configuration.settings.number("p_roll"), 45);
    ask(&mut configuration, 210, &[3]);
    assert_eq!(configuration.settings.number("p_roll"), 99);
}
