"""Tubes as bodies: mass, inertia, length, free fall, pendulum, energy."""

import mujoco
import numpy as np

import theory
from rod import NAME, Rod, straight
from suite import Check, GRAVITY, edit

AXIAL = {"rigid": 1.0, "hose": 0.625}  # m r^2 about the own axis: thin wall; bore of half the radius.


def numbers(values):
    return " ".join(f"{v:.9g}" for v in values)


def shapes(part):
    """Centerlines to build a tube along: straight, and an arc of 90 degrees."""
    nodes = part.get("links", 10) + 1
    curve = theory.arc_line([(part["length_m"], 0.5 * np.pi)])
    if part["kind"] == "hose":
        curve = theory.at_arc_length(curve, np.linspace(0, part["length_m"], nodes))
    else:
        curve = theory.at_arc_length(curve, np.linspace(0, part["length_m"], 13))
    return {"straight": straight(part["length_m"], nodes - 1), "bent": curve + [0, 0, 0.3]}


def whole(model, data):
    """Mass, centre and inertia about it of all bodies, and the extent of all capsules along x."""
    mass = model.body_mass[1:].sum()
    centre = model.body_mass[1:] @ data.xipos[1:] / mass
    total = np.zeros((3, 3))
    for body in range(1, model.nbody):
        R = data.ximat[body].reshape(3, 3)
        d = data.xipos[body] - centre
        total += R @ np.diag(model.body_inertia[body]) @ R.T
        total += model.body_mass[body] * (d @ d * np.eye(3) - np.outer(d, d))
    ends = []
    for geom in range(model.ngeom):
        along = data.geom_xmat[geom].reshape(3, 3)[:, 2] * model.geom_size[geom][1]
        for side in (-1, 1):
            ends.append((data.geom_xpos[geom] + side * along)[0])
    return mass, centre, total, max(ends) - min(ends) + 2 * model.geom_size[0][0]


def inertia(lab):
    for name in ("pvc_a", "hose_b"):
        part, path = lab.part(name)
        for shape, line in shapes(part).items():
            model = mujoco.MjModel.from_xml_string(lab.tube(path, line))
            data = mujoco.MjData(model)
            mujoco.mj_forward(model, data)
            mass, centre, measured, extent = whole(model, data)
            middle, expected = theory.rod_inertia(line, part["mass_kg"], part["radius_m"], AXIAL[part["kind"]])
            yield Check(f"{name}, {shape}: mass", 1e3 * part["mass_kg"], 1e3 * mass, 1e-6, "written with six digits",
                        "the part file", "g")
            yield Check(f"{name}, {shape}: centre of mass off the curve's", 0.0, 1e3 * np.linalg.norm(centre - middle),
                        0.05, "digits of the model file", "integral along the centerline", "mm", absolute=True)
            for k in range(3):
                yield Check(f"{name}, {shape}: principal moment {k + 1}",
                            1e6 * np.linalg.eigvalsh(expected)[k], 1e6 * np.linalg.eigvalsh(measured)[k], 0.02,
                            "how the mass of the end caps is spread", "integral along the centerline", "kg mm²")
            if shape == "straight":
                yield Check(f"{name}: length from tip to tip", 1e3 * part["length_m"], 1e3 * extent, 1.0,
                            "round ends stand for flat ones", "the part file: length_m is tip to tip", "mm",
                            absolute=True)


def fall(lab):
    """A quarter second of free fall of both parts."""
    for name in ("pvc_a", "hose_b"):
        part, path = lab.part(name)
        model = mujoco.MjModel.from_xml_string(lab.tube(path, shapes(part)["bent"]))
        data = mujoco.MjData(model)
        mujoco.mj_forward(model, data)
        start = model.body_mass @ data.xipos[:, 2]
        while data.time < 0.25 - 1e-9:
            mujoco.mj_step(model, data)
        mujoco.mj_forward(model, data)
        fallen = (start - model.body_mass @ data.xipos[:, 2]) / model.body_mass.sum()
        yield Check(f"{name}: free fall in 0.25 s", 1e3 * 0.5 * GRAVITY * 0.25**2, 1e3 * fallen, 0.01,
                    "steps of 1 ms: half a step more; the loss of the free joint", "g t² / 2", "mm")


def pendulum(lab):
    """A straight rigid tube swings about an axis through one end of its centerline, by 5 degrees."""
    part, path = lab.part("pvc_a")
    line = straight(part["length_m"], 10)

    xml = lab.tube(path, line)
    plain = Rod(xml, line, names=[NAME])
    R = plain.data.xmat[plain.bodies[0]].reshape(3, 3)
    pivot = {"name": "pivot", "type": "hinge", "axis": numbers(R.T @ [0, 1, 0]), "pos": numbers(plain.local[0])}

    def hang(root):
        body = next(b for b in root.iter("body") if b.get("name") == NAME)
        for joint in [j for j in body if j.tag == "freejoint" or j.get("type") == "free"]:
            body.remove(joint)
        body.insert(0, body.makeelement("joint", pivot))

    model = mujoco.MjModel.from_xml_string(edit(xml, hang))
    data = mujoco.MjData(model)
    hanging = 0.5 * np.pi  # The tube lies along x at first; a turn about y brings its far end down.
    amplitude = np.radians(5.0)
    data.qpos[0] = hanging - amplitude
    crossings, before = [], -amplitude
    while len(crossings) < 9 and data.time < 20:
        mujoco.mj_step(model, data)
        now = data.qpos[0] - hanging
        if before * now < 0:
            crossings.append(data.time - model.opt.timestep * now / (now - before))
        before = now
    period = 2 * (crossings[-1] - crossings[0]) / 8 if len(crossings) == 9 else np.nan
    _, about = theory.rod_inertia(line, part["mass_kg"], part["radius_m"], AXIAL["rigid"])
    arm = 0.5 * part["length_m"]
    expected = 2 * np.pi * np.sqrt((about[1, 1] + part["mass_kg"] * arm**2) / (part["mass_kg"] * GRAVITY * arm))
    yield Check("period of a tube hung by its end", expected, period * (1 - amplitude**2 / 16), 0.005,
                "crossings of a sampled swing", "2 pi sqrt(I / m g d), less the amplitude's 1/16 a²", "s")


def energy(lab):
    """A bent hose thrown without gravity: what kinetic and elastic energy win in any step."""
    part, path = lab.part("hose_b")
    line = shapes(part)["bent"]
    rod = Rod(lab.tube(path, line, rest=shapes(part)["straight"]), line)
    model, data = rod.model, rod.data
    model.opt.enableflags |= mujoco.mjtEnableBit.mjENBL_ENERGY
    data.qvel[:6] = [0.5, 0, 0, 0, 2, 6]
    mujoco.mj_forward(model, data)
    first = before = data.energy.sum()
    won = 0.0
    for _ in range(2000):
        mujoco.mj_step(model, data)
        mujoco.mj_energyPos(model, data)
        mujoco.mj_energyVel(model, data)
        won = max(won, data.energy.sum() - before)
        before = data.energy.sum()
    yield Check("energy that a whirling, ringing hose wins in a step of 1 ms, share", 0.002, won / first, 0,
                "fast modes are stepped coarsely", "energy only falls without work from outside", kind="most")
    yield Check("energy left after 2 s, share", 1.0, before / first, 0, "springs and joints lose", "the same",
                kind="most")
