"""Bending and twist of one hose: elastica, vibration, hooks, torsion, Michell's ring."""

import xml.etree.ElementTree as ET

import mujoco
import numpy as np

import theory
from rod import Rod, clamped, straight
from suite import Check, Refused, edit

SHAPE = "chords of the links against the curve: the error falls with the square of the link's length"


def elastica(lab):
    """Three stiffnesses and three link counts."""
    part, _ = lab.part("hose_b")
    yield from elastica_of(lab, [(EI, part["links"]) for EI in (0.05, 0.15, 0.30)] + [(0.15, n) for n in (10, 14, 20)])


def elastica_once(lab):
    part, _ = lab.part("hose_b")
    yield from elastica_of(lab, [(part["bending_stiffness_Nm2"], part["links"])])


def elastica_of(lab, cases):
    """Large deflection of a clamped half, dead load P L^2 / EI = 3: the tip goes 0.6 of its length."""
    for EI, links in dict.fromkeys(cases):
        part, path = lab.part("hose_b", bending_stiffness_Nm2=EI)
        line = straight(part["length_m"], links)
        rod = Rod(clamped(lab.tube(path, line)), line)
        length = part["length_m"] - rod.clamp_arc()
        load = 3.0 * EI / length**2
        along, across = length * theory.elastica_tip(3.0)
        rod.settle(-1, (0, 0, load))
        moved = rod.node(-1) - [line[0][0] + rod.clamp_arc(), 0, line[0][2]]
        yield Check(f"elastica, EI {EI:g} N m², {links} links: tip across", 1e3 * across, 1e3 * moved[2], 0.03, SHAPE,
                    "Euler's elastica, integrated by Runge-Kutta (Bisshopp and Drucker 1945)", "mm")
        yield Check(f"elastica, EI {EI:g} N m², {links} links: tip along", 1e3 * along, 1e3 * moved[0], 0.03, SHAPE,
                    "the same", "mm")


def ring_down(lab, mode, timestep_s):
    """Angular frequency and damping ratio of a straight hose without supports, released bent like a mode."""
    part, path = lab.part("hose_b")
    line = straight(part["length_m"], part["links"])
    rod = Rod(lab.tube(path, line, timestep_s=timestep_s), line)
    links = part["links"]
    curvature = theory.free_free_curvature(mode, np.arange(1, links) / links)
    weight = curvature / np.abs(curvature).max()
    hinges = []  # Of each: address, and the bend about z that one radian of it makes at its node.
    for i, (joints, side) in enumerate(rod.bend_joints()):
        for joint in joints:
            share = side * rod.data.xaxis[joint][2]
            hinges.append((rod.model.jnt_qposadr[joint], share, weight[i]))
            rod.data.qpos[hinges[-1][0]] = 0.03 * weight[i] * share
    omega = theory.free_free_frequency(mode, part["bending_stiffness_Nm2"], part["mass_kg"] / part["length_m"],
                                       part["length_m"])
    every = max(1, int(round(2 * np.pi / omega / 12 / timestep_s)))
    samples = []
    for step in range(every * 30):
        if step % every == 0:
            samples.append(sum(w * share * rod.data.qpos[a] for a, share, w in hinges))
        mujoco.mj_step(rod.model, rod.data)
    measured, ratio = theory.poles(samples, every * timestep_s)
    return part, omega, measured, ratio


def loss_factor(part):
    return part.get("loss_factor", 0.15)


def modes(lab):
    part, omega, measured, ratio = ring_down(lab, 0, 0.001)
    yield Check("first free-free bending mode", omega / (2 * np.pi), measured / (2 * np.pi), 0.05,
                "rotors at the joints (armature), which steady light links, slow it",
                "Euler-Bernoulli, 4.730 / L", "Hz")
    yield Check("damping ratio of the first mode", 0.5 * loss_factor(part), ratio, 0.10,
                "implicit steps of 1 ms damp by omega dt / 2 = 0.05 on their own, which the joints must make up for",
                "half of the part's loss factor"
                + ("" if "loss_factor" in part else " (none stated: EPDM 0.1 to 0.2)"))
    _, omega, measured, _ = ring_down(lab, 1, 0.001)
    yield Check("second free-free bending mode", omega / (2 * np.pi), measured / (2 * np.pi), 0.15,
                "the same, more so, and a third of the length has few links", "Euler-Bernoulli, 7.853 / L", "Hz")


def hook(lab):
    """With as many links as the part has."""
    part, _ = lab.part("hose_b")
    yield from hook_of(lab, part["links"], "hook's compliance")


def hook_converges(lab):
    for links in (14, 20, 40):
        yield from hook_of(lab, links, f"{links} links: hook's compliance")


def hook_of(lab, links, name):
    """Compliance of a hooked hose at its end, held in the middle, within 10 % of the continuous curve."""
    part, path = lab.part("hose_b")
    bend, end = np.radians(120.0), 0.05
    arc = 0.05 * bend
    middle = part["length_m"] - 2 * (arc + end)
    curve = theory.arc_line([(end, 0), (arc, bend), (middle, 0), (arc, bend), (end, 0)])
    nodes = theory.at_arc_length(curve, np.linspace(0, theory.arc_lengths(curve)[-1], links + 1))
    nodes[:, 2] += 0.3
    rod = Rod(clamped(lab.tube(path, nodes)), nodes)
    EI = part["bending_stiffness_Nm2"]
    held = rod.clamp_arc() * part["length_m"] / theory.arc_lengths(nodes)[-1]
    rest = theory.at_arc_length(curve, np.linspace(held, part["length_m"], 400))
    expected = theory.tip_compliance(rest, EI, theory.torsional_stiffness(EI))
    force, measured = 0.02, np.zeros((3, 3))
    for k in range(3):
        push = np.zeros(3)
        push[k] = force
        rod.reset()
        start = rod.node(-1)
        rod.settle(-1, push)
        measured[:, k] = (rod.node(-1) - start) / force
    source = "Castigliano's integral along the continuous curve, GJ = EI / 1.5"
    yield Check(f"{name} in its plane", 1e3 * np.trace(expected[:2, :2]), 1e3 * np.trace(measured[:2, :2]),
                0.10, "asked of the twin", source, "mm/N")
    yield Check(f"{name} out of its plane", 1e3 * expected[2, 2], 1e3 * measured[2, 2], 0.10,
                "asked of the twin", source, "mm/N")


def torsion(lab):
    """Angle of a straight hose under a torque at its end."""
    part, path = lab.part("hose_b")
    line = straight(part["length_m"], part["links"])
    rod = Rod(clamped(lab.tube(path, line)), line)
    GJ = theory.torsional_stiffness(part["bending_stiffness_Nm2"])
    length = part["length_m"] * (1 - 0.5 / part["links"]) - rod.clamp_arc()
    before = rod.data.xmat[rod.bodies[-1]].reshape(3, 3).copy()
    torque = 0.2 * GJ / length
    rod.settle(-1, torque_Nm=(torque, 0, 0))
    turn = rod.data.xmat[rod.bodies[-1]].reshape(3, 3) @ before.T
    angle = np.arctan2(turn[2, 1], turn[1, 1])
    yield Check("torsional stiffness G J", GJ, torque * length / angle if angle > 1e-4 else np.inf, 0.02,
                "linear springs in a row", "Saint-Venant, G J = EI / (1 + nu), nu 0.5", "N m²")


def twist_closed(rod, turned):
    """Closes the ring's weld turned by an angle about the tube's axis."""
    first, last = rod.ends
    turn, relative = np.zeros(4), np.zeros(4)
    mujoco.mju_axisAngle2Quat(turn, np.array([0.0, 0.0, 1.0]), turned)
    mujoco.mju_mulQuat(relative, rod.untwisted, turn)
    rod.model.eq_data[0, 6:10] = relative


def ring(lab, links):
    """A straight hose bent into a ring whose last link lies upon its first, welded."""
    part, path = lab.part("hose_b")
    angle = 2 * np.pi * np.arange(links + 2) / links
    radius = 0.5 * part["length_m"] / links / np.sin(np.pi / links)
    nodes = np.column_stack([radius * np.cos(angle), radius * np.sin(angle), np.full(links + 2, 0.3)])
    xml = lab.tube(path, nodes, rest=straight(part["length_m"] * (links + 1) / links, links + 1))
    first, last = "tube0_0", f"tube0_{links}"
    rod = Rod(edit(xml, lambda root: ET.SubElement(ET.SubElement(root, "equality"), "weld", body1=first, body2=last)),
              nodes)
    rod.ends = rod.bodies[0], rod.bodies[-1]
    rod.untwisted = rod.model.eq_data[0, 6:10].copy()
    rod.model.eq_solref[0] = [0.002, 1.0]
    rod.model.eq_solimp[0] = [0.9999, 0.9999, 0.001, 0.5, 2.0]  # Far stiffer than the joints' springs.
    rod.model.opt.timestep = 0.0005
    rod.model.dof_damping[6:] *= 3  # No matter to the threshold.
    if rod.model.nv < 6 + 3 * links:
        raise Refused("the links of the exported tube do not twist")
    return part, rod


def michell(lab, links=16, rate_rad_s=6.0):
    """Twist put into a plane ring, slowly, until it buckles out of its plane."""
    part, rod = ring(lab, links)
    EI = part["bending_stiffness_Nm2"]
    critical = 2 * np.pi * np.sqrt(3) * EI / theory.torsional_stiffness(EI)
    along = [rod.model.jnt_qposadr[j] for ids, _ in rod.bend_joints() for j in ids if rod.twists(j)]
    rng = np.random.default_rng(1)
    twist, most, left = 0.0, 0.0, np.inf
    while twist < 1.4 * critical and left == np.inf:
        for _ in range(50):
            twist += rate_rad_s * rod.model.opt.timestep
            twist_closed(rod, twist)
            rod.data.qfrc_applied[:] = 1e-6 * rng.standard_normal(rod.model.nv)
            mujoco.mj_step(rod.model, rod.data)
        now = np.abs(rod.data.qpos[along]).sum()
        most = max(most, now)
        if now < most - 6:  # A ring that flips over gives two turns of twist away.
            left = twist
    yield Check("Michell's ring: twist at which it leaves its plane", critical, left, 0.15,
                "links, weld and shaking are imperfections, which lower it",
                "Michell 1889, 2 pi sqrt(3) EI / GJ (Goriely 2006)", "rad")
