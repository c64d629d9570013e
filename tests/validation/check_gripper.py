"""The room that the exported gripper takes, against its file and the public model of its linkage."""

import mujoco
import numpy as np

import cell
from check_grip import gripper_file
from suite import Check

# Public model (mujoco_menagerie, robotiq_2f85.xml), one finger when open: y closing, z out of the tool, millimetres.
DRIVER, SPRING = np.array([30.6, 54.9]), np.array([13.2, 60.9])  # Pivots in the chassis.
DRIVER_PIN = np.array([62.1, 50.8])     # Driver and coupler.
SPRING_PIN = np.array([50.2, 104.9])    # Spring link and follower.
COUPLER_PIN = np.array([68.2, 98.4])    # Coupler and follower.
FACE, TIP = 42.7, 149.4                 # The pad's face and lower edge.
SOURCE = "mujoco_menagerie, robotiq_2f85: pivots and anchors of its joints"


def public_pins(opening_mm):
    """Pins at an opening whose follower stays upright: (y from the middle, height over the tips)."""
    crank = SPRING_PIN - SPRING
    low, high = 0.0, 1.2
    for _ in range(50):
        angle = 0.5 * (low + high)
        y = SPRING[0] + crank[0] * np.cos(angle) - crank[1] * np.sin(angle) - (SPRING_PIN[0] - FACE)
        low, high = (angle, high) if y > 0.5 * opening_mm else (low, angle)
    turned = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]) @ crank
    spring_pin = SPRING + turned
    coupler_pin = spring_pin + COUPLER_PIN - SPRING_PIN
    # The driver's pin lies on two circles; the outer meeting is the mechanism's.
    r1, r2 = np.linalg.norm(DRIVER_PIN - DRIVER), np.linalg.norm(COUPLER_PIN - DRIVER_PIN)
    between = coupler_pin - DRIVER
    d = np.linalg.norm(between)
    along = (d * d + r1 * r1 - r2 * r2) / (2 * d)
    aside = np.sqrt(max(0.0, r1 * r1 - along * along))
    across = np.array([between[1], -between[0]]) / d
    driver_pin = DRIVER + along * between / d + aside * across
    tip = spring_pin[1] + TIP - SPRING_PIN[1]
    return {"driver and coupler": (driver_pin[0], tip - driver_pin[1]),
            "coupler and follower": (coupler_pin[0], tip - coupler_pin[1]),
            "spring link and follower": (spring_pin[0], tip - spring_pin[1])}


def outside(model, data, geom, p):
    """Distance of a point from a geom's surface, 0 inside."""
    local = data.geom_xmat[geom].reshape(3, 3).T @ (p - data.geom_xpos[geom])
    size = model.geom_size[geom]
    kind = model.geom_type[geom]
    if kind == mujoco.mjtGeom.mjGEOM_BOX:
        return np.linalg.norm(np.maximum(np.abs(local) - size, 0))
    if kind == mujoco.mjtGeom.mjGEOM_CYLINDER:
        beyond = [np.hypot(local[0], local[1]) - size[0], abs(local[2]) - size[1]]
        return np.linalg.norm(np.maximum(beyond, 0))
    axis = np.array([0, 0, np.clip(local[2], -size[1], size[1])])
    return max(0.0, np.linalg.norm(local - axis) - size[0])


def opened(lab, opening_m):
    """The cell's gripper standing at an opening, without gravity; the tube is out of reach."""
    _, path = cell.straight_part(lab)
    world = cell.Cell(cell.export(lab, path, [[(-0.25, 0.1, 0.013), (0.25, 0.1, 0.013)]]))
    world.model.opt.gravity[:] = 0
    grip = world.model.actuator("grip").id
    world.data.ctrl[grip] = gripper_file()["stroke_m"] - opening_m
    world.model.actuator_forcerange[grip] = [-500, 500]
    world.step(1.0)
    return world


def envelope(lab):
    spec = gripper_file()
    openings = spec["tip_opening_m"]
    worst = dict.fromkeys(public_pins(50), 0.0)
    advance, gap = [], []
    for opening in openings:
        world = opened(lab, opening)
        m, d = world.model, world.data
        R = d.site("wrist").xmat.reshape(3, 3)
        left, right = (d.geom(p).xpos for p in cell.PADS)
        face = m.geom("pad_left").size[1]
        gap.append(abs((left - right) @ R[:, 1]) - 2 * face)
        tip = 0.5 * (left + right) + m.geom("pad_left").size[2] * R[:, 2]
        advance.append((tip - d.site("wrist").xpos) @ R[:, 2])
        geoms = [g for g in range(m.ngeom) if m.geom_contype[g] == m.geom("pad_left").contype[0]]
        for name, (y, height) in public_pins(1e3 * opening).items():
            for side in (-1, 1):
                p = tip + 1e-3 * (side * y * R[:, 1] - height * R[:, 2])
                worst[name] = max(worst[name], 1e3 * min(outside(m, d, g, p) for g in geoms))
    yield Check("pads' largest error of the opening, five openings", 0.5, 1e3 * np.abs(np.subtract(gap, openings)).max(),
                0, "the servo's rest", "the opening asked for", "mm", kind="most")
    table = np.array(spec["tip_advance_m"])
    off = np.abs(np.array(advance) - advance[-1] - (table - table[-1])).max()
    yield Check("tips' largest error of the advance, five openings", 0.5, 1e3 * off, 0, "a polynomial of fourth degree",
                "the gripper file's table", "mm", kind="most")
    size = np.max([m.geom_size[g] for g in range(m.ngeom) if m.geom(g).name.startswith("pad_left")], axis=0)
    yield Check("pad's width", 1e3 * spec["pad_width_m"], 2e3 * size[0], 1e-4, "written with six digits",
                "the gripper file", "mm")
    yield Check("pad's height", 1e3 * spec["pad_height_m"], 2e3 * size[2], 1e-4, "the same", "the gripper file", "mm")
    for name, distance in worst.items():
        yield Check(f"pin of {name}: farthest outside of the gripper's shapes", 1.0, distance, 0,
                    "bars thicker than pins cover them", SOURCE, "mm", kind="most")
