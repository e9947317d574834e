"""A stock service tool against both ECUs: python's can-isotp and udsoncan, nothing of ours.

    service_tool.py --bus vcan0     on a CAN interface (python-can)
    service_tool.py --pipe          frames as lines `ID#DATA` on standard input and output

Through the pipe the ECUs' time comes as lines `@MILLISECONDS`, each answered by `@`: they wait for it, so
that neither side runs out of time while the other is held up. Waits are in their time.

The machine stands with its arms at 170 mm, and the wire of stroke sensor FR breaks at some time.
Prints what it checked on standard error; exits 1 at the first thing that is not as it must be.
"""

import argparse
import logging
import queue
import struct
import sys
import threading
import time

import isotp
import udsoncan
from udsoncan.client import Client
from udsoncan.connections import PythonIsoTpConnection
from udsoncan.exceptions import NegativeResponseException, TimeoutException

TESTER, ARM, DRIVE, FUNCTIONAL = 0xF1, 0x28, 0x29, 0x33
CHECKED = 0


def check(what, holds):
    global CHECKED
    if not holds:
        sys.exit(f"FAILED: {what}")
    CHECKED += 1


class Pipe:
    """Frames and time as lines of text."""

    def __init__(self):
        self.now_s, self.lock = 0.0, threading.Lock()

    def receive(self):
        while line := sys.stdin.readline().strip():
            if not line.startswith("@"):
                arbitration, data = line.split("#")
                return int(arbitration, 16), bytes.fromhex(data)
            self.now_s = int(line[1:]) / 1000
            self.say("@")
        return None

    def send(self, arbitration, data):
        self.say(f"{arbitration:08X}#{bytes(data).hex().upper()}")

    def say(self, line):
        with self.lock:
            sys.stdout.write(line + "\n")
            sys.stdout.flush()

    def now(self):
        return self.now_s


class Bus:
    """Frames on a CAN interface."""

    def __init__(self, channel):
        import can

        # Only what a service tool listens to: PDU formats D8 to DB, E8 to EF, and FECA, FECB.
        masks = [(0x00D80000, 0x00FC0000), (0x00E80000, 0x00F80000), (0x00FECA00, 0x00FFFE00)]
        filters = [{"can_id": i, "can_mask": m, "extended": True} for i, m in masks]
        self.bus = can.Bus(interface="socketcan", channel=channel, can_filters=filters)
        self.message = can.Message

    def receive(self):
        message = self.bus.recv()
        return message.arbitration_id, bytes(message.data)

    def send(self, arbitration, data):
        message = self.message(arbitration_id=arbitration, data=data, is_extended_id=True)
        self.bus.send(message)

    def now(self):
        return time.monotonic()


class Hub:
    """Gives every frame to all who listen."""

    def __init__(self, wire):
        self.wire, self.listeners, self.lock = wire, [], threading.Lock()
        threading.Thread(target=self.run, daemon=True).start()

    def run(self):
        while (frame := self.wire.receive()) is not None:
            for listener in list(self.listeners):
                listener.put(frame)

    def listen(self):
        self.listeners.append(queue.Queue())
        return self.listeners[-1]

    def send(self, arbitration, data):
        with self.lock:
            self.wire.send(arbitration, data)

    def now(self):
        return self.wire.now()

    def sleep(self, seconds):
        end = self.now() + seconds
        while self.now() < end:
            time.sleep(0.01)

    def ask(self, arbitration, data, wanted, count, timeout=2.0):
        """Sends a frame and gives the first frames that `wanted` holds of."""
        frames, listener, end = [], self.listen(), self.now() + timeout
        self.send(arbitration, data)
        while len(frames) < count and self.now() < end:
            try:
                frame = listener.get(timeout=0.01)
            except queue.Empty:
                continue
            if wanted(frame[0]):
                frames.append(frame)
        self.listeners.remove(listener)
        return frames


def connect(hub, target, **params):
    """An ISO-TP stack of can-isotp to one ECU."""
    frames = hub.listen()

    def receive(timeout):
        try:
            arbitration, data = frames.get(timeout=timeout)
        except queue.Empty:
            return None
        return isotp.CanMessage(arbitration_id=arbitration, data=data, extended_id=True)

    def send(message):
        hub.send(message.arbitration_id, message.data)

    address = isotp.Address(
        isotp.AddressingMode.NormalFixed_29bits, source_address=TESTER, target_address=target
    )
    params = {**PATIENCE, **params}
    layer = isotp.TransportLayer(rxfn=receive, txfn=send, address=address, params=params)
    return PythonIsoTpConnection(layer)


class Unsigned(udsoncan.DidCodec):
    def __init__(self, count, sign="H"):
        self.form = f">{count}{sign}"

    def decode(self, payload):
        return struct.unpack(self.form, payload)

    def encode(self, value):
        raise NotImplementedError

    def __len__(self):
        return struct.calcsize(self.form)


# What the clients wait for by the clock on the wall; through a pipe it says nothing of the ECUs.
PATIENCE = {}
LONG_S = 60

CONFIG = {
    "request_timeout": 3,
    "p2_timeout": 1,
    "p2_star_timeout": 5,
    "use_server_timing": False,
    "data_identifiers": {
        0x0100: Unsigned(1, "B"),
        0x0101: Unsigned(1),
        0x0110: Unsigned(6),
        0x0111: Unsigned(6),
        0x0113: Unsigned(6, "h"),
        0x0120: Unsigned(2, "h"),
        0x0123: Unsigned(1),
        0x0210: Unsigned(6),
        0x0220: Unsigned(2),
        0xABCD: Unsigned(1),
        0xF186: Unsigned(1, "B"),
        0xF190: udsoncan.AsciiCodec(17),
    },
}


def refused(call, code):
    """True if the ECU refuses the call with this code."""
    try:
        call()
    except NegativeResponseException as refusal:
        return refusal.response.code == code
    return False


def addresses(hub):
    """Both ECUs say who they are, under NAMEs of a forwarder."""
    claims = hub.ask(0x18EAFFFE, [0x00, 0xEE, 0x00], lambda i: i & 0xFFFF00 == 0xEEFF00, 2)
    names = {i & 0xFF: int.from_bytes(d, "little") for i, d in claims}
    check("two claims", sorted(names) == [ARM, DRIVE])
    for address, function in ((ARM, 18), (DRIVE, 3)):
        name = names[address]
        check("industry group forestry", name >> 60 & 7 == 2)
        check("vehicle system forwarder", name >> 49 & 0x7F == 20)
        check("function", name >> 40 & 0xFF == function)


def sessions(client, hub, raw):
    """Sessions, and what is to be had in them."""
    check("raw data need a session", refused(lambda: client.read_data_by_identifier(raw), 0x31))
    client.change_session(udsoncan.services.DiagnosticSessionControl.Session.extendedDiagnosticSession)
    check("session 3", client.read_data_by_identifier(0xF186).service_data.values[0xF186] == (3,))
    client.read_data_by_identifier(raw)
    client.tester_present()
    with client.suppress_positive_response:
        client.tester_present()
    hub.sleep(6.0)
    check("a session ends by itself", refused(lambda: client.read_data_by_identifier(raw), 0x31))
    programming = udsoncan.services.DiagnosticSessionControl.Session.programmingSession
    check("no programming", refused(lambda: client.change_session(programming), 0x12))
    check("no security", refused(lambda: client.request_seed(1), 0x11))
    check("no such data", refused(lambda: client.read_data_by_identifier(0xABCD), 0x31))


def data(arm, drive):
    """Values that the machine's state gives, several at once too."""
    values = arm.read_data_by_identifier([0x0110, 0x0101, 0xF190, 0x0113]).service_data.values
    check("strokes", all(abs(mm - 170) <= 4 for mm in values[0x0110][1:]))
    check("supply", values[0x0101] == (24000,))
    check("serial number", values[0xF190] == "XT28BENCH00000001")
    check("loads", 10000 < sum(values[0x0113]) < 60000)
    joints = drive.read_data_by_identifier(0x0120).service_data.values[0x0120]
    check("joints", all(abs(angle) < 100 for angle in joints))
    engine = drive.read_data_by_identifier(0x0123).service_data.values[0x0123][0] / 8
    check("engine speed", 700 < engine < 1900)


def trouble(client, hub):
    """A broken wire: counted, listed, in DM1 as well, and cleared but for what fails on."""
    spn, fmi = 520192, 5
    code = spn & 0xFFFF
    dtc_id = (code & 0xFF) << 16 | code >> 8 << 8 | spn >> 16 << 5 | fmi
    end = hub.now() + 15
    while hub.now() < end:
        active = client.get_dtc_by_status_mask(0x01).service_data.dtcs
        if any(dtc.id == dtc_id for dtc in active):
            break
        hub.sleep(0.2)
    found = [dtc for dtc in active if dtc.id == dtc_id]
    check("the broken wire", len(found) == 1 and found[0].status.confirmed)
    count = client.get_number_of_dtc_by_status_mask(0x01).service_data
    check("its format", count.dtc_format == 2)
    check("its count", count.dtc_count == len(active))
    supported = client.get_supported_dtc().service_data.dtcs
    check("all that there are", len(supported) > 60 and dtc_id in [dtc.id for dtc in supported])
    client.clear_dtc(0xFFFFFF)
    hub.sleep(0.2)
    again = [dtc.id for dtc in client.get_dtc_by_status_mask(0x01).service_data.dtcs]
    check("it fails on", dtc_id in again)
    check("no such code", refused(lambda: client.clear_dtc(0x010203), 0x31))

    wanted = bytes([code & 0xFF, code >> 8, spn >> 16 << 5 | fmi])
    groups = (0xFECA00 | ARM, 0xEBFF00 | ARM)
    frames = hub.ask(0x18EAFFF9, [0xCA, 0xFE, 0], lambda i: i & 0xFFFFFF in groups, 1)
    check("DM1 on request", len(frames) == 1 and wanted in frames[0][1])


def functional(hub):
    """A request to all is answered by both."""
    answers = hub.ask(
        0x18DB33F1, [2, 0x3E, 0], lambda i: i >> 8 == 0x18DAF1, 2
    )
    check("both answer", sorted(i & 0xFF for i, _ in answers) == [ARM, DRIVE])
    answers = hub.ask(0x18DB33F1, [2, 0x27, 1], lambda i: i >> 8 == 0x18DAF1, 1, timeout=0.5)
    check("none refuses", answers == [])


def pace(hub):
    """A tester that asks for pauses and small blocks gets its long answer all the same."""
    with Client(connect(hub, ARM, stmin=20, blocksize=2), config=CONFIG) as client:
        check("slowly", len(client.get_supported_dtc().service_data.dtcs) > 60)


def main():
    parser = argparse.ArgumentParser()
    wire = parser.add_mutually_exclusive_group(required=True)
    wire.add_argument("--bus")
    wire.add_argument("--pipe", action="store_true")
    arguments = parser.parse_args()
    if arguments.pipe:
        CONFIG.update(request_timeout=LONG_S, p2_timeout=LONG_S, p2_star_timeout=LONG_S)
        long_ms = 1000 * LONG_S
        PATIENCE.update(rx_flowcontrol_timeout=long_ms, rx_consecutive_frame_timeout=long_ms)
    hub = Hub(Pipe() if arguments.pipe else Bus(arguments.bus))
    hub.sleep(0.5)
    addresses(hub)
    with Client(connect(hub, ARM), config=CONFIG) as arm:
        with Client(connect(hub, DRIVE), config=CONFIG) as drive:
            data(arm, drive)
            sessions(arm, hub, 0x0210)
            drive.change_session(3)
            drive.read_data_by_identifier(0x0220)
        trouble(arm, hub)
    functional(hub)
    pace(hub)
    print(f"{CHECKED} checks, all as they must be", file=sys.stderr)


if __name__ == "__main__":
    # Refusals that are wanted are no news.
    logging.disable(logging.ERROR)
    try:
        main()
    except TimeoutException as late:
        sys.exit(f"FAILED: no answer: {late}")
