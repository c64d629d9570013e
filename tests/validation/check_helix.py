"""Instability of a long twisted hose: it must turn into a helix where theory says."""

import mujoco
import numpy as np

import theory
from rod import NAME, Rod, clamped, straight
from suite import Check, Refused, edit


def half_with_handle(xml, links, tip_m, height_m):
    """The half of a clamped straight tube from its middle on, its last link welded to a handle that slides along the tube and
    turns about it."""
    root_link = links // 2

    def change(root):
        middle = next(b for b in root.iter("body") if b.get("name") == f"{NAME}_{root_link}")
        for child in middle.findall("body"):
            if child.get("name") != f"{NAME}_{root_link + 1}":
                middle.remove(child)
        world = root.find("worldbody")
        handle = world.makeelement("body", {"name": "handle", "pos": f"{tip_m} 0 {height_m}"})
        for values in ({"name": "slide", "type": "slide", "axis": "1 0 0"},
                       {"name": "turn", "type": "hinge", "axis": "1 0 0", "armature": "0.001"}):
            handle.append(handle.makeelement("joint", values))
        handle.append(handle.makeelement("inertial", {"pos": "0 0 0", "mass": "0.05", "diaginertia": "1e-4 1e-4 1e-4"}))
        world.append(handle)
        section = root.makeelement("equality", {})
        section.append(section.makeelement("weld", {"body1": "handle", "body2": f"{NAME}_{links - 1}", "solref": "0.002 1",
                                                    "solimp": "0.9999 0.9999"}))
        root.append(section)
    return edit(xml, change)


def helix(lab, links=40, length_m=2.0, tension_N=6.0, rate_rad_s=1.5):
    part, path = lab.part("hose_b", length_m=length_m, mass_kg=0.55)
    line = straight(length_m, links)
    xml = half_with_handle(clamped(lab.tube(path, line, timestep_s=0.001)), links, 0.5 * length_m, line[0][2])
    model = mujoco.MjModel.from_xml_string(xml)
    if model.nv < 2 + 3 * (links - links // 2 - 1):
        raise Refused("the links of the exported tube do not twist")
    data = mujoco.MjData(model)
    model.opt.gravity[:] = 0
    model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_CONTACT
    turn, slide = model.joint("turn"), model.joint("slide")
    model.dof_armature[:-2] = 1e-6  # Rotors and losses only delay: theory speaks of the moment.
    model.dof_damping[:-2] *= 0.2
    bodies = [b for b in range(model.nbody) if model.body(b).name.startswith(NAME)]
    free_m = 0.5 * length_m - 1.0 * length_m / links  # From the middle of the first link to the middle of the last.
    EI = part["bending_stiffness_Nm2"]
    GJ = theory.torsional_stiffness(EI)
    expected = theory.helical_moment(EI, tension_N, free_m)
    rng = np.random.default_rng(1)
    angle, most = 0.0, 1.5 * expected * free_m / GJ
    while angle < most:
        rate = rate_rad_s if angle > 0.5 * most else 10.0  # Fast to three quarters of what is expected.
        angle += rate * model.opt.timestep
        data.qfrc_applied[:] = 1e-5 * rng.standard_normal(model.nv)
        data.qfrc_applied[slide.dofadr[0]] = tension_N
        # A stiff servo turns the handle.
        data.qfrc_applied[turn.dofadr[0]] += 100 * (angle - data.qpos[turn.qposadr[0]]) + 0.6 * (
            rate - data.qvel[turn.dofadr[0]])
        mujoco.mj_step(model, data)
        if np.hypot(data.xpos[bodies, 1], data.xpos[bodies, 2] - line[0][2]).max() > 0.02:
            break
    moment = GJ * data.qpos[turn.qposadr[0]] / free_m if angle < most else np.inf
    yield Check("long hose under tension and twist: moment at which it turns into a helix", expected, moment, 0.05,
                "the twist grows while the helix does", "Greenhill 1883, van der Heijden and Thompson 2000, clamped ends",
                "N m")
