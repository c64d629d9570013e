"""Wilson 95 % intervals of rates, for the scripts beside it."""
import math

Z = 1.959964


def wilson_interval(k, n):
    """Bounds of a rate of k in n; 0 and 1 where there are none."""
    if n == 0:
        return (0.0, 1.0)
    p = k / n
    centre = (p + Z * Z / (2 * n)) / (1 + Z * Z / n)
    half = Z / (1 + Z * Z / n) * math.sqrt(p * (1 - p) / n + Z * Z / (4 * n * n))
    return (max(0.0, centre - half), min(1.0, centre + half))


def wilson(k, n):
    """"k/n = rate [low, high]" in percent; "-" where there are none."""
    if n == 0:
        return "-"
    low, high = wilson_interval(k, n)
    return f"{k}/{n} = {100 * k / n:.1f} % [{100 * low:.1f}, {100 * high:.1f}]"
