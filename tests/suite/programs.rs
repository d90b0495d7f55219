//! Another program that joins `selvedge play` by a connection on this machine, and plays on the
//! emulated device.
#![cfg(unix)]

use std::io::{BufRead as _, BufReader, Write as _};
use std::net::TcpStream;
use std::process::Stdio;
use std::thread;
use std::time::{Duration, Instant};

use crate::bridge_device::{Device, signal};
use crate::program::{Lab, Outcome};

#[test]
fn a_program_says_positions_and_hears_amplitudes_while_the_device_plays_them() {
    let lab = Lab::with_scene();
    let device = Device::start(&lab, &[]);
    let args = "play a.scene.toml --listen 127.0.0.1:0 --port array";
    let mut child = lab
        .command(&args.split(' ').collect::<Vec<_>>())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut line = String::new();
    let mut described = BufReader::new(child.stderr.take().unwrap());
    described.read_line(&mut line).unwrap();
    let address = line.trim().rsplit(' ').next().unwrap();
    let mut program = TcpStream::connect(address).unwrap();
    program
        .set_read_timeout(Some(Duration::from_secs(20)))
        .unwrap();
    let mut lines = BufReader::new(program.try_clone().unwrap()).lines();
    let header = lines.next().unwrap().unwrap();
    assert_eq!(header.split(',').count(), 5 + 48, "{header}");

    // Back and forth over the textile until enough is felt where we are.
    let mover = thread::Builder::new()
        .name("mover".to_owned())
        .spawn(move || {
            let start = Instant::now();
            for _ in 0..8000 {
                // A clock that runs slower than ours would make every position old.
                let t_s = start.elapsed().as_secs_f64();
                let x_mm = 30.0 + 20.0 * (10.0 * t_s).sin();
                let sent = writeln!(program, "{t_s},{x_mm},40");
                if sent.is_err() {
                    return;
                }
                thread::sleep(Duration::from_millis(5));
            }
        });
    let mover = mover.unwrap();
    let deadline = Instant::now() + Duration::from_secs(30);
    let mut n_felt = 0;
    while n_felt < 40 {
        let line = lines.next().unwrap().unwrap();
        let numbers: Vec<f64> = line.split(',').map(|n| n.parse().unwrap()).collect();
        assert_eq!(numbers.len(), 53);
        let is_felt = numbers[5..].iter().any(|um| *um > 0.0);
        let is_there = (10.0..=50.0).contains(&numbers[2]) && numbers[3] == 40.0;
        n_felt += u32::from(is_felt && is_there);
        assert!(Instant::now() < deadline, "{line}");
    }
    signal("TERM", &child);
    let outcome = Outcome::of(&child.wait_with_output().unwrap());
    assert_eq!(outcome.code, 0, "{outcome:?}");
    assert!(outcome.out.contains("positions "), "{}", outcome.out);
    mover.join().unwrap();
    let log = device.end(&lab);
    assert!(log.len() > 3, "the device played");
}
