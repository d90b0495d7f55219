//! Programs that connect: what they are told, and who moves the display.

use std::io::{BufRead as _, BufReader, Write as _};
use std::net::TcpStream;
use std::time::Instant;

use super::super::{PointerInput, Reading};
use super::*;

fn link() -> ProgramLink {
    ProgramLink::listen(loopback("127.0.0.1:0").unwrap()).unwrap()
}

fn connect(link: &ProgramLink) -> TcpStream {
    let stream = TcpStream::connect(link.address()).unwrap();
    stream
        .set_read_timeout(Some(Duration::from_secs(10)))
        .unwrap();
    stream
}

fn source(link: &ProgramLink) -> Box<dyn PointerInput> {
    match link.source() {
        InputSource::Live(input) => input,
        other => panic!("{other:?}"),
    }
}

/// Waits until something holds; another machine's load must not fail a test.
fn eventually(what: &str, mut holds: impl FnMut() -> bool) {
    let deadline = Instant::now() + Duration::from_secs(20);
    while !holds() {
        assert!(Instant::now() < deadline, "{what}");
        thread::sleep(Duration::from_millis(2));
    }
}

/// Polls until so many places came; gives their x and the last reading.
fn places(input: &mut dyn PointerInput, n: usize) -> Vec<f64> {
    let mut x_mm = Vec::new();
    eventually("places", || {
        input.poll(Instant::now(), &mut |sample| {
            x_mm.push(sample.position.x_mm);
        });
        x_mm.len() >= n
    });
    x_mm
}

fn send_ticks(link: &ProgramLink, tick: f64) {
    let mut text = String::new();
    let felt = FeltTick {
        tick,
        place: [1.5, 2.0, 0.0],
        amplitudes_um: vec![0.25, 3.0],
    };
    write_line(&felt, &mut text);
    link.shared.state().send(&Arc::from(text.as_str()));
}

#[test]
fn only_this_machine_is_listened_to() {
    assert_eq!(
        loopback("localhost:7240").unwrap().to_string(),
        "127.0.0.1:7240"
    );
    assert!(loopback("[::1]:7240").is_ok(), "the other loopback");
    for wrong in ["0.0.0.0:7240", "192.168.1.2:7240", "[::]:1"] {
        let error = loopback(wrong).unwrap_err().to_string();
        assert!(error.contains("other machines"), "{error}");
        assert!(
            ProgramLink::listen(wrong.parse().unwrap()).is_err(),
            "{wrong}"
        );
    }
    for wrong in ["", "7240", "127.0.0.1", "host:x", "example.org:80"] {
        assert!(
            loopback(wrong)
                .unwrap_err()
                .to_string()
                .contains("is no address")
        );
    }
    let first = link();
    let taken = ProgramLink::listen(first.address())
        .unwrap_err()
        .to_string();
    assert!(taken.contains("choose another port"), "{taken}");
}

#[test]
fn every_reader_hears_the_header_and_every_tick() {
    let link = link();
    let _tap = link.tap(1).unwrap();
    let readers: Vec<TcpStream> = (0..3).map(|_| connect(&link)).collect();
    eventually("three", || link.counts().connected == 3);
    for tick in 40..43 {
        send_ticks(&link, f64::from(tick));
    }
    for reader in readers {
        let lines: Vec<String> = BufReader::new(reader)
            .lines()
            .take(4)
            .map(Result::unwrap)
            .collect();
        assert_eq!(lines[0], "tick,t_s,x_mm,y_mm,angle_deg,a40_um_0,a320_um_0");
        assert_eq!(lines[1], "40,1,1.5,2,0,0.25,3");
        assert_eq!(lines[3], "42,1.05,1.5,2,0,0.25,3");
    }
}

#[test]
fn the_first_who_says_a_position_moves_the_display_until_it_goes() {
    let link = link();
    let mut input = source(&link);
    let mut first = connect(&link);
    let mut second = connect(&link);
    first
        .write_all(b"t_s,x_mm,y_mm\n0,1,2\n0.01,3,4,30\nnonsense\n")
        .unwrap();
    assert_eq!(places(&mut *input, 2), [1.0, 3.0]);
    assert_eq!(
        (input.angle_deg(), input.kind()),
        (Some(30.0), SourceKind::Program)
    );
    eventually("bad", || input.losses().bad_lines == 1);
    second.write_all(b"5,6\n7,8\nnonsense\n").unwrap();
    let mut described = String::new();
    // The header of no contactors comes first where nobody taps.
    let mut reader = BufReader::new(&second);
    while !described.starts_with('#') {
        described.clear();
        reader.read_line(&mut described).unwrap();
    }
    assert!(
        described.contains("another program moves the display"),
        "{described}"
    );
    // All that it said was heard while the first was there: else it would be the next who moves.
    eventually("heard", || input.losses().bad_lines == 2);
    drop(first);
    eventually("the first is gone", || !link.counts().has_writer);
    let lifted = input.poll(Instant::now(), &mut |sample| panic!("{sample:?}"));
    assert_eq!(
        lifted,
        Reading::Lifted,
        "a program that goes lets go of the finger"
    );
    second.write_all(b"9,6\n").unwrap();
    assert_eq!(places(&mut *input, 1), [9.0]);
}

#[test]
fn a_reader_that_does_not_read_is_let_go_and_nobody_waits() {
    let link = link();
    let slow = connect(&link);
    eventually("connected", || link.counts().connected == 1);
    let begun = Instant::now();
    // The system takes some hundred kilobytes before the queue fills.
    let mut tick = 0.0;
    while link.counts().connected == 1 {
        tick += 1.0;
        send_ticks(&link, tick);
        assert!(
            begun.elapsed() < Duration::from_secs(20),
            "after {tick} lines"
        );
    }
    assert_eq!(link.counts().let_go, 1);
    drop(slow);
}

#[test]
fn a_new_source_takes_the_place_of_the_last() {
    let link = link();
    let _old = source(&link);
    let mut program = connect(&link);
    program.write_all(b"1,1\n").unwrap();
    eventually("heard", || link.counts().has_writer);
    let mut new = source(&link);
    program.write_all(b"2,2\n").unwrap();
    assert_eq!(places(&mut *new, 1), [2.0]);
}
