"""Tubes at rest in the exported cell: contact forces, penetration, drift, and friction of every pair."""

import mujoco
import numpy as np

import cell
from suite import Check, GRAVITY

HALF = 0.25


def pile_of_three(lab):
    """Two straight tubes on the floor and one across them."""
    _, path = cell.straight_part(lab)
    z = 0.013
    lines = [[(-HALF, 0.1, z), (HALF, 0.1, z)], [(-HALF, -0.1, z), (HALF, -0.1, z)],
             [(0.0, -HALF, 3.1 * z), (0.0, HALF, 3.1 * z)]]
    return cell.Cell(cell.export(lab, path, lines))


def tube_against_cell(a, b):
    return a.startswith("tube") != b.startswith("tube")


def rest(lab):
    world = pile_of_three(lab)
    world.awake()
    world.step(1.5)
    held = np.zeros(3)
    deepest = 0.0
    for contact, names, force in world.contacts(lambda a, b: True):
        deepest = max(deepest, -contact.dist)
        if tube_against_cell(*names):
            held += force if names[1].startswith("tube") else -force
    weight = sum(world.model.body(t).mass[0] for t in world.tubes) * GRAVITY
    yield Check("three tubes at rest: what bin and floor carry", weight, held[2], 0.005,
                "a residual motion of the solver", "the tubes' weight: nothing levitates", "N")
    yield Check("three tubes at rest: force aside", 0.0, np.linalg.norm(held[:2]), 0.01, "the same", "equilibrium",
                "N", absolute=True)
    yield Check("deepest penetration at rest", 0.2, 1e3 * deepest, 0, "contacts are springs of 5 ms",
                "a hundredth of the smallest tube", "mm", kind="most")


def drop(lab):
    """Energy of three tubes that fall 100 mm, spin and come to rest."""
    world = pile_of_three(lab)
    world.awake()
    m, d = world.model, world.data
    m.opt.enableflags |= int(mujoco.mjtEnableBit.mjENBL_ENERGY)
    weight = sum(m.body(t).mass[0] for t in world.tubes) * GRAVITY
    mujoco.mj_forward(m, d)
    resting = d.energy.sum()
    for i, tube in enumerate(world.tubes):
        joint = m.joint(cell.tube_joint(tube))
        d.qpos[joint.qposadr[0] + 2] += 0.1
        d.qvel[joint.dofadr[0]:joint.dofadr[0] + 6] = [0.3, 0, 0, 1, 2, 3 - i]
    mujoco.mj_forward(m, d)
    first = d.energy.sum() - resting
    most = 0.0

    def watch():
        nonlocal most
        if d.time > 0:
            most = max(most, d.energy.sum() - resting)

    world.step(2.0, watch)
    yield Check("three tubes thrown down from 100 mm: their energy at first over the fall's", 1.0, first / (0.1 * weight),
                0, "they also turn and fly", "m g h", kind="least")
    yield Check("the same: most energy at any time after", 1.001, most / first, 0, "single steps round",
                "contacts and friction only take energy", kind="most")
    yield Check("the same: energy left after 2 s", 0.01, (d.energy.sum() - resting) / first, 0,
                "they lie elsewhere than before", "friction and contacts end all motion", kind="most")


def drift(lab, seconds=60.0):
    """How far tubes at rest creep, with and without the engine's sleep."""
    for asleep in (True, False):
        world = pile_of_three(lab)
        world.step(1.5)
        if not asleep:
            world.awake()
        bodies = [world.model.body(t).id for t in world.tubes]
        start = world.data.xpos[bodies].copy()
        world.step(seconds)
        moved = np.linalg.norm(world.data.xpos[bodies] - start, axis=1).max()
        yield Check(f"drift in {seconds:g} s at rest, {'asleep' if asleep else 'awake'}",
                    0.05 if asleep else 1.0, 1e3 * moved, 0, "friction of the engine creeps by design",
                    "as little as a scan sees" if asleep else "a tenth of a tube", "mm", kind="most")


def hoses(lab, seconds=20.0):
    """Three straight hoses, one across two: what they carry and how they creep, awake."""
    part, path = lab.part("hose_b")
    x = np.linspace(-0.5 * part["length_m"], 0.5 * part["length_m"], part["links"] + 1)
    z = part["radius_m"] + 0.0005
    lines = [[(a, y, z) for a in x] for y in (0.08, -0.08)] + [[(0.0, a, 3.1 * z) for a in x]]
    world = cell.Cell(cell.export(lab, path, lines))
    world.awake()
    world.step(12.0)  # Straight hoses roll to and fro for a while.
    bodies = [world.model.body(t).id for t in world.tubes]
    start = world.data.xpos[bodies].copy()
    world.step(seconds)
    moved = np.linalg.norm(world.data.xpos[bodies] - start, axis=1).max()
    held = sum(f if n[1].startswith("tube") else -f for _, n, f in world.contacts(tube_against_cell))
    weight = world.model.body_mass[bodies].sum() * GRAVITY
    yield Check("three hoses at rest: what bin and floor carry", weight, held[2], 0.005,
                "a residual motion of the solver", "the hoses' weight", "N")
    yield Check(f"drift of hoses in {seconds:g} s at rest, awake", 1.0, 1e3 * moved, 0,
                "friction of the engine creeps by design", "a twentieth of a hose", "mm", kind="most")


def geom_text(model, geom, kind, size, extra):
    """One geom's contact values as XML."""
    g = model.geom(geom)
    return (f'<geom type="{kind}" size="{size}" {extra} condim="{g.condim[0]}" priority="{g.priority[0]}" '
            f'friction="{g.friction[0]} {g.friction[1]} {g.friction[2]}" solmix="{g.solmix[0]}" '
            f'solref="{g.solref[0]} {g.solref[1]}" solimp="{" ".join(map(str, g.solimp))}" margin="{g.margin[0]}" '
            f'gap="{g.gap[0]}" contype="{g.contype[0]}" conaffinity="{g.conaffinity[0]}"/>')


def pair_scene(model, under):
    """A tube of the cell lying along x on another geom of it: a flat one, or two tubes across."""
    tube = next(g for g in range(model.ngeom) if model.geom(g).name.startswith("tube"))
    r = model.geom_size[tube][0]
    if model.geom(under).name.startswith("tube"):
        floor = "".join(geom_text(model, under, "capsule", f"{r} 0.2", f'pos="{x} 0 {-r}" zaxis="0 1 0"')
                        for x in (-0.1, 0.1))
    else:
        floor = geom_text(model, under, "box", "2 1 0.01", 'pos="0 0 -0.01"')
    slider = geom_text(model, tube, "capsule", f"{r} 0.2", 'zaxis="1 0 0" mass="0.055"')
    o = model.opt
    return mujoco.MjModel.from_xml_string(
        f'<mujoco><option timestep="{o.timestep}" impratio="{o.impratio}" integrator="discrete" cone="elliptic"/>'
        f'<worldbody>{floor}<body pos="0 0 {r}"><freejoint/>{slider}</body></worldbody></mujoco>')


def slides(model, slope):
    """Whether the tube slides when gravity leans by that much along it."""
    data = mujoco.MjData(model)
    model.opt.gravity[:] = GRAVITY * np.array([slope, 0, -1]) / np.hypot(1, slope)
    for _ in range(400):
        mujoco.mj_step(model, data)
    return data.qpos[0] > 0.004


def onset(model):
    low, high = 0.0, 3.0
    while high - low > 0.004:
        middle = 0.5 * (low + high)
        low, high = (low, middle) if slides(model, middle) else (middle, high)
    return 0.5 * (low + high)


FINGER = 0.3  # Bare aluminium of a finger's back: below what the tubes have among themselves.


def friction(lab):
    """The slope at which a straight tube slides along itself on each surface of the cell."""
    model, values = pile_of_three(lab).model, cell.ASKED
    for geom, name in (("tube1_g0", "tube"), ("bin_floor", "bin"), ("tray", "tray"), ("pad_left", "pad"),
                       ("finger_left_bar", "finger")):
        key = f"{name}_friction" if f"{name}_friction" in values else "tube_friction"
        expected, source = values[key], f"Coulomb; physics.{key} as asked"
        if name == "finger":
            expected, source = FINGER, "Coulomb; bare aluminium, assumed by the program at the finger's shapes"
        yield Check(f"tube on {name}: slope at which it slides", expected, onset(pair_scene(model, geom)), 0.04,
                    "creep below, a slow start above", source)
