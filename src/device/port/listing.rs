//! The serial ports of this machine, for people to choose from. Pseudo-terminals cannot be listed.

use serialport::{SerialPortInfo, SerialPortType};

use crate::BridgeError;

/// A port that could be opened.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PortEntry {
    /// What to open.
    pub path: String,
    /// Maker, product and serial number of the adapter, as far as they are known.
    pub description: String,
    /// What its USB adapter says of itself; `None` for ports without USB.
    pub usb: Option<UsbIdentity>,
}

/// What a USB adapter says of itself, whatever its port is called.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UsbIdentity {
    /// Vendor number.
    pub(crate) vid: u16,
    /// Product number.
    pub pid: u16,
    /// Serial number, if it has one.
    pub serial: Option<String>,
}

impl PortEntry {
    /// All serial ports, sorted by path.
    pub fn list() -> Result<Vec<Self>, BridgeError> {
        let found =
            serialport::available_ports().map_err(|error| BridgeError::List(error.to_string()))?;
        let mut entries: Vec<Self> = found.into_iter().filter(is_shown).map(entry).collect();
        entries.sort_by(|a, b| a.path.cmp(&b.path));
        Ok(entries)
    }
}

/// macOS lists every port twice; the callout name is the one that opens without a carrier.
fn is_shown(port: &SerialPortInfo) -> bool {
    !(cfg!(target_os = "macos") && port.port_name.starts_with("/dev/tty."))
}

fn entry(port: SerialPortInfo) -> PortEntry {
    let usb = match &port.port_type {
        SerialPortType::UsbPort(usb) => Some(UsbIdentity {
            vid: usb.vid,
            pid: usb.pid,
            serial: usb.serial_number.clone(),
        }),
        _ => None,
    };
    let description = match port.port_type {
        SerialPortType::UsbPort(usb) => {
            let named = [usb.manufacturer, usb.product, usb.serial_number];
            let words: Vec<String> = named.into_iter().flatten().collect();
            let id = format!("USB {:04x}:{:04x}", usb.vid, usb.pid);
            if words.is_empty() {
                id
            } else {
                format!("{} ({id})", words.join(" "))
            }
        }
        SerialPortType::BluetoothPort => String::from("Bluetooth"),
        SerialPortType::PciPort => String::from("built in"),
        SerialPortType::Unknown => String::from("serial port"),
    };
    PortEntry {
        path: port.port_name,
        description,
        usb,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_usb_adapter_is_described_by_what_it_says_of_itself() {
        let usb = serialport::UsbPortInfo {
            vid: 0x0403,
            pid: 0x6001,
            serial_number: Some(String::from("A1")),
            manufacturer: None,
            product: Some(String::from("Array bridge")),
        };
        let port = |port_type| SerialPortInfo {
            port_name: String::from("/dev/ttyUSB0"),
            port_type,
        };
        let described = entry(port(SerialPortType::UsbPort(usb))).description;
        assert_eq!(described, "Array bridge A1 (USB 0403:6001)");
        assert_eq!(
            entry(port(SerialPortType::Unknown)).description,
            "serial port"
        );
    }

    #[test]
    fn listing_is_sorted() {
        let ports = PortEntry::list().unwrap();
        assert!(ports.is_sorted_by(|a, b| a.path <= b.path));
    }
}
