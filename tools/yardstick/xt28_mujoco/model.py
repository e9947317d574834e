"""The MuJoCo model of the machine: 3 frames, 6 arms, 6 wheels in 20 freedoms.

Signs of every hinge are the bench's: an arm extends, a joint bends left, a wheel rolls forward at
positive angles and rates. Frames touch nothing; a wheel is a sphere that meets the ground only.
"""

from dataclasses import dataclass

import mujoco
import numpy as np

from .machine import GRAVITY_M_S2, REFERENCE_STROKE_M, WHEELS, Machine
from .terrain import Block, Grid

FRAMES = ("front", "middle", "rear")


@dataclass(frozen=True)
class Settings:
    """How MuJoCo is to solve."""

    rate_hz: int
    integrator: str = "implicitfast"
    cone: str = "elliptic"
    solver: str = "Newton"
    # Friction regularised this much stiffer than the normal direction.
    impratio: float = 1.0
    # Share of a contact that is constraint; its inverse part is a mass that the tyre does not have.
    impedance: float = 0.3
    # Stiffness and damping of one contact as a share of the tyre's. On a grid MuJoCo gives a wheel
    # four to seven contacts, each as stiff as a tyre; a fifth makes the sum about right.
    tyre_share: float = 1.0


def build(machine: Machine, settings: Settings, ground: Grid | Block | None) -> mujoco.MjModel:
    """Compiles the model; its tyres have the machine file's stiffness and damping."""
    arms = {axle: _arms(machine, axle) for axle in range(3)}
    frames = _frame(machine, 0, arms[0] + _frame(machine, 1, arms[1] + _frame(machine, 2, arms[2])))
    asset, geom = _ground(ground)
    text = f"""
    <mujoco model="xt28">
      <compiler angle="radian" autolimits="false" boundmass="0" boundinertia="0"/>
      <option gravity="0 0 {-GRAVITY_M_S2}" timestep="{1.0 / settings.rate_hz!r}"
        integrator="{settings.integrator}" cone="{settings.cone}" solver="{settings.solver}"
        impratio="{settings.impratio}"/>
      <asset>{asset}</asset>
      <worldbody>{geom}{frames}</worldbody>
    </mujoco>"""
    model = mujoco.MjModel.from_xml_string(text)
    if isinstance(ground, Grid):
        _fill(model, ground)
    _tyres(model, machine, settings)
    return model


def _numbers(values) -> str:
    return " ".join(repr(float(value)) for value in values)


def _inertial(mass_kg: float, com_m, inertia_kg_m2) -> str:
    return (
        f'<inertial pos="{_numbers(com_m)}" mass="{mass_kg!r}"'
        f' diaginertia="{_numbers(inertia_kg_m2)}"/>'
    )


def _frame(machine: Machine, index: int, inside: str) -> str:
    """One frame around its arms and the frame behind it."""
    name = FRAMES[index]
    mass_kg = getattr(machine.masses, f"{name}_frame_kg")
    com_m = getattr(machine.frames, f"{name}_com_m")
    x, y, z = getattr(machine.frames, f"{name}_box_m")
    inertia = [mass_kg / 12.0 * side for side in (y * y + z * z, x * x + z * z, x * x + y * y)]
    if index == 0:
        joint = '<freejoint name="front"/>'
    else:
        a = machine.articulation
        x_m = (a.front_joint_x_m, a.rear_joint_x_m)[index - 1]
        at = _numbers((x_m, 0.0, machine.wheels.radius_m))
        # The frame behind goes right when the machine bends left. The spring is set at each step.
        joint = f'<joint name="joint_{index}" axis="0 0 -1" pos="{at}" stiffness="1" damping="1"/>'
    return f'<body name="{name}">{joint}{_inertial(mass_kg, com_m, inertia)}{inside}</body>'


def _arms(machine: Machine, axle: int) -> str:
    return "".join(_arm(machine, axle, wheel) for wheel in WHEELS[2 * axle : 2 * axle + 2])


def _arm(machine: Machine, axle: int, wheel: str) -> str:
    v, w, m = machine.vehicle, machine.wheels, machine.masses
    angle = machine.linkage.angle_rad(REFERENCE_STROKE_M)
    forward = 1.0 if machine.arm_points_forward(wheel) else -1.0
    side = 1.0 if wheel[1] == "L" else -1.0
    drop_m = machine.linkage.drop_m(angle)
    to_wheel = np.array(
        (
            forward * machine.linkage.reach_m(angle),
            side * (w.track_m / 2.0 - v.arm_pivot_y_m),
            -drop_m,
        )
    )
    pivot = (w.axle_x_m[axle] - to_wheel[0], side * v.arm_pivot_y_m, w.radius_m + drop_m)
    slender = m.arm_kg * machine.arms.pivot_to_wheel_m**2 / 12.0
    about_axle = m.wheel_kg * v.wheel_gyration_m**2
    across = 0.6 * about_axle
    return f"""
    <body name="arm_{wheel}" pos="{_numbers(pivot)}">
      <joint name="arm_{wheel}" axis="0 {forward} 0" stiffness="1" damping="1"/>
      {_inertial(m.arm_kg, to_wheel * v.arm_com_share, [slender] * 3)}
      <body name="wheel_{wheel}" pos="{_numbers(to_wheel)}">
        <joint name="wheel_{wheel}" axis="0 1 0"/>
        {_inertial(m.wheel_kg, (0.0, 0.0, 0.0), (across, about_axle, across))}
        <geom name="wheel_{wheel}" type="sphere" size="{w.radius_m}" mass="0" condim="3"
          contype="2" conaffinity="1" priority="1" friction="{w.friction} 0 0"/>
      </body>
    </body>"""


def _ground(ground: Grid | Block | None) -> tuple[str, str]:
    touches = 'contype="1" conaffinity="2" condim="3"'
    plane = f'<geom {touches} type="plane" size="0 0 1"/>'
    if ground is None:
        return "", plane
    if isinstance(ground, Block):
        corners = _numbers(number for corner in ground.corners_m for number in corner)
        return (
            f'<mesh name="block" vertex="{corners}"/>',
            f'{plane}<geom {touches} type="mesh" mesh="block"/>',
        )
    rows, columns = ground.height_m.shape
    low, high = float(ground.height_m.min()), float(ground.height_m.max())
    # A base under the lowest point, so that a wheel pressed in is still above something.
    size = _numbers((*ground.half_extent_m(), max(high - low, 1e-3), 1.0))
    at = _numbers((*ground.centre_m(), low))
    return (
        f'<hfield name="ground" nrow="{rows}" ncol="{columns}" size="{size}"/>',
        f'<geom {touches} type="hfield" hfield="ground" pos="{at}"/>',
    )


def _fill(model: mujoco.MjModel, ground: Grid) -> None:
    """Heights as shares of the field's range, which is how MuJoCo keeps them."""
    low = ground.height_m.min()
    share = (ground.height_m.astype(np.float64) - low) / model.hfield_size[0, 2]
    model.hfield_data[:] = share.astype(np.float32).ravel()


def _tyres(model: mujoco.MjModel, machine: Machine, settings: Settings) -> None:
    """Contact parameters whose force is -K r - B v.

    MuJoCo gives a contact of impedance d the force (aref - a) / R with R = (1 - d) / d * A and
    aref = -(b v + k r) / d, where A is the body's inverse mass at rest and k, b are the negative
    solref. So K = k / ((1 - d) A), B likewise, and the term in a acts as a mass of 1 / R.
    """
    v, d = machine.vehicle, settings.impedance
    for wheel in WHEELS:
        geom = model.geom(f"wheel_{wheel}").id
        inverse_kg = model.body_invweight0[model.geom_bodyid[geom], 0]
        scale = settings.tyre_share * (1.0 - d) * inverse_kg
        model.geom_solref[geom] = (-v.tyre_stiffness_n_m * scale, -v.tyre_damping_n_s_m * scale)
        model.geom_solimp[geom] = (d, d, 1e-3, 0.5, 2.0)
