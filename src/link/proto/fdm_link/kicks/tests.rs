use super::busy_host::{BusyHost, Trouble};
use super::*;

/// Returns the times (ms) of the kicks until `end_ms`.
fn kicks_until(kicks: &mut Kicks, start_ms: u64, end_ms: u64) -> Vec<u64> {
    (start_ms..end_ms).filter(|ms| kicks.poll(ms * 1000)).collect()
}

/// Returns the number of replies withheld in a row, for packets from `ms` on, one per millisecond.
fn withheld_from(kicks: &mut Kicks, ms: u64) -> usize {
    (ms..)
        .take_while(|ms| {
            kicks.heard(ms * 1000);
            kicks.withhold()
        })
        .count()
}

/// Returns `true` if any reply is withheld, for packets that arrive ten times a second.
fn any_withheld(kicks: &mut Kicks, start_ms: u64, end_ms: u64) -> bool {
    (start_ms..end_ms).step_by(100).any(|ms| {
        kicks.heard(ms * 1000);
        kicks.withhold()
    })
}

#[test]
fn kicks_twice_a_second_until_the_first_packet() {
    let mut kicks = Kicks::new(0);
    assert_eq!(kicks_until(&mut kicks, 0, 2100), [500, 1000, 1500, 2000]);
}

#[test]
fn a_silence_is_broken_after_a_tenth_a_second_and_every_ten() {
    let mut kicks = Kicks::new(0);
    kicks.heard(1_000_000);
    assert_eq!(kicks_until(&mut kicks, 1000, 23_000), [1100, 1125, 1145, 2000, 12_000, 22_000]);
}

#[test]
fn kicks_twice_a_second_again_when_nobody_listens() {
    let mut kicks = Kicks::new(0);
    kicks.heard(0);
    assert!(kicks.poll(100_000));
    kicks.refused();
    assert_eq!(kicks.due_us(), 600_000);
    assert!(kicks.poll(600_000));
    kicks.heard(601_000);
    assert!(!kicks.withhold(), "the refused kick does not count, the other was awaited");
}

#[test]
fn a_pause_costs_all_kicks_whenever_it_ends() {
    for resumed_ms in [1040, 1500, 1999] {
        let mut kicks = Kicks::new(0);
        kicks.heard(0);
        assert_eq!(kicks_until(&mut kicks, 0, resumed_ms).len(), 4);
        assert_eq!(withheld_from(&mut kicks, resumed_ms), 4, "{resumed_ms} ms");
    }
}

#[test]
fn a_simulator_that_starves_without_the_withheld_reply_gets_it_and_owes_nothing() {
    let mut kicks = Kicks::new(0);
    kicks.heard(0);
    kicks_until(&mut kicks, 0, 2000);
    kicks.heard(2_000_000);
    assert!(kicks.withhold());
    assert!(!kicks.poll(2_030_000));
    assert!(kicks.poll(2_090_000));
    kicks.heard(2_091_000);
    assert!(!kicks.withhold());
}

#[test]
fn a_starving_simulator_with_long_steps_is_believed_the_third_time() {
    let mut kicks = Kicks::new(0);
    kicks.heard(0);
    assert!(kicks.poll(100_000));
    kicks.heard(110_000);
    for ms in [200, 300, 400] {
        assert!(kicks.withhold(), "{ms} ms");
        assert!(kicks.poll(ms * 1000));
        kicks.heard(ms * 1000 + 10_000);
    }
    assert!(!kicks.withhold());
}

#[test]
fn what_was_given_up_by_mistake_is_found_fifty_packets_later() {
    let mut kicks = Kicks::new(0);
    kicks.heard(0);
    assert_eq!(kicks_until(&mut kicks, 0, 500).len(), 3);
    kicks.heard(500_000);
    assert!(kicks.withhold());
    // The simulator was slow, and continued right after the late reply by chance.
    assert!(kicks.poll(600_000));
    kicks.heard(601_000);
    assert!(!kicks.withhold());
    assert!(!any_withheld(&mut kicks, 700, 5500));
    assert_eq!(withheld_from(&mut kicks, 5502), 3);
    assert!(!any_withheld(&mut kicks, 5700, 20_000));
}

#[test]
fn a_surplus_that_never_shows_is_checked_six_times_and_then_no_more() {
    let mut kicks = Kicks::new(0);
    kicks.heard(0);
    assert!(kicks.poll(100_000));
    let mut now_us = 101_000;
    let mut checked_at = Vec::new();
    for packet in 0..10_000 {
        kicks.heard(now_us);
        if kicks.withhold() {
            checked_at.push(packet);
            now_us = kicks.due_us();
            assert!(kicks.poll(now_us));
        }
        now_us += 1000;
    }
    assert_eq!(checked_at, [0, 50, 150, 350, 750, 1550, 3150]);
}

#[test]
fn a_second_stall_while_a_reply_is_withheld_is_counted_too() {
    let mut kicks = Kicks::new(0);
    kicks.heard(0);
    assert_eq!(kicks_until(&mut kicks, 0, 140).len(), 2);
    kicks.heard(140_000);
    assert!(kicks.withhold());
    // Two are left over. The simulator pauses again and gets three more.
    assert_eq!(kicks_until(&mut kicks, 140, 500).len(), 3);
    assert_eq!(withheld_from(&mut kicks, 500), 4, "it has read one of the five");
}

#[test]
fn after_lost_packets_at_most_one_waits_in_the_socket() {
    for (loss, step_us, seed) in combinations([0.01, 0.1], [300, 1000, 10_000], 100) {
        let mut host = BusyHost::new(step_us, seed);
        host.run(Trouble { loss, ..Trouble::default() }, 500);
        host.run(Trouble::default(), 20);
        assert!(host.waiting <= 1, "{host:?}");
    }
}

#[test]
fn a_host_that_stops_both_sides_at_any_moment_leaves_no_old_packets_in_the_socket() {
    for (share, step_us, seed) in combinations([0.05, 0.3], [300, 1000, 10_000], 100) {
        let mut host = BusyHost::new(step_us, seed);
        let busy = Trouble {
            simulator_stops: share,
            firmware_stops: share,
            longest_stop_ms: 200.0,
            ..Trouble::default()
        };
        let most = (0..50).map(|_| {
            host.run(busy, 10);
            host.waiting
        });
        assert!(most.max() <= Some(15), "{host:?}");
        host.run(Trouble::default(), 1000);
        assert!(host.waiting <= 1, "{host:?}");
    }
}

/// Returns all combinations of a share, the length of a step and a seed.
fn combinations(shares: [f64; 2], steps_us: [u64; 3], seeds: u64) -> impl Iterator<Item = (f64, u64, u64)> {
    let of_share = move |share| {
        steps_us.into_iter().flat_map(move |step| (0..seeds).map(move |seed| (share, step, seed)))
    };
    shares.into_iter().flat_map(of_share)
}
