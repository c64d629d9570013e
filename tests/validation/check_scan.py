"""What the scanner sees against rays of our own, and its noise against the formula."""

import os
import tomllib

import numpy as np

import cell
from suite import SOURCE, Check

HEIGHTS = (0.03, 0.08, 0.13, 0.18)  # Of four straight tubes' axes over the floor: four distances.
ACROSS = (0.05, 0.11, 0.18, 0.24)
EXACT = ("noise", "bias", "flying_pixels", "interreflections", "incidence", "weak_signal", "highlights", "soft_range")


def read_cloud(path):
    """Points in the camera's frame (rows, columns, 3) and the camera's pose from a binary PCD file."""
    with open(path, "rb") as file:
        head = b""
        while not head.endswith(b"DATA binary\n"):
            head += file.readline()
        raw = file.read()
    value = {line.split()[0]: line.split()[1:] for line in head.decode().splitlines() if line}
    names = value["FIELDS"]
    kinds = [("f4" if t == "F" else "u4") for t in value["TYPE"]]
    cloud = np.frombuffer(raw, dtype=list(zip(names, kinds)))
    shape = int(value["HEIGHT"][0]), int(value["WIDTH"][0])
    points = np.stack([cloud[k].astype(float) for k in "xyz"], axis=-1).reshape(*shape, 3)
    view = np.array(value["VIEWPOINT"], float)
    w, x, y, z = view[3:]
    R = np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                  [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                  [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])
    return points, view[:3], R


def scan(lab, effects):
    """Cloud of four straight tubes above the bin's floor, with some effects off."""
    part, path = cell.straight_part(lab, gloss=0.0)
    pile = os.path.join(lab.folder, "scan.csv")
    with open(pile, "w") as file:
        file.write("tube,index,x,y,z\n")
        for tube, (y, z) in enumerate(zip(ACROSS, HEIGHTS)):
            file.writelines(f"{tube},{i},{x},{y},{z}\n" for i, x in enumerate((-0.38, 0.12)))
    out = os.path.join(lab.folder, f"scan_{len(effects)}")
    sets = [f"cell.scanner.{name}=false" for name in effects] + ["physics.randomize=false",
                                                                 "cell.scanner.hand_eye_error=0"]
    lab.run("tubetwin", "scan", pile, "--part", path, "--view", "0", "--out", out,
            *(a for s in sets for a in ("--set", s)))
    return part, *read_cloud(os.path.join(out, "view_0.pcd"))


def rays_on_tubes(part, place, R, directions):
    """Depth along the camera's axis at which rays (z = 1) meet the four tubes' cylinders, and cosine of incidence there.
    Infinite where none is met; not a number within two radii of a tip."""
    r, length = part["radius_m"], part["length_m"]
    d = directions @ R.T
    nearest = np.full(d.shape[:-1], np.inf)
    cosine = np.zeros_like(nearest)
    for y, z in zip(ACROSS, HEIGHTS):
        # A cylinder along x: only y and z of the ray matter.
        o = np.array([place[1] - y, place[2] - z])
        a = d[..., 1] ** 2 + d[..., 2] ** 2
        b = d[..., 1] * o[0] + d[..., 2] * o[1]
        root = b * b - a * (o @ o - r * r)
        t = np.where(root > 0, (-b - np.sqrt(np.maximum(root, 0))) / a, np.inf)
        x = place[0] + np.where(np.isfinite(t), t, 0) * d[..., 0] + 0.13  # From the tube's middle.
        hit = np.isfinite(t) & (np.abs(x) < 0.5 * length + r) & (t < nearest)
        normal_y = (o[0] + np.where(hit, t, 0) * d[..., 1]) / r
        normal_z = (o[1] + np.where(hit, t, 0) * d[..., 2]) / r
        facing = -(normal_y * d[..., 1] + normal_z * d[..., 2]) / np.linalg.norm(d, axis=-1)
        cosine = np.where(hit, facing, cosine)
        nearest = np.where(hit, np.where(np.abs(x) < 0.5 * length - 2 * r, t, np.nan), nearest)
    return nearest, cosine


def rays(lab):
    with open(os.path.join(SOURCE, "models", "scanners", "phoxi_s.toml"), "rb") as file:
        spec = tomllib.load(file)
    part, points, place, R = scan(lab, EXACT)
    rows, columns = points.shape[:2]
    seen = np.isfinite(points[..., 2]) & (points[..., 2] > 0)
    focal = spec["focal_px"] * columns / spec["full_width"]
    u, v = np.meshgrid(np.arange(columns) + 0.5 - columns / 2, np.arange(rows) + 0.5 - rows / 2)
    directions = np.stack([u / focal, v / focal, np.ones_like(u)], axis=-1)
    off = np.abs(points[..., :2] / points[..., 2:] - directions[..., :2])[seen].max() * focal
    yield Check("largest distance of a point from its pixel's ray", 0.01, off, 0, "single precision",
                "pinhole of the scanner file", "pixels", kind="most")
    depth, cosine = rays_on_tubes(part, place, R, directions)
    on_tube = seen & np.isfinite(depth) & (cosine > 0.1)
    error = np.abs(points[..., 2] - depth)[on_tube]
    yield Check("points on tubes that were compared, thousands", 30, on_tube.sum() / 1000, 0, "enough to mean something",
                "own rays", kind="least")
    yield Check("largest error of depth on tubes", 5.0, 1e6 * error.max(), 0, "single precision at 0.5 m",
                "own intersection of rays and cylinders", "µm", kind="most")
    floor = seen & np.isinf(depth)
    world = points[floor] @ R.T + place
    inside = (np.abs(world[:, 0]) < 0.35) & (np.abs(world[:, 1]) < 0.25)
    yield Check("largest height of the floor's points", 5.0, 1e6 * np.abs(world[inside, 2]).max(), 0,
                "single precision at 0.5 m", "the floor is z = 0 of the bin", "µm", kind="most")
    yield from noise(lab, part, place, R, directions, spec)


def noise(lab, part, place, R, directions, spec):
    """Standard deviation of depth over its formula, tube by tube."""
    _, points, _, _ = scan(lab, EXACT[1:])
    depth, cosine = rays_on_tubes(part, place, R, directions)
    good = np.isfinite(points[..., 2]) & (points[..., 2] > 0) & np.isfinite(depth) & (cosine > np.cos(np.radians(70)))
    sigma = spec["sigma_m"] * (depth / spec["sweet_spot_m"]) ** 2 / np.maximum(cosine, 0.17)
    world_z = place[2] - depth  # The camera looks straight down.
    for height in HEIGHTS:
        chosen = good & (world_z > height) & (world_z < height + part["radius_m"] + 1e-4)
        scaled = (points[..., 2] - depth)[chosen] / sigma[chosen]
        z = np.median(depth[chosen]) if chosen.any() else np.nan
        yield Check(f"noise of depth at {1e3 * z:.0f} mm over its formula", 1.0,
                    scaled.std() if chosen.sum() > 1000 else np.nan, 0.05,
                    "thousands of points, neighbours correlated",
                    f"{1e3 * spec['sigma_m']:g} mm (z / {1e3 * spec['sweet_spot_m']:g} mm)² / cos(incidence)")
