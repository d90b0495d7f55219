//! Each fault of a direction: how often, when, and what comes out.

use super::*;

fn lane(faults: LinkFaults) -> FaultyChannel {
    FaultyChannel::new(faults, Direction::ToHost, 7)
}

/// Sends `n` writes of `length` bytes 25 ms apart; what arrives and when.
fn through(faults: LinkFaults, n: u64, length: usize) -> (Vec<(u64, Vec<u8>)>, Vec<Injection>) {
    let mut link = lane(faults);
    let mut arrived = Vec::new();
    let bytes: Vec<u8> = (0..=u8::MAX).cycle().take(length).collect();
    for write in 0..n {
        link.send(write * 25_000, &bytes);
        while let Some(due_us) = link.next_due_us().filter(|us| *us <= (write + 1) * 25_000) {
            link.make_due(due_us);
            while let Some(bytes) = link.take(due_us) {
                arrived.push((due_us, bytes));
            }
        }
    }
    (arrived, link.take_injections())
}

fn amount(injections: &[Injection], kind: InjectionKind) -> u64 {
    let of_kind = injections.iter().filter(|it| it.kind == kind);
    of_kind.map(|it| it.amount).sum()
}

#[test]
fn a_lane_without_faults_passes_everything_at_once() {
    let (arrived, injections) = through(LinkFaults::default(), 10, 111);
    assert!(injections.is_empty());
    for (write, (at_us, bytes)) in (0..).zip(&arrived) {
        assert_eq!((*at_us, bytes.len()), (write * 25_000, 111));
    }
    assert_eq!(arrived.len(), 10);
}

#[test]
fn bytes_are_dropped_changed_and_inserted_as_often_as_was_said() {
    let rate = 0.01;
    for (nth, kind) in [
        InjectionKind::Dropped(Direction::ToHost),
        InjectionKind::Flipped(Direction::ToHost),
        InjectionKind::Inserted(Direction::ToHost),
    ]
    .into_iter()
    .enumerate()
    {
        let mut rates = [0.0; 3];
        rates[nth] = rate;
        let faults = LinkFaults {
            drop_rate: rates[0],
            flip_rate: rates[1],
            insert_rate: rates[2],
            ..LinkFaults::default()
        };
        let (arrived, injections) = through(faults, 1000, 100);
        let harmed = amount(&injections, kind);
        // 1000 expected, standard deviation 31.
        assert!((850..1150).contains(&harmed), "{kind:?}: {harmed}");
        let n_bytes: usize = arrived.iter().map(|(_, bytes)| bytes.len()).sum();
        let n_bytes = n_bytes as u64;
        let wanted = [100_000 - harmed, 100_000, 100_000 + harmed][nth];
        assert_eq!(n_bytes, wanted, "{kind:?}");
        let original: Vec<u8> = (0..=u8::MAX).cycle().take(100).collect();
        let n_whole = arrived
            .iter()
            .filter(|(_, bytes)| *bytes == original)
            .count();
        assert!((300..450).contains(&n_whole), "e⁻¹ of all: {n_whole}");
    }
}

#[test]
fn a_rate_of_one_harms_every_byte_and_none_stays_as_it_was() {
    let faults = LinkFaults {
        flip_rate: 1.0,
        ..LinkFaults::default()
    };
    let (arrived, _) = through(faults, 20, 256);
    let untouched = |bytes: &[u8]| (0..=u8::MAX).zip(bytes).any(|(was, is)| was == *is);
    assert!(arrived.iter().all(|(_, bytes)| !untouched(bytes)));
}

#[test]
fn usb_packets_are_lost_whole_and_writes_come_twice() {
    let faults = LinkFaults {
        usb_loss_rate: 0.5,
        ..LinkFaults::default()
    };
    let (arrived, injections) = through(faults, 400, 111);
    let lengths: Vec<usize> = arrived.iter().map(|(_, bytes)| bytes.len()).collect();
    assert!(
        lengths.iter().all(|n| [64, 47, 111].contains(n)),
        "{lengths:?}"
    );
    let lost = injections.len();
    assert!((330..470).contains(&lost), "400 of 800: {lost}");
    let faults = LinkFaults {
        repeat_rate: 1.0,
        ..LinkFaults::default()
    };
    assert_eq!(through(faults, 5, 20).0.len(), 10);
}

#[test]
fn latencies_keep_the_order_and_their_shape() {
    let faults = LinkFaults {
        latency: Latency::Normal {
            mean_us: 20_000,
            deviation_us: 15_000,
        },
        hiccup_rate: 0.1,
        hiccup_us: 50_000,
        ..LinkFaults::default()
    };
    let (arrived, injections) = through(faults, 500, 3);
    assert!(arrived.windows(2).all(|two| two[0].0 <= two[1].0));
    let hiccups = injections.len();
    assert!((25..80).contains(&hiccups), "50 of 500: {hiccups}");
    let mut cdc = lane(LinkFaults {
        latency: Latency::UsbFrame,
        ..LinkFaults::default()
    });
    cdc.send(1234, &[1]);
    assert_eq!(cdc.next_due_us(), Some(2000));
}

#[test]
fn on_a_serial_line_bytes_come_one_behind_the_other() {
    let mut line = lane(LinkFaults {
        baud: Some(115_200),
        ..LinkFaults::default()
    });
    // A FRAME takes 111 · 10 / 115200 s, and what follows waits for it.
    line.send(1000, &[1; 111]);
    line.send(1200, &[2; 14]);
    assert_eq!(line.next_due_us(), Some(1000 + 9636));
    assert_eq!(line.take(10_636).unwrap(), [1; 111]);
    assert_eq!(line.next_due_us(), Some(10_636 + 1216));
    assert_eq!(line.take(11_852).unwrap(), [2; 14]);
    line.send(20_000, &[3]);
    assert_eq!(line.next_due_us(), Some(20_087), "free again");
}

#[test]
fn an_adapter_waits_for_its_timer_or_for_62_bytes() {
    let mut ftdi = lane(LinkFaults {
        latency: Latency::Timer(16_000),
        ..LinkFaults::default()
    });
    ftdi.send(500, &[1; 47]);
    assert_eq!(ftdi.next_due_us(), Some(16_500));
    ftdi.send(3500, &[2; 10]);
    assert_eq!(ftdi.next_due_us(), Some(16_500), "together");
    ftdi.send(4200, &[3; 10]);
    assert_eq!(ftdi.next_due_us(), Some(5000), "full: all of it leaves");
    assert_eq!(ftdi.take(5000).unwrap(), [1; 47]);
    assert_eq!(ftdi.take(5000).unwrap(), [2; 10]);
    assert_eq!(ftdi.take(5000).unwrap(), [3; 10]);
    ftdi.send(30_000, &[4]);
    assert_eq!(ftdi.next_due_us(), Some(46_000), "a new timer");
}

#[test]
fn a_stalled_lane_holds_at_most_its_room_and_then_gives_it() {
    let mut stalled = lane(LinkFaults::default());
    stalled.stall(1_000_000);
    for write in 0..1000 {
        stalled.send(write, &[7; 100]);
    }
    assert!(stalled.take(999_999).is_none());
    assert_eq!(stalled.next_due_us(), Some(1_000_000));
    let mut n_bytes = 0;
    while let Some(bytes) = stalled.take(1_000_000) {
        n_bytes += bytes.len();
    }
    assert_eq!(n_bytes, ROOM / 100 * 100);
    let lost = amount(
        &stalled.take_injections(),
        InjectionKind::Overflow(Direction::ToHost),
    );
    assert_eq!(lost, 100_000 - n_bytes as u64);
}

#[test]
fn garbage_comes_by_itself_at_the_mean_interval() {
    let mut noisy = lane(LinkFaults {
        garbage_every_us: Some(100_000),
        ..LinkFaults::default()
    });
    let mut n_bursts = 0;
    while let Some(due_us) = noisy.next_due_us().filter(|us| *us < 100_000_000) {
        noisy.make_due(due_us);
        while let Some(burst) = noisy.take(due_us) {
            assert!((8..=120).contains(&burst.len()));
            n_bursts += 1;
        }
    }
    assert!((850..1150).contains(&n_bursts), "{n_bursts}");
}

#[test]
fn a_modem_manager_asks_before_each_visit_and_not_within_one() {
    let faults = LinkFaults {
        chatter: true,
        ..LinkFaults::default()
    };
    let mut chatty = FaultyChannel::new(faults, Direction::ToDevice, 7);
    for at_us in [0, 500_000, 1_000_000, 9_000_000] {
        chatty.send(at_us, &[0]);
    }
    let mut arrived = Vec::new();
    while let Some(bytes) = chatty.take(9_000_000) {
        arrived.push(bytes == AT_CHATTER);
    }
    assert_eq!(arrived, [true, false, false, false, true, false]);
}
