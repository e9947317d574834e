"""Checks cases read from standard input, a JSON object a line, against cantools.

{"dbc": path, "message": name, "values": {signal: number}, "data": hex}: cantools must encode the
values to the data and decode the data to the values. Prints what differs; exits 1 if anything does.
"""

import json
import sys

import cantools

databases, cases, bad = {}, 0, 0
for line in sys.stdin:
    case = json.loads(line)
    path = case["dbc"]
    if path not in databases:
        databases[path] = cantools.database.load_file(path)
    message = databases[path].get_message_by_name(case["message"])
    data, values = bytes.fromhex(case["data"]), case["values"]
    encoded = message.encode(values, strict=False)
    decoded = message.decode(data, decode_choices=False)
    near = decoded.keys() == values.keys() and all(
        abs(decoded[name] - value) <= 1e-9 * max(1.0, abs(value))
        for name, value in values.items()
    )
    if encoded != data or not near:
        bad += 1
        print(f"{case['message']} {values}: ours {data.hex()}, cantools {encoded.hex()} {decoded}")
    cases += 1
print(f"{cases} cases, {bad} differ")
sys.exit(bad != 0)
