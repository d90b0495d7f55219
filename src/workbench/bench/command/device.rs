//! What can be done with the device.

use std::path::PathBuf;

use crate::bench::command::array::ArrayCommand;
use selvedge_device::FaultWords;

/// What can be done with the device.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum DeviceCommand {
    /// Arm it: high voltage on.
    Arm,
    /// End the silence of all off on the screen; a device stays disarmed.
    GoOn,
    /// Ramp it to silence.
    Disarm,
    /// Connect to the emulator in this process, of which nothing fails.
    ConnectEmulator,
    /// Connect to the emulator in this process anew, with these faults.
    StartFaults(FaultWords),
    /// Connect to the device at this path.
    ConnectPort(PathBuf),
    /// Let go of it.
    Disconnect,
    /// Connect the scene's second display to the device at this path, or to an emulator.
    ConnectSecond(Option<PathBuf>),
    /// Let go of that.
    DisconnectSecond,
    /// Clear its faults, whose cause is gone.
    ClearFaults,
    /// Put the path of the session log where it can be pasted.
    CopyLogPath,
    /// Show the folder of the session log in the desktop's file manager.
    OpenLogFolder,
    /// Whether an armed device stops when the window loses the keyboard.
    StopOnFocusLoss(bool),
    /// Do something with array profiles.
    Array(ArrayCommand),
}
