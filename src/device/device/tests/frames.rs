//! Frames at their ticks: late, repeated, missing, clipped, slewed.

use super::*;

#[test]
fn late_duplicate_and_missing_frames_are_counted() {
    let mut bench = Bench::armed();
    bench.at(30_000);
    bench.frame(1, [5, 0]);
    assert_eq!(bench.core.counters().late, 1);
    let packet = frame::packet(bench.seq, 2, &[[9, 9]; 24]).unwrap();
    bench.at(40_000).bytes(packet.as_bytes());
    assert_eq!(bench.core.counters().dup, 1);
    assert_eq!(
        bench.core.age_ms(),
        10,
        "a duplicate renews the lease, not the age"
    );
    bench.at(50_000);
    assert_eq!(
        bench.core.output()[0],
        [5, 0],
        "late frames take the next tick"
    );
    bench.at(75_000);
    assert_eq!(bench.core.counters().underrun, 1);
    assert_eq!(bench.core.state(), DeviceState::Hold);
    let last = bench.frame(4, [6, 0]);
    bench.at(100_000);
    assert_eq!(bench.core.state(), DeviceState::Run);
    assert_eq!(bench.last_status().unwrap().last_seq, last);
    assert_eq!(bench.sink.applied, [(2, last - 1), (4, last)]);
}

#[test]
fn apply_ticks_compare_across_the_wrap() {
    let mut bench = Bench::armed();
    bench.core.now_us = u64::from(u32::MAX - 1) * TICK;
    bench.core.session.as_mut().unwrap().last_valid_us = bench.core.now_us;
    // The next tick is FFFFFFFF, which as a stamp means "next"; 0 and 1 lie behind the wrap.
    bench.frame(NEXT_TICK, [1, 0]);
    bench.frame(0, [2, 0]);
    bench.frame(1, [3, 0]);
    assert_eq!(bench.core.counters().late, 0);
    assert_eq!(bench.core.queue.len(), 3);
    bench.frame(u32::MAX - 1, [4, 0]);
    assert_eq!(bench.core.counters().late, 1);
    let now = bench.now();
    bench.at(now + TICK);
    assert_eq!(bench.core.output()[0], [4, 0]);
    bench.at(now + 2 * TICK);
    assert_eq!((bench.core.tick(), bench.core.output()[0]), (0, [2, 0]));
}

#[test]
fn half_the_clock_away_is_late_and_one_tick_less_is_too_far_ahead() {
    let mut bench = Bench::armed();
    bench.at(75_000);
    assert_eq!(
        bench.frame_ack(3 + (1 << 31)),
        None,
        "the difference is −2³¹"
    );
    assert_eq!(bench.core.counters().late, 1);
    let far = 2 + (1 << 31);
    assert_eq!(bench.frame_ack(far), Some(AckCode::QueueFull));
    assert_eq!(bench.core.counters().late, 1);
}

#[test]
fn clipping_counts_values_and_channels_and_masked_channels_stay_silent() {
    let config = Config {
        comp_limit: [40_000, 65_535],
        mask: ChannelMask::from_first_word(0b111),
        ..wish()
    };
    let mut bench = Bench::armed_with(&config);
    bench.frame(1, [50_000, 50_000]);
    // Three channels: one value over the limit each, then 90000 shared.
    assert_eq!(bench.core.counters().clipped, 6);
    bench.at(25_000);
    let output = bench.core.output();
    assert_eq!(output[2], [29_126, 36_408]);
    assert_eq!(output[3], [0, 0]);
}

#[test]
fn slew_moves_every_component_a_step_a_tick_also_in_hold() {
    let mut bench = Bench::armed_with(&Config {
        slew: 1000,
        ..wish()
    });
    bench.frame(1, [2500, 800]);
    bench.at(25_000);
    assert_eq!(bench.core.output()[0], [1000, 800]);
    bench.at(50_000);
    assert_eq!(bench.core.output()[0], [2000, 800]);
    bench.frame(3, [0, 0]);
    bench.at(75_000);
    assert_eq!(bench.core.output()[0], [1000, 0]);
}

/// 400 frames at depth 2 with garbage, a repeated, a bit-flipped and a truncated frame: the
/// counters of the C prototype.
#[test]
fn the_prototype_run_is_reproduced() {
    let mut bench = Bench::armed();
    for tick in 0..400_u32 {
        bench.at(u64::from(tick) * 25_000 + 3000);
        bench.seq += 1;
        let packet = frame::packet(bench.seq, tick + 2, &[[1000, 500]; 24]).unwrap();
        let mut wire = packet.as_bytes().to_vec();
        match tick {
            100 => wire = [b"AT+GCAP\r\n".as_slice(), &wire].concat(),
            150 => wire = [wire.clone(), wire].concat(),
            200 => wire[40] ^= 4,
            250 => wire.truncate(60),
            _ => {}
        }
        bench.bytes(&wire);
    }
    let expected = CoreCounters {
        underrun: 3,
        late: 0,
        dup: 1,
        bad: 3,
        clipped: 0,
    };
    assert_eq!(bench.core.counters(), expected);
    assert_eq!(bench.core.state(), DeviceState::Run, "the stream continued");
}
