"""bend60 in MuJoCo, as a peer to measure beside: what it costs, not what it answers.

The chain's joints get an artificial inertia k tau^2 and a damper 2 k tau, because at the wire's real inertia the
bending waves would ask for steps of microseconds; the walls are boxes; friction 0.4 in elliptic cones; 2 ms steps,
implicit-fast, Newton.
"""

from __future__ import annotations

import math
import time
from typing import Any

import numpy as np

LENGTH, RADIUS, DENSITY, HALF_WIDTH, TAU, STEP, DURATION, SPEED = 0.150, 0.18e-3, 6450.0, 2e-3, 0.02, 2e-3, 10.0, 2e-3


def cost(segments: int) -> float:
    """Clock seconds per simulated second. Raises RuntimeError where the simulation diverges."""
    import mujoco

    model = mujoco.MjModel.from_xml_string(_xml(segments))
    data = mujoco.MjData(model)
    steps = round(DURATION / STEP)
    began = time.perf_counter()
    for _ in range(steps):
        data.ctrl[0] = SPEED * data.time
        mujoco.mj_step(model, data)
    spent = time.perf_counter() - began
    if not np.isfinite(data.qpos).all():
        raise RuntimeError(f"MuJoCo diverged with {segments} segments")
    return spent / DURATION


def _xml(segments: int) -> str:
    link = LENGTH / segments
    chain, close = "", "</body>" * segments
    for i in range(segments):
        arc_length = LENGTH - i * link
        stiffness = 1e-6 * 100 ** min(arc_length / 0.045, 1.0) / link
        joint = (
            '<joint name="push" type="slide" axis="1 0 0" armature="0.001"/>'
            if i == 0
            else f'<joint type="hinge" axis="0 0 1" stiffness="{stiffness:.9g}" damping="{2 * stiffness * TAU:.9g}" '
            f'armature="{stiffness * TAU**2:.9g}"/>'
        )
        place = -0.005 - LENGTH if i == 0 else link
        chain += f'<body pos="{place:.9g} 0 0">{joint}<geom class="wire" fromto="0 0 0 {link:.9g} 0 0"/>'
    contact = f'friction="0.4 0 0" condim="3" solref="{2 * STEP:g} 1"'
    return f"""<mujoco><compiler angle="radian" autolimits="true"/>
<option timestep="{STEP:g}" gravity="0 0 0" integrator="implicitfast" solver="Newton" cone="elliptic"/>
<size memory="1G"/>
<default>
  <default class="wall"><geom type="box" contype="0" conaffinity="1" {contact}/></default>
  <default class="wire"><geom type="capsule" size="{RADIUS:g}" density="{DENSITY:g}" contype="1" conaffinity="0"
  {contact}/></default>
</default>
<worldbody>{_walls()}{chain}{close}</worldbody>
<actuator><position joint="push" kp="2000" kv="25"/></actuator></mujoco>"""


def _walls() -> str:
    bend = math.radians(60)
    along, left = np.array([math.cos(bend), math.sin(bend)]), np.array([-math.sin(bend), math.cos(bend)])
    corner = HALF_WIDTH * math.tan(bend / 2)
    outer, inner = np.array([corner, -HALF_WIDTH]), np.array([-corner, HALF_WIDTH])
    thick = 4e-3
    return "".join(
        [
            _box(np.array([-0.2, -HALF_WIDTH]), outer + [thick, 0], np.array([0.0, -1.0])),
            _box(np.array([-0.2, HALF_WIDTH]), inner, np.array([0.0, 1.0])),
            _box(outer - thick * along, outer + 0.06 * along, -left),
            _box(inner, inner + 0.06 * along, left),
        ]
    )


def _box(a: np.ndarray[Any, Any], b: np.ndarray[Any, Any], outwards: np.ndarray[Any, Any]) -> str:
    half = 2e-3
    x, y = (a + b) / 2 + half * outwards
    length, heading = float(np.hypot(*(b - a))), math.atan2(*(b - a)[::-1])
    return (
        f'<geom class="wall" pos="{x:.9g} {y:.9g} 0" euler="0 0 {heading:.9g}" size="{length / 2:.9g} {half:g} 0.004"/>'
    )


if __name__ == "__main__":
    for n in (20, 40, 100):
        print(n, round(cost(n), 4))
