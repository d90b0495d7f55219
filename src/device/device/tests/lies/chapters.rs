//! The sessions that every lie is tried with.

use super::*;

/// Sessions that together use every rule, each with a device that has just booted.
pub(super) const CHAPTERS: &[fn(&mut Trial)] = &[
    without_a_session,
    framing,
    lengths,
    opening,
    configuring,
    limits,
    arming,
    frames_in_time,
    frames_out_of_time,
    repeated_frames,
    silence,
    frames_in_the_ramp,
    stops,
    stops_elsewhere,
    lease,
    faults,
    idents,
    hellos_while_running,
    a_pulled_cable,
    a_long_wait,
];

fn every_request(it: &mut Trial) {
    it.configure(&Config {
        hold_ms: 20,
        ..wish()
    });
    it.send(&Arm::new(SESSION)).frame(1, [9000, 0]);
    it.ident(3, 10, 777).send(&Clear { bits: 1 });
    it.send(&Ping { token: 1 });
}

fn without_a_session(it: &mut Trial) {
    every_request(it);
    it.stop(StopHow::Ramp).tick();
    it.stop(StopHow::Now).tick().configure(&wish()).tick();
}

fn framing(it: &mut Trial) {
    it.send(&Hello::new(SESSION)).wait(30);
    it.bytes(&[0, 0, 0, 1, 0, 1, 1, 0]).bytes(b"AT+GCAP\r\n\0");
    it.send(&Ping { token: 2 }).wait(30);
    let ping = Ping { token: 3 }.packet(77).unwrap();
    let mut spoilt = ping.as_bytes().to_vec();
    let last = spoilt.len() - 2;
    spoilt[last] ^= 0x40;
    it.bytes(&spoilt).send(&Ping { token: 4 });
    let flagged = Packet::sealed(&[kind::PING, 1, 9, 0, 1, 2, 3, 4]).unwrap();
    it.bytes(flagged.as_bytes());
    // A body of 256 bytes that ends with a full block, with and without the 01 behind it.
    let full = |seq| Packet::encode(0x44, seq, &[0x55; 248]).unwrap();
    let seq = (0x0101..=u16::MAX)
        .find(|seq| full(*seq).as_bytes()[3] == u8::MAX)
        .unwrap();
    let wire = full(seq).as_bytes().to_vec();
    it.bytes(&wire);
    it.bytes(&[&wire[..wire.len() - 1], &[1, 0]].concat());
    it.raw(0x44, &[0x55; 249])
        .raw(kind::PING, &[7; 210])
        .wait(30);
}

fn lengths(it: &mut Trial) {
    it.running();
    for (kind, length) in [
        (1, 16),
        (2, 20),
        (3, 8),
        (4, 100),
        (5, 2),
        (6, 4),
        (7, 2),
        (9, 6),
    ] {
        it.raw(kind, &vec![0; length - 1]);
    }
    it.raw(kind::FRAME, &[1; 101]).raw(kind::PING, &[1; 5]);
    it.raw(kind::SAMPLES, &[0; 56])
        .raw(0x0a, &[0; 8])
        .raw(0x81, &[0; 80])
        .tick();
    let quick = Hello {
        lease_ms: 100,
        ..Hello::new(SESSION)
    };
    it.send(&quick)
        .wait(80)
        .raw(kind::PING, &[0; 3])
        .bytes(&[0, 1, 0])
        .wait(60);
}

fn opening(it: &mut Trial) {
    it.send(&Hello {
        magic: *b"HBP2",
        ..Hello::new(7)
    })
    .wait(30);
    it.send(&Hello::new(0)).wait(30).running();
    it.send(&Hello {
        ver_min: 2,
        ver_max: 9,
        ..Hello::new(8)
    })
    .tick();
    it.send(&Hello {
        host_flags: 0,
        ..Hello::new(9)
    })
    .tick()
    .tick();
    it.send(&Hello {
        lease_ms: 0,
        ..Hello::new(9)
    })
    .wait(990)
    .wait(50);
    it.send(&Hello {
        lease_ms: 150,
        ..Hello::new(9)
    })
    .wait(300);
    it.send(&Hello::new(10)).send(&Arm::new(10)).tick();
}

fn configuring(it: &mut Trial) {
    it.ready()
        .wait(30)
        .configure(&Config {
            hold_ms: 30,
            ..wish()
        })
        .tick();
    for config in [
        Config {
            hold_ms: 101,
            ramp_ms: 0,
            ..wish()
        },
        Config {
            hold_ms: 90,
            ramp_ms: 90,
            ..wish()
        },
        Config {
            hv_dv: 9999,
            slew: 60_000,
            comp_limit: [65_535; 2],
            ..wish()
        },
        Config {
            mode: 1,
            flags: 1,
            mask: ChannelMask::first(32),
            ..wish()
        },
        Config {
            mode: 1,
            flags: 255,
            ..wish()
        },
    ] {
        it.configure(&config);
    }
    it.configure(&wish())
        .send(&Arm::new(SESSION))
        .configure(&wish())
        .frame(1, [20_000, 0])
        .tick();
    it.configure(&Config {
        hold_ms: 20,
        ramp_ms: 10,
        ..wish()
    })
    .wait(120);
}

fn limits(it: &mut Trial) {
    let play = |it: &mut Trial, config: &Config, codes| {
        it.send(&Hello::new(SESSION))
            .configure(config)
            .send(&Arm::new(SESSION));
        it.frame(1, codes).frame(3, [0, 0]).tick();
        it.wait(5).tick().tick();
        it.stop(StopHow::Now).wait(2);
    };
    let loud = [50_000, 40_000];
    play(it, &wish(), loud);
    play(
        it,
        &Config {
            comp_limit: [30_000, 45_000],
            ..wish()
        },
        loud,
    );
    play(
        it,
        &Config {
            comp_limit: [0, 20_000],
            ..wish()
        },
        [100, 100],
    );
    play(
        it,
        &Config {
            mask: ChannelMask::from_first_word(0b101),
            ..wish()
        },
        loud,
    );
    play(
        it,
        &Config {
            mask: ChannelMask::default(),
            ..wish()
        },
        [100, 100],
    );
    play(
        it,
        &Config {
            slew: 1000,
            ..wish()
        },
        [2500, 800],
    );
    play(it, &Config { slew: 0, ..wish() }, [2500, 800]);
    play(
        it,
        &Config {
            comp_limit: [500, 0],
            slew: 1000,
            ..wish()
        },
        [0x0102, 0x0304],
    );
}

fn arming(it: &mut Trial) {
    it.send(&Hello::new(SESSION))
        .send(&Arm::new(SESSION))
        .wait(30);
    it.send(&Hello::new(SESSION))
        .frame(1, [100, 100])
        .tick()
        .configure(&wish())
        .tick();
    it.frame(1, [100, 100]).tick();
    it.stop(StopHow::Now).send(&Arm::new(1));
    it.send(&Arm {
        session: SESSION,
        key: SESSION,
    })
    .wait(3)
    .send(&Arm::new(SESSION));
    it.send(&Arm::new(SESSION)).wait(30);
    for _ in 0..8 {
        it.wait(90).send(&Ping { token: 5 });
    }
    it.frame(1, [100, 100])
        .tick()
        .send(&Arm::new(SESSION))
        .tick();
    it.stop(StopHow::Now).tick();
}

fn frames_in_time(it: &mut Trial) {
    it.armed().tick();
    for codes in [[1000, 500], [3000, 0], [0x0102, 0x0304]] {
        it.frame(1, codes).tick();
    }
    it.frame(3, [2, 0])
        .frame(2, [3, 0])
        .frame(1, [4, 0])
        .frame(2, [5, 0]);
    it.frame(4, [70, 0])
        .frame(5, [6, 0])
        .frame(8, [7, 0])
        .frame(200, [7, 0]);
    for _ in 0..6 {
        it.tick();
    }
}

fn frames_out_of_time(it: &mut Trial) {
    it.running();
    it.frame(NEXT_TICK.wrapping_sub(it.core.tick()), [8, 8])
        .tick()
        .frame(3, [50_000; 2])
        .tick();
    it.frame(0, [4000, 0])
        .tick()
        .frame(u32::MAX, [4500, 0])
        .tick();
    it.frame(2, [5000, 5000])
        .wait(30)
        .frame(9, [1, 1])
        .wait(30)
        .frame(1, [600, 0])
        .tick()
        .tick();
    it.frame(1, [700, 0]).tick().tick();
}

fn repeated_frames(it: &mut Trial) {
    it.running().tick();
    let (seq, tick) = (it.seq, it.core.tick());
    it.frame_of_seq(seq, tick + 1, [900, 900]).tick();
    let token = Ping { token: 6 }.packet(seq).unwrap();
    it.bytes(token.as_bytes());
    it.frame(9, [1, 1]);
    let refused = it.seq;
    it.frame_of_seq(refused, it.core.tick() + 1, [800, 800])
        .tick();
    it.frame_of_seq(refused, it.core.tick() + 1, [801, 800])
        .wait(150);
    let quick = Hello {
        lease_ms: 60,
        ..Hello::new(SESSION)
    };
    it.send(&quick)
        .wait(3)
        .configure(&wish())
        .send(&Arm::new(SESSION));
    it.frame_of_seq(refused, it.core.tick() + 1, [802, 0])
        .wait(40);
    it.frame_of_seq(refused, it.core.tick() + 1, [803, 0])
        .wait(40);
}

fn silence(it: &mut Trial) {
    for (hold_ms, ramp_ms, wait_ms) in [(60, 40, 1), (20, 0, 4), (50, 50, 9)] {
        it.send(&Hello::new(SESSION)).configure(&Config {
            hold_ms,
            ramp_ms,
            ..wish()
        });
        it.send(&Arm::new(SESSION)).tick().frame(1, [40_000, 0]);
        for _ in 0..30 {
            it.wait(5 + wait_ms);
        }
        it.frame(1, [1000, 0]).tick();
    }
}

fn frames_in_the_ramp(it: &mut Trial) {
    it.running();
    let now_ms = it.core.now_us % TICK / MS_US;
    it.wait(55 - now_ms)
        .frame(1, [20_000, 10_000])
        .wait(20)
        .frame(1, [20_000, 10_000])
        .tick();
    it.frame(1, [30_000, 0]).wait(150);
}

fn stops(it: &mut Trial) {
    it.running()
        .frame(3, [9, 9])
        .stop(StopHow::Ramp)
        .wait(10)
        .frame(1, [500, 500])
        .wait(80);
    it.send(&Arm::new(SESSION)).tick().tick().tick();
    it.running()
        .stop(StopHow::Now)
        .wait(10)
        .frame(1, [500, 500])
        .tick();
    it.running().wait(50).stop(StopHow::Ramp).wait(80);
}

fn stops_elsewhere(it: &mut Trial) {
    it.ready()
        .stop(StopHow::Ramp)
        .tick()
        .send(&Arm::new(SESSION))
        .stop(StopHow::Ramp)
        .tick();
    it.running().breaks_down().stop(StopHow::Now).tick();
}

fn lease(it: &mut Trial) {
    let quick = Hello {
        lease_ms: 100,
        ..Hello::new(SESSION)
    };
    it.send(&quick)
        .wait(90)
        .send(&Ping { token: 7 })
        .wait(60)
        .bytes(&[0, 1, 0])
        .wait(160);
    it.send(&Hello {
        lease_ms: 40,
        ..quick
    })
    .configure(&wish())
    .send(&Arm::new(SESSION));
    it.frame(1, [20_000, 0])
        .wait(150)
        .send(&Hello::new(9))
        .wait(60);
    it.send(&Hello {
        lease_ms: 500,
        ..quick
    })
    .wait(700)
    .wait(1200);
}

fn faults(it: &mut Trial) {
    let bits = fault_bit::OVER_CURRENT;
    it.running().breaks_down().wait(230);
    every_request(it);
    it.send(&Hello::new(SESSION))
        .wait(30)
        .configure(&wish())
        .send(&Clear { bits })
        .wait(30);
    it.core.end_fault_cause(bits);
    it.wait(30)
        .send(&Clear { bits: 1 })
        .wait(30)
        .send(&Clear { bits })
        .tick();
    it.send(&Hello {
        lease_ms: 30,
        ..Hello::new(SESSION)
    })
    .breaks_down()
    .wait(400);
    it.send(&Hello::new(SESSION)).wait(30);
}

fn idents(it: &mut Trial) {
    it.ready().ident(3, 10, 777).wait(5).configure(&Config {
        comp_limit: [65_535, 1000],
        mask: ChannelMask::first(12),
        ..wish()
    });
    it.send(&Arm::new(SESSION))
        .ident(3, 10, 777)
        .wait(20)
        .ident(4, 20, 4000)
        .wait(30);
    it.ident(20, 20, 777)
        .wait(5)
        .ident(24, 10, 777)
        .ident(3, 1001, 777)
        .wait(5);
    it.ident(3, 500, 777)
        .frame(1, [20, 20])
        .wait(30)
        .ident(3, 10, 777)
        .stop(StopHow::Now);
}

fn hellos_while_running(it: &mut Trial) {
    it.running()
        .frame(3, [9, 9])
        .frame(0, [8, 8])
        .send(&Hello::new(9))
        .tick()
        .tick();
    it.send(&Arm::new(9)).tick().send(&Hello::new(10)).tick();
}

fn a_pulled_cable(it: &mut Trial) {
    it.running();
    it.core.hang_up(&mut it.sent);
    it.wait(60);
}

fn a_long_wait(it: &mut Trial) {
    it.armed();
    for turn in 0..220 {
        if turn % 2 == 0 {
            it.frame(1, [4000, 4000]);
        }
        it.tick();
    }
}
