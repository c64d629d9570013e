"""VALIDATION.md and what the terminal shows, from the same rows."""

import dataclasses


@dataclasses.dataclass
class Group:
    title: str
    text: str
    checks: list
    refused: str = ""
    seconds: float = 0.0


HEAD = """# Validation

Made by `./dev validate`; do not edit. What the program exports (cell.xml of a result folder, single tubes by
tests/validation/tube_model.cc) is stepped by the stock engine's Python wheel {engine} and held against closed solutions,
integrals and other people's programs. Nothing here is computed by the program's own code, and no expected value comes
from an earlier result of it.

This says that the twin solves the mechanics that it states. It does not say that the stated materials are those of real
tubes: bending stiffness, friction, damping and the scanner's noise come from data sheets, papers and assumptions, and
no real cell stood beside it.

{count} checks: {within} within their tolerance, {outside} outside, {open} open ({open_meaning}).
"""
OPEN_MEANING = "known to fail, listed in tests/validation/validate.py with the reason"


def number(value):
    if value != value:
        return "none"
    if value in (float("inf"), float("-inf")):
        return "never"
    if value == 0 or 1e-4 <= abs(value) < 1e5:
        return f"{value:.4g}" if abs(value) < 1000 else f"{value:.0f}"
    return f"{value:.1e}"


def verdict(check, known):
    if check.passed():
        return "within"
    return "open" if check.name in known else "**outside**"


def table(group, known):
    lines = ["| check | expected | measured | allowed, because | verdict | source |", "|---|---|---|---|---|---|"]
    for check in group.checks:
        unit = f" {check.unit}" if check.unit else ""
        lines.append(f"| {check.name} | {number(check.expected)}{unit} | {number(check.measured)}{unit} | "
                     f"{check.allowed()}: {check.reason} | {verdict(check, known)} | {check.source} |")
    return "\n".join(lines)


def page(groups, known, engine):
    checks = [c for g in groups for c in g.checks]
    verdicts = [verdict(c, known) for c in checks]
    text = HEAD.format(engine=engine, count=len(checks), within=verdicts.count("within"),
                       outside=verdicts.count("**outside**"), open=verdicts.count("open"), open_meaning=OPEN_MEANING)
    for group in groups:
        text += f"\n## {group.title}\n\n{group.text}\n\n"
        text += group.refused + "\n" if group.refused else table(group, known) + "\n"
    return text
