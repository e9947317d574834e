//! The emulator: ECU pins wired to plant sensors.
