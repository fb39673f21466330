//! Motor datagrams, as a test bench or another program might send them.

use betadeck::link::proto::servo;

/// Reads the normalised form.
pub fn run(data: &[u8]) {
    match servo::decode(data) {
        Some(motors) => {
            assert!(motors.iter().all(|motor| motor.is_finite()));
            let pulses = motors.map(|motor| 1000.0 + 1000.0 * motor);
            let sent = servo::decode(&servo::encode(pulses));
            if motors.iter().all(|motor| (0.0..=1.0).contains(motor)) {
                let sent = sent.expect("our own datagram");
                // Whole thousandths, rounded down.
                assert!(
                    sent.iter().zip(motors).all(|(sent, motor)| (-0.0005..0.0015).contains(&(motor - sent))),
                    "{motors:?} {sent:?}"
                );
            }
        }
        None => {
            let whole = data.len() >= servo::SIZE;
            let number = |bytes: &[u8; 4]| f32::from_le_bytes(*bytes).is_finite();
            assert!(!whole || !data[..servo::SIZE].as_chunks::<4>().0.iter().all(number));
        }
    }
}
