"""`python3 -m third_make OUT CAUSE...`: cases for `xt28 gap check --set OUT`, with answers."""

import argparse
from copy import deepcopy
from pathlib import Path

import numpy as np

from xt28_mujoco.machine import Machine

from .faults import NAMES, draw, once, pairs
from .policy import drives as policy_drives
from .run import Run
from .scripts import RAMP, drives
from .truth import Truth, tolerances
from .wire import logged_database

BEGIN_S = 1.76e9
BETWEEN_S = 900.0
# Beside the runs' numbers, which draw their noise.
ONCE_STREAM = 1000
PAIRS_STREAM = 1001


def about(name: str, scripts) -> str:
    """What one may know of a case."""
    lines = [f'case = "{name}"', 'machine = "Xt28, bunk declared empty"', 'dbc = "xt28-field.dbc"']
    for number, script in enumerate(scripts, 1):
        lines += [
            "\n[[run]]",
            f'file = "{file_of(number, script)}"',
            f'scenario = "{script.name}"',
            f"seconds = {script.seconds}",
            f'terrain = "{"ramp" if script.ramp else "flat"}"',
            f"fit = {str(script.fit).lower()}",
        ]
        if script.ramp:
            profile = ", ".join(f"{key} = {value}" for key, value in RAMP.items())
            lines.append(f"ramp = {{ {profile} }}")
    return "\n".join(lines) + "\n"


def file_of(number: int, script) -> str:
    """The name of a run's log."""
    return f"run-{number}-{script.name}.log.gz"


def answer(name: str, seed: int, kind: str, faults, scripts) -> str:
    """What is wrong."""
    lines = [f'case = "{name}"', f"seed = {seed}", f'kind = "{kind}"']
    for fault in faults:
        numbers = ", ".join(f"{key} = {value!r}" for key, value in fault.sizes.items())
        lines += [
            "\n[[truth]]",
            f'effect = "{fault.name}"',
            f'group = "{fault.group}"',
            f'scope = "{fault.scope}"',
            f'target_signal = "{fault.signal}"',
            f"start_s = {fault.start_s}",
        ]
        if fault.start_run is not None:
            run = file_of(fault.start_run, scripts[fault.start_run - 1])
            lines.append(f'start_run = "{run}"')
        lines += [
            f"parameters = {{ {numbers} }}",
        ]
    return "\n".join(lines) + "\n"


def write(args, seed: int, causes: list[str]) -> str:
    """One case; its name."""
    random = np.random.default_rng(seed)
    truth, machine = Truth(), Machine(args.machine)
    truth.drive.in_bearings = args.bearings
    tolerances(truth, random)
    faults = [draw(cause, random, args.late) for cause in causes]
    if args.once:
        # Drawn apart, so that the machine and its drives are those of the same seed without.
        when = np.random.default_rng((seed, ONCE_STREAM))
        faults = [once(fault, when) for fault in faults]
    kind = ("null", "single", "pair")[len(faults)]
    if not all(fault.known for fault in faults):
        kind = "unknown"
    name = f"third-{seed}"
    folder = args.out / name
    folder.mkdir(parents=True, exist_ok=True)
    (args.out / "answers").mkdir(exist_ok=True)
    scripts = policy_drives(random) if args.policy else drives(random)
    for number, script in enumerate(scripts, 1):
        noise = np.random.default_rng((seed, number))
        there = [fault for fault in (fault.in_run(number) for fault in faults) if fault]
        log = Run(machine, args.dbc, deepcopy(truth), there, script, noise).log(
            BEGIN_S + BETWEEN_S * number
        )
        (folder / file_of(number, script)).write_bytes(log)
    (folder / "about.toml").write_text(about(name, scripts), encoding="utf-8")
    (folder / "xt28-field.dbc").write_text(logged_database(args.dbc), encoding="utf-8")
    (args.out / "answers" / f"{name}.toml").write_text(answer(name, seed, kind, faults, scripts))
    return name


def main() -> None:
    """Writes the cases that are asked for, or one of each fault."""
    parser = argparse.ArgumentParser(prog="python3 -m third_make", description=__doc__)
    parser.add_argument("out", type=Path, help="folder for cases and answers")
    parser.add_argument("--machine", type=Path, default=Path("machine/xt28.toml"))
    parser.add_argument("--dbc", type=Path, default=Path("dbc/xt28.dbc"))
    parser.add_argument(
        "--seed", type=int, default=1, help="of the first case; the next has one more"
    )
    parser.add_argument(
        "--bearings",
        action="store_true",
        help="what resists rolling acts between wheel and arm, not between wheel and ground",
    )
    parser.add_argument(
        "--late",
        action="store_true",
        help="faults set in 8 to 14 s into every run, where they are not built in",
    )
    parser.add_argument(
        "--once",
        action="store_true",
        help="faults set in once, with the second, third or fourth run or 8 to 14 s into it, and stay",
    )
    parser.add_argument(
        "--policy",
        action="store_true",
        help="the machine drives to goals as a learnt controller does, instead of test drives",
    )
    parser.add_argument(
        "--pairs", type=int, default=0, metavar="N", help="also N pairs of known faults, by lot"
    )
    parser.add_argument(
        "causes",
        nargs="*",
        help="a case each: NAME[:SCOPE], two joined by +, or `sound`; one of each fault "
        "if none and no pairs",
    )
    args = parser.parse_intermixed_args()
    causes = args.causes + pairs(args.pairs, np.random.default_rng((args.seed, PAIRS_STREAM)))
    causes = causes or ["sound"] + list(NAMES)
    for k, cause in enumerate(causes):
        parts = [] if cause == "sound" else cause.split("+")
        if len(parts) > 2:
            parser.error(f"{cause}: two faults at most")
        try:
            print(write(args, args.seed + k, parts), cause, flush=True)
        except ValueError as error:
            parser.error(str(error))


main()
