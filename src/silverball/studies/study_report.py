"""The report of a study: one HTML file that needs nothing else, for a browser on a desk or a phone."""

from __future__ import annotations

import json
import math
import platform
import re
from collections.abc import Mapping, Sequence
from html import escape
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from silverball.metrics.game_traces import TICK_RATE
from silverball.metrics.statistics import Estimate, share
from silverball.plain import plain
from silverball.studies import charts
from silverball.studies.charts import SERIES, Axis, Curve
from silverball.studies.figure_words import COMPARED, ROWS, in_words, on_one_line
from silverball.studies.study import Study
from silverball.studies.summary import ArmSummary, Row
from silverball.studies.table_plan import TableMap
from silverball.table import Table, expand, table_digest

SHOWN_ROWS = 16  # of lists of parts
SHOWN_ARMS = 12  # that have maps and lists of their own
CURVE_POINTS = 400
SCORE_BARS = 36
DRAIN_BARS = 32
FOLDER = Path(__file__).parent
PLACE = re.compile(r"%([A-Z]+)%")  # of something in the template


class WatchedGame(NamedTuple):
    """A game that can be watched in a report.

    Attributes:
        title: What it is: "the best game".
        words: More about it.
        page: The text of a page that plays it (see `silverball.web.page`).
    """

    title: str
    words: str
    page: str


def report_page(study: Study, command: str, games: Sequence[WatchedGame] = ()) -> str:
    """The text of a report.

    Args:
        study: The study, as far as it is done.
        command: The command that made it.
        games: Games to watch in it.
    """
    arms = study.plan.arms
    names = list(dict.fromkeys(arm.table.name for arm in arms))
    title = plain(", ".join(names[:3]))
    sections = [
        _head(study, title),
        _figures(study),
        _sweeps(study),
        _curves(study),
        *(_arm(study, number) for number in range(min(len(arms), SHOWN_ARMS))),
        _games(games),
        _origin(study, command),
    ]
    template = (FOLDER / "study_report.html").read_text(encoding="utf-8")
    parts = {
        "TITLE": escape(title),
        "STYLE": (FOLDER / "study_report.css").read_text(encoding="utf-8"),
        "BODY": "\n".join(sections),
        "SCRIPT": (FOLDER / "study_report.js").read_text(encoding="utf-8") if games else "",
    }
    return PLACE.sub(lambda found: parts[found[1]], template)


def _head(study: Study, title: str) -> str:
    plan, first = study.plan, study.arms[0]
    figures = first.figures()
    players = plain(", ".join(dict.fromkeys(arm.player for arm in plan.arms)))
    about = f"{plan.games:,} games each" if len(plan.arms) > 1 else f"{plan.games:,} games"
    big = "".join(
        f"<li><b>{escape(value)}</b><span>{escape(ROWS[key][0])}</span><small>{escape(half)}</small></li>"
        for key in ("seconds_per_ball", "points_per_minute", "median_score")
        for value, half in [in_words(figures[key], ROWS[key][1])]
    )
    label = f" of {plain(plan.arms[0].label)}" if len(plan.arms) > 1 else ""
    of_first = f'<p class="note">{escape(plain(plan.arms[0].label))}:</p>' if label else ""
    return (
        f'<header><p class="kind">A study of</p><h1>{escape(title)}</h1>'
        f"<p>{escape(about)} by {escape(players)}, seeds {plan.seed:,} to {plan.seed + plan.games - 1:,}. "
        f"Every interval holds the true value with 95&nbsp;%.</p>"
        f'{of_first}<ul class="big" aria-label="Main figures{escape(label)}">{big}</ul></header>'
    )


def _figures(study: Study) -> str:
    """The table of all figures, and the table drawn."""
    arms = list(zip(study.plan.arms, study.arms, strict=True))[:SHOWN_ARMS]
    head = "".join(f"<th>{escape(plain(arm.label))}</th>" for arm, _ in arms)
    figures = [summary.figures() for _, summary in arms]
    body = "".join(
        f'<tr><th scope="row">{escape(words)}</th>'
        + "".join(f"<td>{_cell(one[key], form)}</td>" for one in figures)
        + "</tr>"
        for key, (words, form) in ROWS.items()
    )
    drawing = TableMap(study.plan.arms[0].table).draw("The table")
    random = study.plan.arms[0].table.random
    note = "<p class=note>A recipe: every game has random parts that are not drawn.</p>" if random else ""
    return (
        '<section class="two"><div><h2>Figures</h2><div class="scroll"><table class="figures"><thead><tr>'
        f"<td></td>{head}</tr></thead><tbody>{body}</tbody></table></div></div>"
        f"<figure>{drawing}{note}</figure></section>"
    )


def _curves(study: Study) -> str:
    """How long balls live, and what games score."""
    arms = list(zip(study.plan.arms, study.arms, strict=True))[:SERIES]
    lives = [(plain(arm.label), summary.survival()) for arm, summary in arms]
    longest = max((_last_of(one.alive, one.moments) for _, one in lives), default=1.0)
    series = []
    for label, one in lives:
        keep = np.unique(np.linspace(0, max(len(one.moments) - 1, 0), CURVE_POINTS).astype(int))
        keep = keep[one.moments[keep] <= longest * 1.02] if len(one.moments) else keep[:0]
        x = [0.0, *one.moments[keep].tolist()]
        columns = ([1.0, *curve[keep].tolist()] for curve in (one.alive, one.low, one.high))
        series.append(Curve(label, x, *columns))
    x_axis = Axis("seconds in play", 0.0, longest, charts.number)
    y_axis = Axis("share of balls", 0.0, 1.0, lambda value: f"{value:.0%}")
    survival = charts.curves("Share of balls that live on", x_axis, y_axis, series, is_stepped=True)
    return (
        '<section class="pair"><figure><h2>How long a ball lives</h2>'
        f"{survival}<figcaption>The share of balls still in play after each time, by Kaplan and Meier; "
        "games that were cut short count as far as they were seen.</figcaption></figure>"
        f"<figure><h2>What a game scores</h2>{_scores(arms)}<figcaption>The share of games by their score, "
        "on a logarithmic scale.</figcaption></figure></section>"
    )


def _scores(arms: Sequence[tuple[object, ArmSummary]]) -> str:
    """The distribution of the scores of games."""
    found = [
        (plain(getattr(arm, "label", "")), summary.scores.even_bars(SCORE_BARS)) for arm, summary in arms
    ]
    tops = [edge for _, (edges, _) in found for edge in edges]
    if not tops:
        return '<p class="none">no game has scored</p>'
    series, most = [], 0.0
    for label, (edges, shares) in found:
        most = max(most, *shares, 0.0)
        series.append(Curve(label, edges, [0.0, *shares]))
    x_axis = Axis("points", min(tops), max(tops), charts.number, is_log=True)
    y_axis = Axis("share of games", 0.0, most * 1.1, lambda value: f"{value:.1%}")
    return charts.curves("Share of games by score", x_axis, y_axis, series, is_stepped=True)


def _sweeps(study: Study) -> str:
    """What a swept number does, and the differences from the first arm."""
    arms = study.plan.arms
    if len(arms) < 2:
        return ""
    head = "".join(f"<th>{escape(ROWS[key][0])}</th>" for key in COMPARED)
    rows = "".join(
        f'<tr><th scope="row">{escape(plain(arm.label))}</th>'
        + "".join(f"<td>{_cell(study.difference(number, key), ROWS[key][1])}</td>" for key in COMPARED)
        + "</tr>"
        for number, arm in enumerate(arms)
        if number
    )
    drawn = "".join(_sweep_chart(study, key) for key in COMPARED[:2])
    return (
        f'<section><h2>Compared</h2><div class="pair">{drawn}</div><div class="scroll">'
        f'<table class="figures"><thead><tr><td>minus {escape(plain(arms[0].label))}</td>{head}</tr></thead>'
        f"<tbody>{rows}</tbody></table></div><p class=note>All play the same seeds. An interval without 0 "
        "is a difference that is not by chance.</p></section>"
    )


def _sweep_chart(study: Study, key: str) -> str:
    """A figure against the only number that is swept; nothing for other comparisons."""
    arms = study.plan.arms
    if any(len(arm.change) != 1 for arm in arms):
        return ""
    series: dict[str, list[tuple[float, Estimate]]] = {}
    for arm, summary in zip(arms, study.arms, strict=True):
        path, value = arm.change[0]
        name = plain(arm.label.removesuffix(f"{path}={value:g}").rstrip(", "))
        series.setdefault(name, []).append((float(value), summary.figures()[key]))
    values = [place for points in series.values() for place, _ in points]
    found = [one for points in series.values() for _, one in points if math.isfinite(one.value)]
    if not found:
        return ""
    low, high = min(0.0, *(one.low for one in found)), max(one.high for one in found)
    span = max(values) - min(values)
    x_axis = Axis(
        plain(arms[0].change[0][0]), min(values) - 0.05 * span, max(values) + 0.05 * span, charts.number
    )
    y_axis = Axis(ROWS[key][0], low, high * 1.05, charts.number)
    drawn = charts.whiskers(f"{ROWS[key][0]} by value", x_axis, y_axis, list(series.items())[:SERIES])
    return f"<figure><h3>{escape(ROWS[key][0])}</h3>{drawn}</figure>"


def _arm(study: Study, number: int) -> str:
    """The maps and lists of an arm; those of the first one are open."""
    arm, summary = study.plan.arms[number], study.arms[number]
    if summary.games == 0:
        return ""
    board, names = TableMap(arm.table), part_titles(arm.table)
    stay = summary.stay
    seconds = f"{stay.seconds:.1f} s"
    ring = board.ring(stay.x, stay.z, f"{seconds}, seed {stay.seed}")
    maps = (
        ("Where balls are", board.heat(summary.sums["sum.place"].astype(float)), "",
         "Bright where they spend most time; what stays dark is dead."),
        ("How fast", board.heat(summary.mean_speed()), "", "Their mean speed: bright is fast."),
        ("Shots", board.heat(summary.sums["sum.shots"].astype(float)), "",
         "Balls that a paddle has struck, until they meet something."),
        ("Stays", board.heat(summary.stays / TICK_RATE), ring,
         f"The longest stay that began in each place; the longest of all, in the ring: {seconds}."),
    )  # fmt: skip
    drawn = "".join(
        f"<figure><h3>{title}</h3>{board.draw(title, below, above)}"
        f"<figcaption>{escape(words)}</figcaption></figure>"
        for title, below, above, words in maps
    )
    body = (
        f'<div class="maps">{drawn}</div>{_fairness(summary, arm.table.board.width)}'
        f'<div class="pair">{_lists(summary, names)}</div>'
    )
    if len(study.plan.arms) == 1:
        return f"<section><h2>On the table</h2>{body}</section>"
    opened = " open" if number == 0 else ""
    return (
        f"<section><details{opened}><summary>On the table: {escape(plain(arm.label))}</summary>{body}"
        "</details></section>"
    )


def _fairness(summary: ArmSummary, width: float) -> str:
    """Where balls are lost, and whether left and right are alike."""
    drains = summary.sums["sum.drains"].reshape(DRAIN_BARS, -1).sum(axis=1)
    total = int(drains.sum())
    if not total:
        return '<p class="none">no ball was lost</p>'
    shares = [share(int(count), total) for count in drains.tolist()]
    edges = [width * (number / DRAIN_BARS - 0.5) for number in range(DRAIN_BARS + 1)]
    most = max(one.high for one in shares)
    chart = charts.bars(
        "Where balls are lost",
        Axis("across the table [u], left to right", edges[0], edges[-1], charts.number),
        edges,
        shares,
        Axis("share", 0.0, most, lambda value: f"{value:.0%}"),
    )
    figures = summary.figures()
    halves = [
        (words, figures[key], on_one_line(figures[key], "{:.1%}"))
        for key, words in (
            ("share_lost_left", "balls lost on the left"),
            ("share_time_left", "time on the left"),
        )
        if math.isfinite(figures[key].value)
    ]
    return (
        f'<div class="pair"><figure><h3>Where balls are lost</h3>{chart}</figure>'
        f"<figure><h3>Left and right</h3>{charts.rows('Left and right', halves, 0.5, most=1.0)}"
        "<figcaption>The line is one half: a table that is its own mirror image has both there."
        "</figcaption></figure></div>"
    )


def _lists(summary: ArmSummary, names: Mapping[str, str]) -> str:
    """What is hit, what struck balls meet, what makes points, and what is never hit."""
    hits = sorted(summary.hits(), key=lambda row: -row.total)
    never = [names.get(row.name, row.name) for row in hits if row.total == 0]
    causes, met = summary.causes_of_points(), summary.first_met()
    blocks = [
        ("Hits of parts", _rows(hits[:SHOWN_ROWS], "{:.1f}", names), "A minute in play."),
        ("What makes points", _rows(causes[:SHOWN_ROWS], "{:.1%}", {}), "Share of all points."),
        ("What shots meet first", _rows(met[:SHOWN_ROWS], "{:.1%}", names),
         "Share of the balls that a paddle has struck."),
    ]  # fmt: skip
    found = "".join(
        f"<figure><h3>{title}</h3>{drawn}<figcaption>{words}</figcaption></figure>"
        for title, drawn, words in blocks
    )
    listed = ", ".join(escape(plain(name)) for name in never) or "nothing: every part was hit"
    return found + f'<figure><h3>Never hit</h3><p class="never">{listed}</p></figure>'


def part_titles(table: Table) -> dict[str, str]:
    """What the report calls each part: its name in the file, if it has one, and its place."""
    bare = table.model_copy(update={"random": None})
    return {
        one.name: f"{name} ({one.name})"
        for one in expand(bare).parts
        if (name := getattr(one.part, "name", "")) and one.kind != "board"
    }


def _rows(items: Sequence[Row], form: str, names: Mapping[str, str]) -> str:
    listed = [
        (plain(names.get(row.name, row.name)), row.figure,
         on_one_line(row.figure, form))
        for row in items
    ]  # fmt: skip
    return charts.rows("", listed)


def _games(games: Sequence[WatchedGame]) -> str:
    """Games to watch: each is a page of its own that opens in a frame."""
    if not games:
        return ""
    cards = "".join(
        f'<button type="button" data-game="{number}"><b>{escape(plain(one.title))}</b>'
        f"<span>{escape(plain(one.words))}</span></button>"
        for number, one in enumerate(games)
    )
    data = "".join(
        f'<script type="application/json" id="game-{number}">{_embedded(one.page)}</script>'
        for number, one in enumerate(games)
    )
    return (
        f'<section><h2>Games to watch</h2><div class="cards">{cards}</div>'
        f'<div id="stage" hidden></div>{data}</section>'
    )


def _embedded(text: str) -> str:
    """A text as JSON that may stand in a script element."""
    return json.dumps(text).replace("<", "\\u003c")


def _origin(study: Study, command: str) -> str:
    """How the study was made, and how to make it again."""
    import numba

    from silverball import __version__
    from silverball.physics import PHYSICS_VERSION

    digests = {plain(arm.table.name): table_digest(arm.table) for arm in study.plan.arms}
    lines = [
        ("command", plain(command)),
        *((f"table {name}", digest) for name, digest in digests.items()),
        ("plan", study.plan.digest()),
        ("code", str(study.plan.as_dict()["code"])),
        ("silverball", f"{__version__}, physics {PHYSICS_VERSION}"),
        ("python", f"{platform.python_version()}, numpy {np.__version__}, numba {numba.__version__}"),
    ]
    items = "".join(f"<dt>{escape(name)}</dt><dd><code>{escape(words)}</code></dd>" for name, words in lines)
    return (
        f"<section><h2>How it was made</h2><dl>{items}</dl><p class=note>The same command gives the same "
        "figures, bit for bit, on any machine.</p></section>"
    )


def _last_of(alive: NDArray[Any], moments: NDArray[Any]) -> float:
    """Until when a curve is worth drawing: one in a hundred balls is still in play."""
    if len(moments) == 0:
        return 1.0
    place = int(np.searchsorted(-alive, -0.01))
    return max(float(moments[min(place, len(moments) - 1)]), 1.0)


def _cell(one: Estimate, form: str) -> str:
    value, half = in_words(one, form)
    return f"{escape(value)} <small>{escape(half)}</small>"
