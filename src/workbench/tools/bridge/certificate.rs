//! Whether the device that is connected passed everything with the firmware that it has now.
//!
//! Certificates are what `selvedge bridge certify` leaves in the user's folder. The emulator in
//! this program needs none.

use std::path::PathBuf;

use eframe::egui::{self, Ui};

use crate::bench::background::Executor;
use crate::bench::latest::{Computed, Latest};
use crate::kit::theme::Palette;
use crate::kit::widgets::text::{paragraph, small};
use selvedge_device::{Caps, CertificateFolder, DeviceUid};
use selvedge_foundation::progress::{Cancelled, Progress};

/// A device, its firmware, and where certificates lie.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Tried {
    uid: DeviceUid,
    firmware: [u8; 3],
    folder: PathBuf,
}

/// Whether there is a certificate of everything passed.
#[derive(Debug)]
struct Covered(bool);

impl Computed<Tried> for Covered {
    const THREAD: &str = "certificate";

    fn compute(
        tried: &Tried,
        _prior: Option<(&Tried, &Self)>,
        _progress: &mut Progress<'_>,
    ) -> Result<Self, Cancelled> {
        let folder = CertificateFolder::new(&tried.folder);
        Ok(Self(folder.covers(tried.uid, tried.firmware)))
    }

    fn broken(_tried: &Tried, _why: &str) -> Self {
        Self(false)
    }

    fn serves(_under_way: &Tried, _now: &Tried) -> bool {
        false
    }
}

/// What is known of the certificate of the device that is connected.
#[derive(Debug, Default)]
pub(crate) struct CertificateMark {
    latest: Latest<Tried, Covered>,
}

impl CertificateMark {
    /// Looks for the certificate of a device once for each connection; `None` where none is
    /// needed.
    pub(crate) fn follow(
        &mut self,
        ctx: &egui::Context,
        executor: &Executor,
        device: Option<(&Caps, PathBuf)>,
    ) {
        let Some((caps, folder)) = device else {
            // The next connection looks anew: it may have been certified meanwhile.
            self.latest = Latest::default();
            return;
        };
        let tried = Tried {
            uid: DeviceUid(caps.uid),
            firmware: caps.firmware,
            folder,
        };
        self.latest.poll();
        self.latest.follow(ctx, executor, &tried);
    }

    /// The firmware and whether it is certified; `None` while that is not known.
    pub(crate) fn state(&self) -> Option<([u8; 3], bool)> {
        let (key, value) = self.latest.key().zip(self.latest.value())?;
        Some((key.firmware, value.0))
    }
}

/// Marks a device without a passing report for its firmware.
pub(crate) fn show(ui: &mut Ui, state: Option<([u8; 3], bool)>) {
    let Some(([major, minor, patch], is_certified)) = state else {
        return;
    };
    let palette = Palette::in_ui(ui);
    let firmware = format!("firmware {major}.{minor}.{patch}");
    let (words, ink) = if is_certified {
        (format!("Certified with {firmware}"), palette.dim)
    } else {
        let mend = "\"selvedge bridge certify\" tries it";
        (
            format!("Not certified with {firmware}: {mend}"),
            palette.danger,
        )
    };
    paragraph(ui, small(words, ink));
}

#[cfg(test)]
mod tests {
    use super::*;
    use selvedge_device::{
        Certificate, DeviceModel, Extent, Faults, Trial, VirtualLine, WiredDevice,
    };
    use selvedge_scratch::ScratchFolder;
    use std::sync::atomic::AtomicBool;

    fn passed() -> Certificate {
        let device = WiredDevice::new(DeviceModel::default(), &Faults::default());
        let mut line = VirtualLine::new(device, 0);
        let trial = Trial {
            extent: Extent::Full,
            nonce: 7,
        };
        Certificate::of(&mut line, trial, &AtomicBool::new(false), &mut |_| {})
    }

    #[test]
    fn a_device_is_certified_for_its_own_firmware_and_looked_up_at_each_connection() {
        let folder = ScratchFolder::new("certificates");
        let ctx = egui::Context::default();
        let mut mark = CertificateMark::default();
        let look = |mark: &mut CertificateMark, caps: Option<&Caps>| {
            let device = caps.map(|caps| (caps, folder.to_path_buf()));
            mark.follow(&ctx, &Executor::InLine, device.clone());
            mark.follow(&ctx, &Executor::InLine, device);
            mark.state()
        };
        let caps = DeviceModel::default().caps(1, 1);
        assert_eq!(look(&mut mark, Some(&caps)), Some((caps.firmware, false)));
        let certificates = CertificateFolder::new(&folder);
        let sha256 = || certificates.sha256(DeviceUid(caps.uid), caps.firmware);
        assert_eq!(sha256(), None);
        certificates.write(&passed()).unwrap();
        assert_eq!(sha256().unwrap().len(), 64);
        assert_eq!(look(&mut mark, Some(&caps)), Some((caps.firmware, false)));
        assert_eq!(look(&mut mark, None), None);
        assert_eq!(look(&mut mark, Some(&caps)), Some((caps.firmware, true)));
        let mut newer = caps;
        newer.firmware = [1, 0, 1];
        look(&mut mark, None);
        assert_eq!(look(&mut mark, Some(&newer)), Some(([1, 0, 1], false)));
    }
}
