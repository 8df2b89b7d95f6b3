"""Charts of a report as SVG: curves with bands, steps, and bars with intervals.

Colours and fonts come from `study_report.css`, so they follow the light or dark theme of the browser. Series
are told apart by colour and by their dashes.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from html import escape
from itertools import pairwise
from typing import NamedTuple

from silverball.metrics.statistics import Estimate

WIDTH, HEIGHT = 640.0, 320.0  # of a chart, in units of its own
LEFT, RIGHT, TOP, BOTTOM = 56.0, 16.0, 12.0, 44.0  # margins
SERIES = 6  # that have colours of their own

Form = Callable[[float], str]


class Curve(NamedTuple):
    """A curve with its band.

    Attributes:
        label: What it is.
        x: Where.
        y: The values.
        low: The lower ends of intervals; empty: no band.
        high: The upper ends.
    """

    label: str
    x: Sequence[float]
    y: Sequence[float]
    low: Sequence[float] = ()
    high: Sequence[float] = ()


class Axis(NamedTuple):
    """An axis: what it shows, its ends, and how its numbers are written."""

    label: str
    low: float
    high: float
    form: Form
    is_log: bool = False

    def share(self, value: float) -> float:
        """Where a value lies, 0 to 1."""
        low, high = self.low, self.high
        if self.is_log:
            value, low, high = (math.log10(max(one, 1e-300)) for one in (value, low, high))
        return min(max((value - low) / ((high - low) or 1.0), -0.02), 1.02)

    def ticks(self) -> list[float]:
        """Round numbers along it."""
        if self.is_log:
            first, last = math.ceil(math.log10(self.low)), math.floor(math.log10(self.high))
            found = [part * 10.0**power for power in range(first - 1, last + 1) for part in (1, 2, 5)]
            found = [value for value in found if self.low <= value <= self.high]
            return found if len(found) <= 8 else [value for value in found if is_power(value)]
        step = round_step((self.high - self.low) / 6.0)
        first = math.ceil(self.low / step - 1e-9)
        last = math.floor(self.high / step + 1e-9)
        return [number * step for number in range(first, last + 1)]


def curves(label: str, x: Axis, y: Axis, series: Sequence[Curve], *, is_stepped: bool = False) -> str:
    """A chart of curves."""
    drawn = []
    for number, one in enumerate(series):
        kind = f"s{number % SERIES}"
        if one.low:
            upper = [(x.share(a), y.share(b)) for a, b in zip(one.x, one.high, strict=True)]
            lower = [(x.share(a), y.share(b)) for a, b in zip(one.x, one.low, strict=True)]
            band = [*stepped(upper, is_stepped), *reversed(stepped(lower, is_stepped))]
            drawn.append(f'<polygon class="band {kind}" points="{listed(band)}"/>')
        line = [(x.share(a), y.share(b)) for a, b in zip(one.x, one.y, strict=True)]
        drawn.append(f'<polyline class="line {kind}" points="{listed(stepped(line, is_stepped))}"/>')
    return frame(label, x, y, "".join(drawn)) + (legend([one.label for one in series]))


def whiskers(label: str, x: Axis, y: Axis, series: Sequence[tuple[str, list[tuple[float, Estimate]]]]) -> str:
    """A chart of estimates at places, joined by lines, with their intervals."""
    drawn = []
    for number, (_, points) in enumerate(series):
        kind = f"s{number % SERIES}"
        drawn.append(
            f'<polyline class="line {kind}" points="'
            f'{listed([(x.share(a), y.share(one.value)) for a, one in points])}"/>'
        )
        for place, one in points:
            across, low, high = over(x.share(place)), up(y.share(one.low)), up(y.share(one.high))
            drawn.append(f'<path class="whisker {kind}" d="M{across:.1f} {low:.1f}V{high:.1f}"/>')
            drawn.append(
                f'<circle class="dot {kind}" cx="{across:.1f}" cy="{up(y.share(one.value)):.1f}" r="4"/>'
            )
    return frame(label, x, y, "".join(drawn)) + legend([name for name, _ in series])


def bars(label: str, x: Axis, edges: Sequence[float], values: Sequence[Estimate], y: Axis) -> str:
    """A histogram with intervals."""
    drawn = []
    for low, high, one in zip(edges[:-1], edges[1:], values, strict=True):
        left, right = over(x.share(low)), over(x.share(high))
        top, bottom = up(y.share(one.value)), up(0.0)
        drawn.append(
            f'<rect class="bar" x="{left + 0.5:.1f}" y="{top:.1f}" '
            f'width="{max(right - left - 1.0, 0.5):.1f}" height="{max(bottom - top, 0.0):.1f}"/>'
        )
        if one.high > 0.0 and math.isfinite(one.high):
            middle = 0.5 * (left + right)
            drawn.append(
                f'<path class="whisker" d="M{middle:.1f} {up(y.share(one.low)):.1f}'
                f'V{up(y.share(one.high)):.1f}"/>'
            )
    return frame(label, x, y, "".join(drawn))


def rows(
    label: str,
    items: Sequence[tuple[str, Estimate, str]],
    reference: float | None = None,
    most: float | None = None,
) -> str:
    """A list of estimates as bars with intervals.

    Args:
        label: What they are, for those who cannot see them.
        items: What, the estimate, and its words.
        reference: A value that is marked.
        most: The value of a full bar; None: the greatest.
    """
    if not items:
        return '<p class="none">nothing</p>'
    highest = max(one.high if math.isfinite(one.high) else one.value for _, one, _ in items)
    most = most or highest or 1.0
    found = []
    for name, one, words in items:
        low, high = (100.0 * min(max(value / most, 0.0), 1.0) for value in (one.low, one.high))
        value = 100.0 * min(max(one.value / most, 0.0), 1.0)
        mark = f'<i class="mark" style="left:{100.0 * reference / most:.2f}%"></i>' if reference else ""
        found.append(
            f'<tr><th scope="row">{escape(name)}</th><td class="track"><div>'
            f'<i class="fill" style="width:{value:.2f}%"></i>'
            f'<i class="span" style="left:{low:.2f}%;width:{high - low:.2f}%"></i>{mark}</div></td>'
            f"<td>{escape(words)}</td></tr>"
        )
    return f'<table class="rows" aria-label="{escape(label)}">{"".join(found)}</table>'


def frame(label: str, x: Axis, y: Axis, drawn: str) -> str:
    """A chart with its axes around what is drawn."""
    lines = []
    for value in y.ticks():
        height = up(y.share(value))
        lines.append(f'<path class="grid" d="M{LEFT:g} {height:.1f}H{WIDTH - RIGHT:g}"/>')
        lines.append(f'<text class="y" x="{LEFT - 6:g}" y="{height + 4:.1f}">{escape(y.form(value))}</text>')
    for value in x.ticks():
        across = over(x.share(value))
        lines.append(f'<path class="tick" d="M{across:.1f} {HEIGHT - BOTTOM:g}v5"/>')
        lines.append(
            f'<text class="x" x="{across:.1f}" y="{HEIGHT - BOTTOM + 18:g}">{escape(x.form(value))}</text>'
        )
    middle = LEFT + 0.5 * (WIDTH - LEFT - RIGHT)
    return (
        f'<svg class="chart" viewBox="0 0 {WIDTH:g} {HEIGHT:g}" role="img" aria-label="{escape(label)}">'
        f'{"".join(lines)}<path class="axis" d="M{LEFT:g} {HEIGHT - BOTTOM:g}H{WIDTH - RIGHT:g}"/>{drawn}'
        f'<text class="x name" x="{middle:g}" y="{HEIGHT - 6:g}">{escape(x.label)}</text></svg>'
    )


def legend(labels: Sequence[str]) -> str:
    """Which curve is which; nothing for a single one."""
    if len(labels) < 2:
        return ""
    items = "".join(
        f'<li><svg viewBox="0 0 24 8"><path class="line s{number % SERIES}" d="M0 4H24"/></svg>'
        f"{escape(one)}</li>"
        for number, one in enumerate(labels)
    )
    return f'<ul class="legend">{items}</ul>'


def over(share: float) -> float:
    """The place of a share of the x axis in a chart."""
    return LEFT + share * (WIDTH - LEFT - RIGHT)


def up(share: float) -> float:
    """The place of a share of the y axis in a chart."""
    return HEIGHT - BOTTOM - share * (HEIGHT - TOP - BOTTOM)


def listed(points: Sequence[tuple[float, float]]) -> str:
    """Points given by shares of both axes, for SVG."""
    return " ".join(f"{over(a):.1f},{up(b):.1f}" for a, b in points)


def stepped(points: list[tuple[float, float]], is_stepped: bool) -> list[tuple[float, float]]:
    """The corners of steps from point to point, or the points themselves."""
    if not is_stepped:
        return points
    found = points[:1]
    for (_, before), (place, value) in pairwise(points):
        found += [(place, before), (place, value)]
    return found


def round_step(rough: float) -> float:
    """The next of 1, 2, 5 times a power of ten."""
    if not rough > 0.0:
        return 1.0
    power = 10.0 ** math.floor(math.log10(rough))
    return next(part * power for part in (1.0, 2.0, 5.0, 10.0) if part * power >= rough * (1.0 - 1e-9))


def is_power(value: float) -> bool:
    """Whether a number is a power of ten."""
    return math.isclose(math.log10(value), round(math.log10(value)))


def number(value: float) -> str:
    """A number in few characters: 1,500 as 1.5k."""
    for size, unit in ((1e9, "G"), (1e6, "M"), (1e4, "k")):
        if abs(value) >= size:
            return f"{value / (1e3 if unit == 'k' else size):.3g}{unit}"
    return f"{value:,.4g}"
