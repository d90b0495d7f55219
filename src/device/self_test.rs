//! A check of a connected device: handshake, pings, one second of faint frames, STOP; each step
//! with its result.
//!
//! It reports and judges nothing but what a working link must do. Printing is left to the caller.

use std::fmt;
use std::time::{Duration, Instant};

use super::codes::ArrayProfile;
use super::handle::{Bridge, Target};
use super::host::{BridgeCounters, BridgeEvent, DisarmedBy};
use super::link::{Spread, Timings};
use super::message::{Caps, StopHow};
use super::session_log::SessionLog;

const N_PINGS: usize = 50;
const N_FRAMES: u64 = 40;
/// Part of full scale that the test frames reach after their soft start.
const FAINT: f64 = 0.02;
/// For the handshake: the session itself gives up after 5 s.
const CONNECT_PATIENCE: Duration = Duration::from_secs(8);
const STEP_PATIENCE: Duration = Duration::from_secs(5);
const NAP: Duration = Duration::from_micros(500);

/// One step of the test.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SelfTestStep {
    /// What was tried.
    pub name: &'static str,
    /// One line on how it went.
    pub outcome: Result<String, String>,
}

/// What the test found.
#[derive(Clone, Debug)]
pub struct SelfTestReport {
    /// The device tested.
    pub target: String,
    /// Steps in order; the first failure is the last step.
    pub steps: Vec<SelfTestStep>,
    /// What the device said of itself.
    pub caps: Option<Caps>,
    /// Counters at the end.
    pub counters: BridgeCounters,
    /// Frame timings.
    pub timings: Timings,
}

impl SelfTestReport {
    /// Whether every step succeeded.
    pub fn passed(&self) -> bool {
        self.steps.iter().all(|step| step.outcome.is_ok())
    }
}

impl fmt::Display for SelfTestReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for step in &self.steps {
            match &step.outcome {
                Ok(line) => writeln!(f, "ok      {:<10} {line}", step.name)?,
                Err(line) => writeln!(f, "failed  {:<10} {line}", step.name)?,
            }
        }
        let verdict = if self.passed() { "passed" } else { "failed" };
        write!(f, "{}: self-test {verdict}", self.target)
    }
}

/// Tests `target`, which takes a few seconds, and writes what happens to `log`. The device is
/// stopped at the end whatever happens.
pub fn self_test(
    target: Target,
    profile: ArrayProfile,
    log: Option<&SessionLog>,
) -> SelfTestReport {
    let n_contactors = profile.n_contactors();
    let faint = profile.full_scale_um.map(faint_um);
    let mut bench = Bench {
        bridge: Bridge::open(target, profile, n_contactors, || {}),
        amplitudes_um: vec![faint; n_contactors],
        steps: Vec::new(),
    };
    if let Some(log) = log {
        let feed = log.feed(bench.bridge.target());
        bench.bridge.log_to(feed);
    }
    // Each step needs the one before.
    let _all = bench.step("handshake", Bench::handshake)
        && bench.step("ping", Bench::pings)
        && bench.step("arm", Bench::arm)
        && bench.step("frames", Bench::frames)
        && bench.step("stop", Bench::stop);
    bench.report()
}

#[expect(clippy::cast_possible_truncation, reason = "amplitudes travel as f32")]
fn faint_um(full_scale_um: f64) -> f32 {
    (FAINT * full_scale_um) as f32
}

struct Bench {
    bridge: Bridge,
    amplitudes_um: Vec<[f32; 2]>,
    steps: Vec<SelfTestStep>,
}

impl Bench {
    fn step(&mut self, name: &'static str, run: fn(&mut Self) -> Result<String, String>) -> bool {
        let outcome = run(self);
        let succeeded = outcome.is_ok();
        self.steps.push(SelfTestStep { name, outcome });
        succeeded
    }

    fn report(self) -> SelfTestReport {
        let report = SelfTestReport {
            target: String::from(self.bridge.target()),
            steps: self.steps,
            caps: self.bridge.caps().copied(),
            counters: self.bridge.counters(),
            timings: self.bridge.timings(),
        };
        // After a failed step this is the STOP; its own failure adds nothing to the report.
        drop(self.bridge.close(STEP_PATIENCE));
        report
    }

    /// Answers ticks until `wanted` takes an event; bad news end the wait.
    fn until<T>(
        &mut self,
        patience: Duration,
        wanted: impl Fn(&BridgeEvent) -> Option<T>,
    ) -> Result<T, String> {
        let deadline = Instant::now() + patience;
        while Instant::now() < deadline {
            let Some(event) = self.bridge.poll() else {
                std::thread::sleep(NAP);
                continue;
            };
            if let BridgeEvent::Tick { received, .. } = event {
                self.bridge.send(&self.amplitudes_um, Some(received));
            }
            if let Some(found) = wanted(&event) {
                return Ok(found);
            }
            match event {
                BridgeEvent::Refused(reason)
                | BridgeEvent::Lost(reason)
                | BridgeEvent::Disarmed { reason, .. } => return Err(reason),
                _ => {}
            }
        }
        Err(format!("nothing came for {} s", patience.as_secs()))
    }

    fn handshake(&mut self) -> Result<String, String> {
        self.until(CONNECT_PATIENCE, |event| match event {
            BridgeEvent::Ready(_) => Some(()),
            _ => None,
        })?;
        let caps = self.bridge.caps().ok_or_else(|| String::from("no CAPS"))?;
        Ok(format!(
            "{}, firmware {}.{}.{}, {} channels ({} × {}), queue {}, \
             {} V drive peak, up to {} bytes",
            if caps.name().is_empty() {
                "unnamed device"
            } else {
                caps.name()
            },
            caps.firmware[0],
            caps.firmware[1],
            caps.firmware[2],
            caps.n_ch,
            caps.rows,
            caps.cols,
            caps.queue,
            f64::from(caps.fs_mv) / 1000.0,
            caps.max_body
        ))
    }

    fn pings(&mut self) -> Result<String, String> {
        let mut round_trips = Vec::with_capacity(N_PINGS);
        for _ in 0..N_PINGS {
            self.bridge.ping();
            round_trips.push(self.until(STEP_PATIENCE, |event| match event {
                BridgeEvent::Pong { round_trip, .. } => Some(*round_trip),
                _ => None,
            })?);
        }
        let spread = Spread::of(&mut round_trips);
        let shortest = round_trips.first().copied().unwrap_or_default();
        Ok(format!(
            "{} round trips: {} shortest, {} median, {} p99",
            spread.n,
            milliseconds(shortest),
            milliseconds(spread.median),
            milliseconds(spread.p99)
        ))
    }

    fn arm(&mut self) -> Result<String, String> {
        if !self.bridge.arm() {
            return Err(format!("not possible while {}", self.bridge.state()));
        }
        self.until(STEP_PATIENCE, |event| {
            (*event == BridgeEvent::Armed).then_some(())
        })?;
        Ok(String::from("acknowledged"))
    }

    fn frames(&mut self) -> Result<String, String> {
        while self.bridge.counters().frames_sent < N_FRAMES {
            self.until(STEP_PATIENCE, |event| match event {
                BridgeEvent::Tick { .. } => Some(()),
                _ => None,
            })?;
        }
        let counters = self.bridge.counters();
        let device = counters.device;
        let line = format!(
            "{} sent; underrun {}, late {}, repeated {}, bad {}, clipped {}, refused {}; \
             due to written {} median, {} p99",
            counters.frames_sent,
            device.underrun,
            device.late,
            device.dup,
            device.bad,
            device.clipped,
            counters.frames_rejected,
            milliseconds(self.bridge.timings().due_to_write.median),
            milliseconds(self.bridge.timings().due_to_write.p99)
        );
        let amp_sum = self.bridge.status().map_or(0, |status| status.amp_sum);
        let broken = counters.frames_rejected > 0 || device.dup > 0 || device.bad > 0;
        if broken || amp_sum == 0 {
            Err(line)
        } else {
            Ok(line)
        }
    }

    fn stop(&mut self) -> Result<String, String> {
        self.bridge.stop(StopHow::Ramp);
        self.until(STEP_PATIENCE, |event| match event {
            BridgeEvent::Disarmed {
                by: DisarmedBy::Host,
                ..
            } => Some(()),
            _ => None,
        })?;
        let deadline = Instant::now() + STEP_PATIENCE;
        while self.bridge.state().is_live() && Instant::now() < deadline {
            if self.bridge.poll().is_none() {
                std::thread::sleep(NAP);
            }
        }
        if self.bridge.state().is_live() {
            return Err(String::from(
                "acknowledged, but the device did not come to rest",
            ));
        }
        Ok(String::from("acknowledged, device at rest"))
    }
}

fn milliseconds(duration: Duration) -> String {
    format!("{:.2} ms", duration.as_secs_f64() * 1000.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_emulator_passes() {
        // A machine that starves the test for 100 ms disarms the device, as it should: try again.
        let mut tries = (0..5).map(|_| self_test(Target::Emulator, ArrayProfile::default(), None));
        let report = tries.find(SelfTestReport::passed).unwrap();
        let names: Vec<&str> = report.steps.iter().map(|step| step.name).collect();
        assert_eq!(names, ["handshake", "ping", "arm", "frames", "stop"]);
        let pings = report.steps[1].outcome.as_ref().unwrap();
        assert!(pings.starts_with("50 round trips"), "{pings}");
        assert_eq!(report.caps.unwrap().n_ch, 24);
        assert!(report.to_string().ends_with("emulator: self-test passed"));
    }

    #[test]
    fn a_missing_port_fails_at_the_handshake() {
        let target = Target::Port(std::env::temp_dir().join("no-such-port"));
        let report = self_test(target, ArrayProfile::default(), None);
        assert!(!report.passed());
        assert_eq!(report.steps.len(), 1);
        assert!(
            report.to_string().contains("failed  handshake  "),
            "{report}"
        );
    }
}
