//! Impairments of the link from a simulator: packets that are lost, late, doubled or out of order.
//!
//! The caller passes the time of sending and the current impairments, and takes out the packets that have
//! arrived. The same seed impairs the same packets alike.

use std::collections::VecDeque;
use std::time::{Duration, Instant};

use rand::RngExt as _;
use rand_xoshiro::Xoshiro256PlusPlus;

/// The maximum number of packets in transit. Further packets are lost, as in a full socket.
const MAX_IN_FLIGHT: usize = 16_384;

/// The impairments of a link.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct LinkImpairment {
    pub stall: bool,
    /// The fraction of packets lost.
    pub loss: f64,
    /// The delay of every packet, ms.
    pub late_ms: f64,
    /// The fraction of packets that arrive twice.
    pub duplicated: f64,
    /// The greatest additional random delay, ms.
    pub jitter_ms: f64,
}

/// The link from a simulator to the firmware.
#[derive(Debug, Clone)]
pub struct ImpairedLink {
    rng: Xoshiro256PlusPlus,
    /// Sorted by arrival.
    in_flight: VecDeque<DelayedPacket>,
}

#[derive(Debug, Clone)]
struct DelayedPacket {
    arrives: Instant,
    datagram: Vec<u8>,
}

impl ImpairedLink {
    /// Creates a link without packets in transit. `rng` decides the fate of packets.
    pub fn new(rng: Xoshiro256PlusPlus) -> Self {
        Self { rng, in_flight: VecDeque::new() }
    }

    /// Sends a packet at `at` through these impairments.
    pub fn send(&mut self, datagram: Vec<u8>, at: Instant, impairment: &LinkImpairment) {
        if *impairment == LinkImpairment::default() {
            self.put(datagram, at);
            return;
        }
        // All four are drawn for each packet, so that one impairment does not change which packets another
        // one hits.
        let [loss, doubling, jitter, jitter_of_second] = std::array::from_fn(|_| self.rng.random::<f64>());
        if impairment.stall || loss < impairment.loss {
            return;
        }
        let late = |part: f64| {
            Duration::from_micros(((impairment.late_ms + part * impairment.jitter_ms) * 1000.0).round() as u64)
        };
        if doubling < impairment.duplicated {
            self.put(datagram.clone(), at + late(jitter_of_second));
        }
        self.put(datagram, at + late(jitter));
    }

    /// Returns the next packet that has arrived by `now`, with its time of arrival.
    pub fn arrived(&mut self, now: Instant) -> Option<(Vec<u8>, Instant)> {
        let packet = self.in_flight.pop_front_if(|packet| packet.arrives <= now)?;
        Some((packet.datagram, packet.arrives))
    }

    /// Returns the arrival time of the next packet in transit, if any.
    pub fn due(&self) -> Option<Instant> {
        self.in_flight.front().map(|packet| packet.arrives)
    }

    fn put(&mut self, datagram: Vec<u8>, arrives: Instant) {
        if self.in_flight.len() < MAX_IN_FLIGHT {
            let place = self.in_flight.partition_point(|packet| packet.arrives <= arrives);
            self.in_flight.insert(place, DelayedPacket { arrives, datagram });
        }
    }
}

#[cfg(test)]
#[allow(clippy::disallowed_methods, reason = "an instant comes from a clock only; which one does not matter")]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use rand::SeedableRng as _;

    const NONE: LinkImpairment =
        LinkImpairment { stall: false, loss: 0.0, late_ms: 0.0, duplicated: 0.0, jitter_ms: 0.0 };

    fn link(seed: u64) -> ImpairedLink {
        ImpairedLink::new(Xoshiro256PlusPlus::seed_from_u64(seed))
    }

    /// Sends packets 0, 1, 2…, one per millisecond. Returns the number of each packet and its time of arrival
    /// (µs after the first was sent).
    fn carry(seed: u64, count: u32, impairment: &LinkImpairment) -> Vec<(u32, u128)> {
        let start = Instant::now();
        let mut way = link(seed);
        let mut seen = Vec::new();
        let mut look = |way: &mut ImpairedLink, now: Instant| {
            while let Some((datagram, at)) = way.arrived(now) {
                assert!(at <= now);
                let number = u32::from_le_bytes(datagram[..].try_into().unwrap());
                seen.push((number, at.duration_since(start).as_micros()));
            }
        };
        for number in 0..count {
            let at = start + Duration::from_millis(number.into());
            way.send(number.to_le_bytes().to_vec(), at, impairment);
            look(&mut way, at);
        }
        look(&mut way, start + Duration::from_secs(3600));
        assert_eq!(way.due(), None);
        seen
    }

    fn numbers(seen: &[(u32, u128)]) -> Vec<u32> {
        seen.iter().map(|(number, _)| *number).collect()
    }

    #[test]
    fn without_faults_everything_passes_at_once_and_nothing_is_drawn() {
        let seen = carry(1, 50, &NONE);
        assert_eq!(seen, (0..50).map(|n| (n, u128::from(n) * 1000)).collect::<Vec<_>>());
        let mut way = link(1);
        let (fresh, now) = (way.rng.clone(), Instant::now());
        way.send(vec![1], now, &NONE);
        assert_eq!(way.rng, fresh);
    }

    #[test]
    fn a_stall_lets_nothing_through_but_what_is_on_its_way() {
        assert_eq!(carry(1, 50, &LinkImpairment { stall: true, ..NONE }), []);
        let (mut way, now) = (link(1), Instant::now());
        way.send(vec![7], now, &LinkImpairment { late_ms: 5.0, ..NONE });
        way.send(vec![8], now, &LinkImpairment { stall: true, ..NONE });
        assert_eq!(way.arrived(now + Duration::from_micros(4999)), None);
        let arrives = now + Duration::from_millis(5);
        assert_eq!(way.due(), Some(arrives));
        assert_eq!(way.arrived(arrives + Duration::from_secs(1)), Some((vec![7], arrives)));
        assert_eq!(way.arrived(arrives + Duration::from_secs(1)), None);
    }

    #[test]
    fn the_asked_fraction_is_lost_and_another_doubled() {
        let lost = 10_000 - carry(3, 10_000, &LinkImpairment { loss: 0.2, ..NONE }).len();
        assert!((1880..2120).contains(&lost), "three standard deviations: {lost}");
        let doubled = carry(3, 10_000, &LinkImpairment { duplicated: 0.2, ..NONE });
        assert!((11_880..12_120).contains(&doubled.len()), "{}", doubled.len());
        assert!(doubled.is_sorted(), "a second one follows the first at once");
        assert_eq!(carry(3, 100, &LinkImpairment { loss: 1.0, ..NONE }), []);
        assert_eq!(carry(3, 100, &LinkImpairment { duplicated: 1.0, ..NONE }).len(), 200);
    }

    #[test]
    fn late_packets_keep_their_order_and_jittered_ones_overtake() {
        let late = carry(1, 50, &LinkImpairment { late_ms: 12.5, ..NONE });
        assert_eq!(late, (0..50).map(|n| (n, u128::from(n) * 1000 + 12_500)).collect::<Vec<_>>());
        let jitter = carry(1, 1000, &LinkImpairment { jitter_ms: 5.0, ..NONE });
        assert!(jitter.iter().all(|&(n, at)| (0..=5000).contains(&(at - u128::from(n) * 1000))));
        assert!(!numbers(&jitter).is_sorted() && jitter.iter().map(|(_, at)| at).is_sorted());
    }

    #[test]
    fn the_seed_decides_and_one_fault_leaves_the_losses_of_another() {
        let faults = LinkImpairment { loss: 0.3, jitter_ms: 5.0, ..NONE };
        assert_eq!(carry(4, 300, &faults), carry(4, 300, &faults));
        assert_ne!(carry(4, 300, &faults), carry(5, 300, &faults));
        let mut with = numbers(&carry(4, 300, &faults));
        with.sort_unstable();
        assert_eq!(with, numbers(&carry(4, 300, &LinkImpairment { loss: 0.3, ..NONE })));
    }

    #[test]
    fn the_way_holds_no_more_than_a_socket_does() {
        let (mut way, now) = (link(1), Instant::now());
        for _ in 0..MAX_IN_FLIGHT + 5 {
            way.send(vec![0], now, &LinkImpairment { late_ms: 1.0, ..NONE });
        }
        let later = now + Duration::from_secs(1);
        assert_eq!(std::iter::from_fn(|| way.arrived(later)).count(), MAX_IN_FLIGHT);
    }

    proptest! {
        #[test]
        fn no_packet_is_made_up_early_or_lost_without_a_fault(
            seed: u64, loss in 0.0..1.0_f64, late_ms in 0.0..10_000.0_f64, duplicated in 0.0..1.0_f64,
            jitter_ms in 0.0..10_000.0_f64, count in 0_u32..200,
        ) {
            let faults = LinkImpairment { stall: false, loss, late_ms, duplicated, jitter_ms };
            let seen = carry(seed, count, &faults);
            let mut copies = vec![0; count as usize];
            for &(number, at) in &seen {
                copies[number as usize] += 1;
                let delay = at as f64 - f64::from(number) * 1000.0;
                prop_assert!(delay >= late_ms * 1000.0 - 0.5);
                prop_assert!(delay <= (late_ms + jitter_ms) * 1000.0 + 0.5);
            }
            prop_assert!(copies.iter().all(|copies| *copies <= 2));
            prop_assert!(seen.iter().map(|(_, at)| at).is_sorted());
            let lossless = numbers(&carry(seed, count, &LinkImpairment { loss: 0.0, duplicated: 0.0, ..faults }));
            prop_assert_eq!(lossless.len(), count as usize);
        }
    }
}
