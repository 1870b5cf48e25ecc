//! Asks an X server which axis of the pointer's device is pressure (XInput2). winit reports the axes of each movement,
//! but neither their names nor their ranges. So this module asks for them, on its own connection, which selects no
//! events.

use x11rb::connection::RequestConnection as _;
use x11rb::protocol::xinput::{self, ConnectionExt as _, Device, DeviceClassData, DeviceType, Fp3232};
use x11rb::protocol::xproto::{Atom, ConnectionExt as _};
use x11rb::rust_connection::RustConnection;

use super::PressureAxis;

/// The name that drivers of tablets give the axis (Wacom's, libinput and evdev).
const PRESSURE: &[u8] = b"Abs Pressure";

/// A connection to the X server.
pub(super) struct Server {
    connection: RustConnection,
    pressure: Atom,
}

impl Server {
    /// Connects; `None` if the server cannot be reached or has no XInput2.
    pub(super) fn open() -> Option<Self> {
        let (connection, _) = RustConnection::connect(None).ok()?;
        connection.extension_information(xinput::X11_EXTENSION_NAME).ok()??;
        connection.xinput_xi_query_version(2, 2).ok()?.reply().ok()?;
        let pressure = connection.intern_atom(false, PRESSURE).ok()?.reply().ok()?.atom;
        Some(Self { connection, pressure })
    }

    /// The pressure axis of the device that moves the pointer now. While a device moves the pointer, the X server gives
    /// the pointer the axes of that device.
    pub(super) fn pressure_axis(&self) -> Option<PressureAxis> {
        let asked = self.connection.xinput_xi_query_device(u16::from(bool::from(Device::ALL_MASTER)));
        let pointers = asked.ok()?.reply().ok()?.infos.into_iter();
        let mut classes =
            pointers.filter(|info| info.type_ == DeviceType::MASTER_POINTER).flat_map(|info| info.classes);
        classes.find_map(|class| match class.data {
            DeviceClassData::Valuator(axis) if axis.label == self.pressure => Some(PressureAxis {
                number: axis.number.into(),
                range: [number(axis.min), number(axis.max)],
                value: number(axis.value),
            }),
            _ => None,
        })
    }
}

fn number(fixed: Fp3232) -> f64 {
    f64::from(fixed.integral) + f64::from(fixed.frac) / 4_294_967_296.0
}
