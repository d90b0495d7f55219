//! Linux' input devices: listing them, and a thread that reads one.
//!
//! The thread sleeps until there is something to read. When the kernel had to drop events because
//! nobody read them, the device is asked for its state and the finger begins anew.

use std::fs::{self, File};
use std::io::{self, Read as _};
use std::os::fd::AsFd as _;
use std::path::{Path, PathBuf};
use std::thread;
use std::time::{Duration, Instant};

use input_linux::{AbsoluteAxis, EvdevHandle, InputProperty, Key};
use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::time::{ClockId, clock_gettime};

use super::super::InputError;
use super::super::feed::{FeedSender, feed};
use super::super::pointer::{PointerInput, SourceKind};
use super::decode::{Contact, Decoder, EVENT_BYTES, Event, MAX_SLOTS, Report, Slot, State, code};
use super::{Area, AxisRange, InputDevice};
use crate::{MAX_FINGERS, PointerSample};

const FOLDER: &str = "/dev/input";
/// `CLOCK_MONOTONIC`, which the engine's clock is.
const MONOTONIC: i32 = 1;
/// Events that are read at once.
const MAX_EVENTS: usize = 64;
/// How long the thread sleeps before it looks whether anybody still listens.
const NAP: Timespec = Timespec {
    tv_sec: 0,
    tv_nsec: 100_000_000,
};

type Handle = EvdevHandle<File>;

impl InputDevice {
    /// The devices that tell places, in the order of their numbers; in place of one that may not
    /// be read stands why.
    ///
    /// # Errors
    /// There are no devices to be seen at all.
    pub fn list() -> Result<Vec<Result<Self, InputError>>, InputError> {
        let entries = fs::read_dir(FOLDER).map_err(|error| InputError::List(error.to_string()))?;
        let number = |path: &Path| -> Option<u32> {
            let name = path.file_name()?.to_str()?;
            name.strip_prefix("event")?.parse().ok()
        };
        let paths = entries.flatten().map(|entry| entry.path());
        let mut numbered: Vec<(u32, PathBuf)> = paths
            .filter_map(|path| Some((number(&path)?, path)))
            .collect();
        numbered.sort();
        let look = |(_, path): (u32, PathBuf)| match look_at(&path) {
            Ok(found) => found.map(|(_, device, _)| Ok(device)),
            Err(error) => Some(Err(error)),
        };
        Ok(numbered.into_iter().filter_map(look).collect())
    }

    /// Opens a device whose surface lies at `area` of the workspace, or where it usually does, and
    /// starts to read it.
    ///
    /// # Errors
    /// It may not be read, is not there or tells no places.
    pub fn open(
        path: &Path,
        area: Option<Area>,
        workspace_mm: [f64; 2],
    ) -> Result<Box<dyn PointerInput>, InputError> {
        let fault = |what: String| InputError::Device {
            path: path.to_owned(),
            what,
        };
        let Some((handle, device, contact)) = look_at(path)? else {
            return Err(fault("it tells no places".to_owned()));
        };
        let (sender, input) = feed(SourceKind::Device);
        let reader = Reader {
            has_clock: handle.set_clock_id(MONOTONIC).is_ok(),
            decoder: Decoder::new(contact, state_of(&handle, contact)),
            handle,
            contact,
            axes: device.axes,
            area: area.unwrap_or_else(|| Area::usual(device.axes, workspace_mm)),
            sender,
        };
        thread::Builder::new()
            .name("selvedge-tablet".to_owned())
            .spawn(move || reader.run())
            .map_err(|error| fault(error.to_string()))?;
        Ok(Box::new(input))
    }
}

/// Opens a device and asks what it is; `None` if it tells no places.
fn look_at(path: &Path) -> Result<Option<(Handle, InputDevice, Contact)>, InputError> {
    let fault = |error: io::Error| match error.kind() {
        io::ErrorKind::PermissionDenied => InputError::Forbidden(path.to_owned()),
        _ => InputError::Device {
            path: path.to_owned(),
            what: error.to_string(),
        },
    };
    let handle = EvdevHandle::new(File::open(path).map_err(fault)?);
    let what = |error: io::Error| fault(io::Error::other(format!("no input device ({error})")));
    let axes = handle.absolute_bits().map_err(what)?;
    let keys = handle.key_bits().map_err(what)?;
    let is_sensor = handle
        .device_properties()
        .is_ok_and(|properties| properties.get(InputProperty::Accelerometer));
    let is_stick = keys.get(Key::ButtonTrigger) || keys.get(Key::ButtonNorth);
    let has = |axis| axes.get(axis);
    let has_slots = has(AbsoluteAxis::MultitouchPositionX) && has(AbsoluteAxis::MultitouchSlot);
    let has_place = has(AbsoluteAxis::X) && has(AbsoluteAxis::Y);
    if is_sensor || is_stick || !(has_slots || has_place) {
        return Ok(None);
    }
    let (contact, words) = if has_slots {
        (Contact::Slots, "fingers")
    } else if keys.get(Key::ButtonTouch) {
        (Contact::Button, "touch")
    } else if has(AbsoluteAxis::Pressure) {
        (Contact::Pressure, "pressure")
    } else {
        (Contact::Always, "always")
    };
    let device = InputDevice {
        path: path.to_owned(),
        name: name_of(&handle),
        axes: places(has_slots).map(|axis| range_of(&handle, axis)),
        contact: words,
    };
    Ok(Some((handle, device, contact)))
}

fn places(has_slots: bool) -> [AbsoluteAxis; 2] {
    if has_slots {
        [
            AbsoluteAxis::MultitouchPositionX,
            AbsoluteAxis::MultitouchPositionY,
        ]
    } else {
        [AbsoluteAxis::X, AbsoluteAxis::Y]
    }
}

fn name_of(handle: &Handle) -> String {
    let bytes = handle.device_name().unwrap_or_default();
    let text = String::from_utf8_lossy(&bytes);
    text.trim_end_matches('\0').trim().to_owned()
}

fn range_of(handle: &Handle, axis: AbsoluteAxis) -> AxisRange {
    let info = handle.absolute_info(axis);
    info.map_or_else(
        |_| AxisRange::default(),
        |info| AxisRange {
            min: info.minimum,
            max: info.maximum,
            per_mm: info.resolution,
        },
    )
}

/// What the device says of itself now. What it does not say is as if nothing touched it.
fn state_of(handle: &Handle, contact: Contact) -> State {
    let value = |axis| handle.absolute_info(axis).map_or(0, |info| info.value);
    let mut state = State::NOTHING;
    let mut keys = [0; 96];
    let is_down = |keys: &[u8], key: u16| {
        let byte = keys.get(usize::from(key / 8)).copied().unwrap_or_default();
        byte >> (key % 8) & 1 == 1
    };
    if contact == Contact::Slots {
        state.slot = usize::try_from(value(AbsoluteAxis::MultitouchSlot)).unwrap_or(0);
        state.slots = slots_of(handle);
        return state;
    }
    state.at = places(false).map(value);
    state.pressure = value(AbsoluteAxis::Pressure);
    if handle.key_state(&mut keys).is_ok() {
        state.is_touching = is_down(&keys, code::TOUCH);
    }
    let bits = handle.key_bits().unwrap_or_default();
    if bits.get(Key::ButtonToolPen) {
        let near = |(bit, tool): (usize, u16)| u8::from(is_down(&keys, tool)) << bit;
        state.tools = Some(code::TOOLS.enumerate().map(near).sum());
    }
    state
}

fn slots_of(handle: &Handle) -> [Slot; MAX_SLOTS] {
    let mut slots = [Slot::EMPTY; MAX_SLOTS];
    let Ok(info) = handle.absolute_info(AbsoluteAxis::MultitouchSlot) else {
        return slots;
    };
    let n_slots = usize::try_from(info.maximum).map_or(1, |last| last + 1);
    let n_slots = n_slots.min(MAX_SLOTS);
    let ask = |axis| {
        let mut values = vec![-1; n_slots];
        let asked = handle.multi_touch_slots(axis, &mut values);
        asked.is_ok().then_some(values)
    };
    let ids = ask(AbsoluteAxis::MultitouchTrackingId);
    let [xs, ys] = places(true).map(ask);
    if let (Some(ids), Some(xs), Some(ys)) = (ids, xs, ys) {
        for (slot, ((id, x), y)) in slots.iter_mut().zip(ids.into_iter().zip(xs).zip(ys)) {
            *slot = Slot { id, at: [x, y] };
        }
    }
    slots
}

/// Reads one device.
struct Reader {
    handle: Handle,
    contact: Contact,
    decoder: Decoder,
    axes: [AxisRange; 2],
    area: Area,
    sender: FeedSender,
    /// Whether events carry times of our clock.
    has_clock: bool,
}

impl Reader {
    /// Reads until nobody listens or the device is gone.
    fn run(mut self) {
        let mut bytes = [0; MAX_EVENTS * EVENT_BYTES];
        while !self.sender.is_abandoned() {
            match self.wait() {
                Ok(false) => continue,
                Ok(true) => {}
                Err(_) => break,
            }
            match self.handle.as_inner_mut().read(&mut bytes) {
                Ok(n_read) if n_read >= EVENT_BYTES => self.take(&bytes[..n_read]),
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                _ => break,
            }
        }
        (0..MAX_FINGERS).for_each(|finger| self.sender.push_of(finger, None));
        self.sender.end();
    }

    /// Whether there is something to read.
    fn wait(&self) -> io::Result<bool> {
        let file = self.handle.as_inner().as_fd();
        let mut polled = [PollFd::from_borrowed_fd(file, PollFlags::IN)];
        match poll(&mut polled, Some(&NAP)) {
            Ok(n_ready) => Ok(n_ready > 0),
            Err(rustix::io::Errno::INTR) => Ok(false),
            Err(error) => Err(error.into()),
        }
    }

    fn take(&mut self, bytes: &[u8]) {
        let (now, now_us) = (Instant::now(), monotonic_us());
        let mut is_lost = false;
        for event in Event::read(bytes) {
            let (area, axes, has_clock) = (&self.area, &self.axes, self.has_clock);
            let sender = &mut self.sender;
            self.decoder.take(event, &mut |report| match report {
                Report::Lifted(finger) => sender.push_of(finger, None),
                Report::Lost => is_lost = true,
                Report::At {
                    finger,
                    time_us,
                    at,
                } => {
                    let age_us = u64::try_from(now_us - time_us).unwrap_or(0);
                    let age = Duration::from_micros(if has_clock { age_us } else { 0 });
                    let stamp = now.checked_sub(age).unwrap_or(now);
                    let position = area.place(axes, at);
                    sender.push_of(finger, Some(PointerSample { stamp, position }));
                }
            });
            if std::mem::take(&mut is_lost) {
                self.sender.count_lost_in_system();
                (0..MAX_FINGERS).for_each(|finger| self.sender.push_of(finger, None));
                self.decoder.resume(state_of(&self.handle, self.contact));
            }
        }
    }
}

/// The time on the clock of the events, µs.
fn monotonic_us() -> i64 {
    let now = clock_gettime(ClockId::Monotonic);
    now.tv_sec * 1_000_000 + now.tv_nsec / 1000
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_device_is_refused_by_name() {
        for (path, what) in [
            ("/dev/null", "no input device"),
            ("/nowhere/event1", "No such"),
        ] {
            let error = InputDevice::open(Path::new(path), None, [260.0, 260.0]).unwrap_err();
            let text = error.to_string();
            assert!(text.starts_with(path) && text.contains(what), "{text}");
        }
    }

    #[test]
    fn a_device_that_may_not_be_read_names_the_group() {
        let text = InputError::Forbidden(PathBuf::from("/dev/input/event5")).to_string();
        assert!(text.contains("group \"input\""), "{text}");
    }

    #[test]
    fn the_devices_are_listed_or_their_lack_is_told() {
        match InputDevice::list() {
            Ok(devices) => println!("{devices:?}"),
            Err(error) => assert!(error.to_string().contains("/dev/input"), "{error}"),
        }
    }
}
