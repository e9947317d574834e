"""Everything that can be wrong with a machine of this make: `faults.toml`, drawn and put in."""

import tomllib
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from xt28_mujoco.machine import WHEELS

from .truth import Truth

SCOPES = {
    "all": WHEELS,
    "front": ("FR", "FL"),
    "middle": ("MR", "ML"),
    "rear": ("BR", "BL"),
    "left": ("FL", "ML", "BL"),
    "right": ("FR", "MR", "BR"),
} | {wheel: (wheel,) for wheel in WHEELS}

TABLE = tomllib.loads(Path(__file__).with_name("faults.toml").read_text(encoding="utf-8"))
NAMES = tuple(TABLE)
# When a fault that sets in underway does, s.
LATE_S = (8.0, 14.0)
# Runs in which a fault that sets in once does.
ONCE_IN = (2, 3, 4)


def is_known(name: str) -> bool:
    """Whether a catalogue of the bench has it."""
    return TABLE[name].get("known", True)


@dataclass(frozen=True)
class Fault:
    """One thing that is wrong: on which wheels, and by how much."""

    name: str
    scope: str
    sizes: dict[str, float]
    # When it sets in, in every run; before the log begins where it is zero.
    start_s: float = 0.0
    # The only run in which it does so, counted from one, and is there in all later ones; none where it is every run.
    start_run: int | None = None

    @property
    def known(self) -> bool:
        """Whether a catalogue of the bench has it."""
        return is_known(self.name)

    @property
    def group(self) -> str:
        """Block of the machine."""
        return TABLE[self.name]["group"]

    @property
    def signal(self) -> str:
        """The signal that it shows in first."""
        return TABLE[self.name]["signal"]

    def in_run(self, number: int) -> "Fault | None":
        """What it is in one run: not there before the one in which it sets in for good."""
        if self.start_run is None or number == self.start_run:
            return self
        return replace(self, start_s=0.0) if number > self.start_run else None

    def put_in(self, truth: Truth) -> None:
        """Makes it so."""
        wheels = [WHEELS.index(wheel) for wheel in SCOPES[self.scope]]
        for name, value in self.sizes.items():
            for place in TABLE[self.name]["size"][name]["at"]:
                part, field = place.lstrip("*").split(".")
                there = getattr(truth, part)
                number = getattr(there, field)
                whole = not isinstance(number, np.ndarray)
                new = value * (number if whole else number[wheels]) if place[0] == "*" else value
                if whole:
                    setattr(there, field, float(new))
                else:
                    number[wheels] = new


def draw(cause: str, random: np.random.Generator, late: bool) -> Fault:
    """A fault by its name, or NAME:SCOPE; scope and sizes drawn, and when it sets in if that is `late`."""
    name, _, scope = cause.partition(":")
    if name not in TABLE:
        raise ValueError(f"no fault is called {name!r}; there are {', '.join(NAMES)}")
    scope = scope or str(random.choice(TABLE[name].get("scopes", ["all"])))
    if scope not in SCOPES:
        raise ValueError(f"no wheels are called {scope!r}; there are {', '.join(SCOPES)}")
    sizes = {}
    for size, how in TABLE[name]["size"].items():
        sign = random.choice((-1.0, 1.0)) if how.get("either_sign") else 1.0
        sizes[size] = float(sign * random.uniform(*how["span"]))
    if not late or TABLE[name].get("built_in", False):
        return Fault(name, scope, sizes)
    return Fault(name, scope, sizes, round(float(random.uniform(*LATE_S)), 1))


def once(fault: Fault, random: np.random.Generator) -> Fault:
    """The same setting in once, before one run of the day or within it."""
    if TABLE[fault.name].get("built_in", False):
        return fault
    within_s = round(float(random.uniform(*LATE_S)), 1)
    start_s = float(random.choice((0.0, within_s)))
    return replace(fault, start_s=start_s, start_run=int(random.choice(ONCE_IN)))


def pairs(number: int, random: np.random.Generator) -> list[str]:
    """So many pairs of known faults in two groups each, as `draw` takes them, joined by +."""
    known = [name for name in NAMES if is_known(name)]
    chosen = []
    while len(chosen) < number:
        first, second = (str(name) for name in random.choice(known, 2, replace=False))
        if TABLE[first]["group"] != TABLE[second]["group"]:
            chosen.append(f"{first}+{second}")
    return chosen
