"""Closed and integral solutions of rods, from textbooks, without any engine."""

import functools

import numpy as np

FREE_FREE = (4.730041, 7.853205)  # Roots of cos b cosh b = 1.
POISSON = 0.5  # Rubber does not change its volume: GJ = EI / (1 + nu).


def torsional_stiffness(EI):
    return EI / (1.0 + POISSON)


@functools.lru_cache
def elastica_tip(load, steps=400):
    """Tip of a clamped straight rod of length 1 under a load P L^2 / EI across its first direction, which
    keeps its direction: (along, across)."""
    h = 1.0 / steps

    def slope(s):
        # Of angle, curvature, along, across, backwards in arc length: EI theta'' = -P cos(theta).
        return np.array([-s[1], load * np.cos(s[0]), np.cos(s[0]), np.sin(s[0])])

    def shoot(tip_angle):
        """From the tip, where no moment acts, to the clamp."""
        state = np.array([tip_angle, 0.0, 0.0, 0.0])
        for _ in range(steps):
            k1 = slope(state)
            k2 = slope(state + 0.5 * h * k1)
            k3 = slope(state + 0.5 * h * k2)
            state = state + h / 6 * (k1 + 2 * k2 + 2 * k3 + slope(state + h * k3))
        return state

    low, high = 0.0, 0.5 * np.pi
    for _ in range(30):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if shoot(middle)[0] < 0 else (low, middle)
    return shoot(0.5 * (low + high))[2:]


def free_free_frequency(mode, EI, kg_per_m, length_m):
    """Of a straight rod without supports, rad/s."""
    return (FREE_FREE[mode] / length_m) ** 2 * np.sqrt(EI / kg_per_m)


def free_free_curvature(mode, share):
    """Curvature of a mode shape at shares of the length, any scale."""
    b = FREE_FREE[mode]
    sigma = (np.cosh(b) - np.cos(b)) / (np.sinh(b) - np.sin(b))
    x = b * np.asarray(share)
    return np.cosh(x) - np.cos(x) - sigma * (np.sinh(x) - np.sin(x))


def tip_compliance(points, EI, GJ):
    """Castigliano: displacement of the last point per force on it, 3 x 3, of a rod clamped at its
    first point. `points` lie so close that the rod between two is straight."""
    points = np.asarray(points)
    total = np.zeros((3, 3))
    for a, b in zip(points[:-1], points[1:]):
        length = np.linalg.norm(b - a)
        t = (b - a) / length
        x, y, z = points[-1] - 0.5 * (a + b)
        arm = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])  # Moment of a force on the tip.
        twist = np.outer(t, t)
        total += length * arm.T @ ((np.eye(3) - twist) / EI + twist / GJ) @ arm
    return total


def arc_line(pieces, spacing_m=0.0005):
    """Points of a plane curve of (length, angle) pieces, from the origin along x, in the xy plane."""
    p, heading, line = np.zeros(2), 0.0, [np.zeros(2)]
    for length, angle in pieces:
        count = max(1, int(round(length / spacing_m)))
        for _ in range(count):
            heading += 0.5 * angle / count
            p = p + length / count * np.array([np.cos(heading), np.sin(heading)])
            heading += 0.5 * angle / count
            line.append(p)
    return np.column_stack([np.array(line), np.zeros(len(line))])


def arc_lengths(line):
    return np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1))])


def at_arc_length(line, s):
    """Points of a line at arc lengths."""
    at = arc_lengths(line)
    return np.column_stack([np.interp(s, at, line[:, k]) for k in range(3)])


def rod_inertia(line, mass_kg, radius_m, axial):
    """Centre and inertia about it of a uniform rod along a line: its axis as a curve of mass, plus
    its section (axial * m r^2 about the axis, half of that across)."""
    pieces = np.diff(line, axis=0)
    lengths = np.linalg.norm(pieces, axis=1)
    masses = mass_kg * lengths / lengths.sum()
    middles = 0.5 * (line[1:] + line[:-1])
    centre = masses @ middles / mass_kg
    total = np.zeros((3, 3))
    for m, piece, length, middle in zip(masses, pieces, lengths, middles):
        t = np.outer(piece, piece) / length**2
        d = middle - centre
        section = axial * m * radius_m**2
        total += section * t + (0.5 * section + m * length**2 / 12) * (np.eye(3) - t)
        total += m * (d @ d * np.eye(3) - np.outer(d, d))
    return centre, total


def poles(samples, step_s):
    """Angular frequency and damping ratio of samples of one damped vibration (Prony's method)."""
    x = np.asarray(samples)
    A = np.column_stack([x[1:-1], x[:-2]])
    a, b = np.linalg.lstsq(A, x[2:], rcond=None)[0]
    z = np.roots([1.0, -a, -b]).astype(complex)
    z = z[np.argmax(np.abs(z))]
    pole = np.log(z) / step_s
    return abs(pole), -pole.real / abs(pole)


def helical_moment(EI, tension_N, length_m):
    """Least twisting moment at which a straight rod with clamped ends under tension turns into a helix: EI w'''' - i M w''' -
    T w'' = 0 of the deflection w = y + i z, w = w' = 0 at both ends (Greenhill 1883; van der Heijden and Thompson 2000)."""
    def smallest(moment):
        a = moment / (2 * EI)
        b = np.sqrt(complex(moment**2 - 4 * EI * tension_N)) / (2 * EI)
        x = np.array([0.0, length_m])
        waves = [1j * (a + b), 1j * (a - b)]
        w = [np.ones(2), x / length_m] + [np.exp(k * x) for k in waves]
        slope = [np.zeros(2), np.ones(2)] + [k * length_m * np.exp(k * x) for k in waves]
        matrix = np.array([np.concatenate(pair) for pair in zip(w, slope)]).T
        return np.linalg.svd(matrix, compute_uv=False)[-1]

    moments = 2 * np.sqrt(EI * tension_N) + np.linspace(0.2, 15, 3000) * EI / length_m  # From the endless rod's on.
    values = np.array([smallest(m) for m in moments])
    for i in range(1, len(moments) - 1):
        if values[i] < values[i - 1] and values[i] < values[i + 1]:
            around = np.linspace(moments[i - 1], moments[i + 1], 2001)
            fine = [smallest(m) for m in around]
            if min(fine) < 1e-2 * values[i - 1]:  # A zero, no mere dip.
                return around[int(np.argmin(fine))]
    return np.nan
