"""Frames as the machine's database lays them out, written to a gzipped candump log."""

import gzip
import io
import re
from pathlib import Path

import cantools

# Logged less often than the machine sends them, ms.
SLOW_MS = {
    "CylLoadMidRear": 50,
    "CylLoadFront": 50,
    "WheelForceMidRear": 50,
    "WheelForceFront": 50,
    "PumpPressure": 50,
    "DriveCurrent": 20,
    "EEC1": 50,
}
FRAME_S = 140e-6


def crc8(data_id: int, payload: bytes) -> int:
    """SAE J1850 over the data ID, low byte first, and the payload."""
    crc = 0xFF
    for byte in data_id.to_bytes(2, "little") + payload:
        crc ^= byte
        for _ in range(8):
            crc = ((crc << 1) ^ 0x1D) & 0xFF if crc & 0x80 else crc << 1
    return crc ^ 0xFF


class Wire:
    """Encodes by signal name; keeps the log of one run."""

    def __init__(self, dbc: Path):
        self._layout = {}
        for message in cantools.database.load_file(dbc).messages:
            signals = [
                (s.name, s.start, s.length, float(s.scale), float(s.offset), s.is_signed)
                for s in message.signals
            ]
            self._layout[message.name] = (message.frame_id, message.length, signals)
        self._rows: list[tuple[float, str]] = []
        self._counts: dict[str, int] = {}

    def encode(self, name: str, values: dict[str, float], data_id: int | None = None) -> str:
        """A candump frame; what is not named is zero, what is out of range its nearest."""
        frame_id, length, signals = self._layout[name]
        word = 0
        for signal, start, bits, scale, offset, signed in signals:
            if signal == "Counter":
                raw = self._counts.get(name, 0)
                self._counts[name] = (raw + 1) % 16
            else:
                raw = round((values.get(signal, 0.0) - offset) / scale)
            low, high = (
                (-(1 << (bits - 1)), (1 << (bits - 1)) - 1) if signed else (0, (1 << bits) - 1)
            )
            word |= (min(max(raw, low), high) & ((1 << bits) - 1)) << start
        payload = word.to_bytes(length, "little")
        if data_id is not None:
            payload = payload[:7] + bytes([crc8(data_id, payload[:7])])
        return f"{frame_id:08X}#{payload.hex().upper()}"

    def send(self, at_s: float, *frames: str) -> None:
        """Puts frames on the bus one after the other."""
        self._rows += [(at_s + k * FRAME_S, frame) for k, frame in enumerate(frames)]

    def log(self, begin_s: float) -> bytes:
        """The log so far, gzipped, with its clock beginning at `begin_s`."""
        text = io.StringIO()
        for at_s, frame in sorted(self._rows):
            text.write(f"({begin_s + at_s:.6f}) can0 {frame}\n")
        return gzip.compress(text.getvalue().encode(), compresslevel=6, mtime=0)


def logged_database(dbc: Path) -> str:
    """The database's text with the periods at which frames are logged."""
    text = dbc.read_text(encoding="utf-8")
    for message in cantools.database.load_file(dbc).messages:
        if message.name in SLOW_MS:
            number = message.frame_id | 0x80000000
            text = re.sub(
                rf'(BA_ "GenMsgCycleTime" BO_ {number}) \d+;', rf"\1 {SLOW_MS[message.name]};", text
            )
    return text
