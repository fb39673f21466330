//! Input that means harm.

use proptest::prelude::*;

use super::*;

#[test]
fn floods_take_bounded_memory() {
    let mut played = Played::connected(arducopter());
    for sequence in 0..20_000_u32 {
        played.hear(Statustext { text: Text::new("flood"), ..Default::default() });
        played.hear(heartbeat(3, 2, 81, sequence % 30));
        played.hear_from((sequence % 200) as u8, arducopter());
        played.hear(AvailableModes { mode_index: sequence as u8, number_modes: 255, ..Default::default() });
    }
    assert_eq!(played.events().len(), 256);
    assert!(played.station.others().len() <= 32);
    assert!(played.sent().len() <= 512);
    for _ in 0..1000 {
        _ = played.station.order(&Order::ReturnHome);
    }
    assert_eq!(played.station.order(&Order::ReturnHome), Err(NotBegun::Busy));
}

proptest! {
    #[test]
    fn no_input_stops_the_station(
        inputs in prop::collection::vec(
            (0..table().len(), prop::collection::vec(any::<u8>(), 0..255), 0..3u8, 0..3_000u64, any::<bool>()), 0..120),
        autopilot in prop::sample::select(vec![0u8, 3, 12, 20]),
    ) {
        let mut played = Played::new();
        played.hear(heartbeat(autopilot, 2, 81, 3));
        for (at, payload, choice, millis, is_old) in inputs {
            played.version = if is_old { Version::V1 } else { Version::V2 };
            if at % 5 == 0 {
                played.station.receive(played.now, &payload);
            }
            let message = Message::decode(table()[at].id, &payload).unwrap();
            if !is_old || message.info().id < 256 {
                played.hear_from(1 + choice % 2, message);
            }
            match choice {
                0 => _ = played.station.download(MissionKind::Mission),
                1 => _ = played.station.upload(MissionKind::Mission, vec![MissionItem::default(); 3]),
                _ => _ = played.station.order(&Order::SetMode("AUTO".into())),
            }
            played.now += Duration::from_millis(millis);
            played.station.advance(played.now);
        }
        for message in played.sent() {
            if let Message::CommandLong(long) = message {
                prop_assert_ne!(long.command, 400);
            }
        }
    }
}
