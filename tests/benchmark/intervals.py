"""95 % intervals of rates, for the scripts beside it: Wilson's, and by rounds where trials of a round depend on each
other."""
import collections
import math

Z = 1.959964


def wilson_of_share(p, n):
    """Wilson's bounds of a share of so many independent trials, which need be no whole number."""
    centre = (p + Z * Z / (2 * n)) / (1 + Z * Z / n)
    half = Z / (1 + Z * Z / n) * math.sqrt(p * (1 - p) / n + Z * Z / (4 * n * n))
    return (max(0.0, centre - half), min(1.0, centre + half))


def wilson_interval(k, n):
    """Bounds of a rate of k in n; 0 and 1 where there are none."""
    return (0.0, 1.0) if n == 0 else wilson_of_share(k / n, n)


def student(df):
    """The 97.5 % quantile of Student's t."""
    scale = math.exp(math.lgamma((df + 1) / 2) - math.lgamma(df / 2)) / math.sqrt(df * math.pi)

    def half_mass(t, steps=400):  # Simpson's rule, of t = tan(x): the tails of few degrees are long.
        end = math.atan(t)
        values = [scale * (1 + math.tan(end * i / steps) ** 2 / df) ** (-(df + 1) / 2) / math.cos(end * i / steps) ** 2
                  for i in range(steps + 1)]
        return end / steps / 3 * (values[0] + values[-1] + 4 * sum(values[1:-1:2]) + 2 * sum(values[2:-1:2]))

    low, high = 1.9, 13.0
    while high - low > 1e-7:
        middle = (low + high) / 2
        low, high = (middle, high) if half_mass(middle) < 0.475 else (low, middle)
    return low


def cluster_interval(rounds):
    """Bounds by rounds of (k, n) each: as ClusterWilson95 of twin/statistics."""
    rounds = [(k, n) for k, n in rounds if n > 0]
    all_k, all_n = sum(k for k, _ in rounds), sum(n for _, n in rounds)
    if all_n == 0:
        return (0.0, 1.0)
    p, m = all_k / all_n, len(rounds)
    if m < 2 or all_k in (0, all_n):
        return wilson_of_share(p, m)
    between = m / (m - 1) * sum((k - p * n) ** 2 for k, n in rounds)
    worth = all_n / max(1.0, between / (p * (1 - p) * all_n))
    return wilson_of_share(p, worth * (Z / student(m - 1)) ** 2)


def told(k, n, interval):
    if n == 0:
        return "-"
    low, high = interval
    return f"{k}/{n} = {100 * k / n:.1f} % [{100 * low:.1f}, {100 * high:.1f}]"


def wilson(k, n):
    """"k/n = rate [low, high]" in percent, of independent trials; "-" where there are none."""
    return told(k, n, wilson_interval(k, n))


def by_rounds(trials):
    """The same by rounds, of (round, success) of each trial."""
    counts = collections.defaultdict(lambda: [0, 0])
    for where, good in trials:
        counts[where][0] += bool(good)
        counts[where][1] += 1
    k, n = (sum(c[i] for c in counts.values()) for i in (0, 1))
    return told(k, n, cluster_interval(counts.values()))
