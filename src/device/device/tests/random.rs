//! Random bytes and packets: no panic, no arming, bounded answers.

use proptest::prelude::*;

use super::*;

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn random_bytes_never_arm(
        chunks in prop::collection::vec(
            (0u64..50_000, prop::collection::vec(any::<u8>(), 0..80)), 0..20),
    ) {
        let mut bench = Bench::ready();
        for (wait_us, bytes) in chunks {
            let now = bench.now() + wait_us;
            bench.core.receive(now, &bytes, &mut bench.sink);
            prop_assert!(!bench.core.state().is_live());
            prop_assert!(bench.is_silent());
        }
    }

    /// Valid packets with random contents: only the right ARM arms, and the bytes sent stay few.
    #[test]
    fn random_packets_never_arm_and_answers_are_bounded(
        packets in prop::collection::vec(
            (0u8..12, any::<u16>(), prop::collection::vec(any::<u8>(), 0..110)), 0..60),
    ) {
        let mut bench = Bench::ready();
        for (kind, seq, payload) in &packets {
            let packet = Packet::encode(*kind, *seq, payload).unwrap();
            let now = bench.now() + 1000;
            bench.core.receive(now, packet.as_bytes(), &mut bench.sink);
            prop_assert!(!bench.core.state().is_live());
        }
        prop_assert!(bench.sink.bytes.len() <= packets.len() * 110 + 200);
    }

    /// Whatever an armed device receives, its output keeps its bounds and dies with the frames.
    #[test]
    fn random_packets_to_an_armed_device_end_in_silence(
        packets in prop::collection::vec(
            (3u8..10, any::<u16>(), 0u64..40_000, prop::collection::vec(any::<u8>(), 100)), 0..40),
    ) {
        let mut bench = Bench::armed();
        for (kind, seq, wait_us, payload) in &packets {
            let packet = Packet::encode(*kind, *seq, payload).unwrap();
            let now = bench.now() + wait_us;
            bench.core.receive(now, packet.as_bytes(), &mut bench.sink);
            for [low, high] in bench.core.output() {
                prop_assert!(u32::from(low) + u32::from(high) <= 65535);
            }
        }
        let now = bench.now();
        bench.at(now + 1_000_000);
        prop_assert!(bench.is_silent());
    }
}
