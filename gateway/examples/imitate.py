#!/usr/bin/env python3
"""A learnt policy in a page: a network is taught what controller.py does, and written as a policy file.

    python3 imitate.py
    xt28 run straight-25m --policy network:gateway/examples/imitated.toml@25,0,0

It needs NumPy alone (pip install numpy). Where machine and goal are is drawn at random; what the network sees of that is
what docs/policy-files.md says, so that a policy learnt by any other means is written in the same way.
"""

import json
import math
import pathlib
import struct

import numpy as np

from controller import act

LAYERS = [5, 32, 32, 8]
STEPS, BATCH, RATE = 20_000, 256, 3e-3

POLICY_FILE = """\
# Written by imitate.py: a network that does what controller.py does.
weights = "imitated.safetensors"
layers = ["0", "2", "4"]
activation = "tanh"
squash = "tanh"
rate = "fix"

[[input]]
terms = [
    { name = "goal_m", scale = [0.2, 0.5], clip = 2 },
    { name = "goal_heading_rad", scale = 2, clip = 2 },
    { name = "roll_rad", scale = 10, clip = 2 },
    { name = "pitch_rad", scale = 10, clip = 2 },
]
"""


def draw(rng, count):
    """What the network is fed with, and what the controller does then."""
    east_m, north_m = rng.uniform(-12, 2, count), rng.uniform(-3, 3, count)
    heading_rad = rng.uniform(-0.8, 0.8, count)
    roll_rad, pitch_rad = rng.normal(0, 0.05, (2, count))
    # The goal is the origin, and heads east.
    ahead_m = -np.cos(heading_rad) * east_m - np.sin(heading_rad) * north_m
    left_m = np.sin(heading_rad) * east_m - np.cos(heading_rad) * north_m
    fed = np.stack([0.2 * ahead_m, 0.5 * left_m, -2 * heading_rad, 10 * roll_rad, 10 * pitch_rad], axis=1)
    said = [
        act({"located": {"east_m": e, "north_m": n, "heading_rad": h}, "roll_rad": r, "pitch_rad": p}, 0.0)
        for e, n, h, r, p in zip(east_m, north_m, heading_rad, roll_rad, pitch_rad)
    ]
    return np.clip(fed, -2, 2), np.array(said)


def forward(weights, fed):
    """What every layer gives, the first being what it is fed with."""
    given = [fed]
    for weight, bias in weights:
        given.append(np.tanh(given[-1] @ weight.T + bias))
    return given


def teach(rng):
    """Weights and biases that do on average what the controller does: Adam on the mean square."""
    shapes = list(zip(LAYERS[1:], LAYERS[:-1]))
    weights = [(rng.normal(0, 1 / math.sqrt(i), (o, i)), np.zeros(o)) for o, i in shapes]
    mean, square = ([[np.zeros_like(p) for p in pair] for pair in weights] for _ in range(2))
    for step in range(1, STEPS + 1):
        fed, wanted = draw(rng, BATCH)
        given = forward(weights, fed)
        rate = RATE * 0.5 * (1 + math.cos(math.pi * step / STEPS))
        by = 2 * (given[-1] - wanted) / BATCH
        for k in reversed(range(len(weights))):
            by = by * (1 - given[k + 1] ** 2)
            slopes = by.T @ given[k], by.sum(axis=0)
            by = by @ weights[k][0]
            for one, (slope, parameter) in enumerate(zip(slopes, weights[k])):
                mean[k][one] += 0.1 * (slope - mean[k][one])
                square[k][one] += 0.001 * (slope**2 - square[k][one])
                m, s = mean[k][one] / (1 - 0.9**step), square[k][one] / (1 - 0.999**step)
                parameter -= rate * m / (np.sqrt(s) + 1e-8)
    return weights


def safetensors(tensors):
    """Eight bytes of length, a header in JSON, then the numbers."""
    header, numbers = {}, b""
    for name, tensor in tensors.items():
        data = tensor.astype("<f4").tobytes()
        offsets = [len(numbers), len(numbers) + len(data)]
        header[name] = {"dtype": "F32", "shape": list(tensor.shape), "data_offsets": offsets}
        numbers += data
    header = json.dumps(header).encode()
    header += b" " * (-len(header) % 8)
    return struct.pack("<Q", len(header)) + header + numbers


def main():
    rng = np.random.default_rng(28)
    weights = teach(rng)
    fed, wanted = draw(rng, 4096)
    off = forward(weights, fed)[-1] - wanted
    print(f"off by {np.sqrt((off**2).mean()):.4f} RMS, {np.abs(off).max():.3f} at most, of actions from -1 to 1")
    folder = pathlib.Path(__file__).parent
    tensors = {}
    for k, (weight, bias) in enumerate(weights):
        tensors[f"{2 * k}.weight"], tensors[f"{2 * k}.bias"] = weight, bias
    (folder / "imitated.safetensors").write_bytes(safetensors(tensors))
    (folder / "imitated.toml").write_text(POLICY_FILE)


if __name__ == "__main__":
    main()
