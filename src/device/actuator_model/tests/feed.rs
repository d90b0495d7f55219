//! A device in told time whose actuators are looked at.

use super::*;
use crate::device::tests::opening;
use crate::message::{DeviceState, NEXT_TICK, frame};
use crate::{DeviceCore, DeviceModel, DeviceSink};

/// Feeds actuators and drops the packets.
struct Fed(ActuatorFeed);

impl DeviceSink for Fed {
    fn packet(&mut self, _bytes: &[u8]) {}

    fn stepped(&mut self, device: &DeviceCore) {
        self.0.stepped(device);
    }
}

/// A device that is armed at 10 ms and given full frames until 500 ms.
fn play(until_ms: u64, is_looking: bool) -> (ActuatorWatch, DeviceCore) {
    let (feed, watch) = actuator_watch(ContactorModel::default(), 24);
    watch.look(is_looking);
    let (mut device, mut fed) = (DeviceCore::new(DeviceModel::default()), Fed(feed));
    for packet in opening() {
        device.receive(10_000, packet.as_bytes(), &mut fed);
    }
    let mut seq = 3;
    for ms in 11..=until_ms {
        if ms < 500 && ms % 25 == 5 {
            seq += 1;
            let packet = frame::packet(seq, NEXT_TICK, &[[0, 30_000]; 24]).unwrap();
            device.receive(1000 * ms, packet.as_bytes(), &mut fed);
        }
        device.advance(1000 * ms, &mut fed);
    }
    (watch, device)
}

#[test]
fn what_a_device_puts_out_moves_the_contactors_that_are_looked_at() {
    let (mut watch, device) = play(450, true);
    assert_eq!(device.state(), DeviceState::Run);
    let reading = watch.reading();
    assert_eq!(reading.codes, [[0, 30_000]; 24]);
    assert_eq!(reading.state, DeviceState::Run);
    assert_eq!(reading.n_ticks, 18, "450 ms are 18 ticks");
    let wanted_um = volts(30_000)
        * ContactorModel::default().response_um_per_v(320.0).norm()
        * ContactorModel::hold_droop(320.0);
    for one in &reading.contactors {
        assert!(
            (one.amplitude_um[1] / wanted_um - 1.0).abs() < 1e-3,
            "{one:?}"
        );
    }
    assert!(reading.current_ma() > 1.0);
}

#[test]
fn a_host_that_falls_silent_leaves_contactors_at_rest() {
    let (mut watch, device) = play(750, true);
    assert_eq!(device.state(), DeviceState::Ready);
    assert!(
        watch
            .reading()
            .contactors
            .iter()
            .all(|one| one.peak_um < 0.01)
    );
}

#[test]
fn nothing_is_computed_while_nobody_looks() {
    let (mut watch, _) = play(450, false);
    assert_eq!(watch.reading().n_ticks, 0);
}
