"""The result of the benchmark as a terminal table, in Markdown, and as one JSON object.

Each of Silverball's rates is compared with each baseline. A baseline that observes states is compared only
with states; one that observes pictures is compared with both, since agents can learn pinball from either.
"""

from __future__ import annotations

import json
from typing import Any

from silverball.benchmarks.envs.measure import Rate, Result


def yardsticks(result: Result) -> list[Rate]:
    """The baselines."""
    return [rate for rate in result.rates if rate.yardstick]


def ratio(rate: Rate, yardstick: Rate) -> float | None:
    """The ratio of two rates; None if they are not comparable."""
    if not (rate.ours or rate is yardstick) or not rate.sees:
        return None
    if yardstick.sees == "state" and rate.sees != "state":
        return None
    return rate.value / yardstick.value


def cells(rate: Rate, measures: list[Rate]) -> list[str]:
    """The formatted cells of a row."""
    value = f"{rate.value:,.0f}" if rate.unit == "steps/s" else f"{rate.value:.3f} {rate.unit}"
    return [rate.name, value, *(_times(ratio(rate, measure)) for measure in measures)]


def _times(value: float | None) -> str:
    if value is None:
        return ""
    return f"{value:,.0f} ×" if value >= 10.0 else f"{value:.2f} ×"


def headers(measures: list[Rate]) -> list[str]:
    """The headers of the columns."""
    return ["environment", "steps/s", *(f"beside {measure.yardstick}" for measure in measures)]


def footer(result: Result) -> list[str]:
    """Rounds, machine, versions and missing packages, one sentence each."""
    versions = ", ".join(f"{name} {version}" for name, version in result.versions.items())
    rounds = f"Medians of {result.rounds} rounds" if result.rounds > 1 else "One round"
    lines = [f"{rounds}, random actions; {result.machine}; {versions}."]
    if result.missing:
        lines.append(f"Not installed: {', '.join(result.missing)}.")
    return lines


def terminal_table(result: Result) -> Any:
    """The result as a rich table."""
    from rich.table import Table

    measures = yardsticks(result)
    table = Table(title="Environments")
    for index, header in enumerate(headers(measures)):
        table.add_column(header, justify="right" if index else "left", no_wrap=index == 0)
    was_ours = True
    for rate in result.rates:
        if was_ours and not rate.ours:
            table.add_section()
        was_ours = rate.ours
        table.add_row(*cells(rate, measures))
    return table


def markdown(result: Result) -> str:
    """The table in Markdown, with a footer."""
    measures = yardsticks(result)
    lines = [headers(measures), ["---"] + ["---:"] * (1 + len(measures))]
    lines += [cells(rate, measures) for rate in result.rates]
    rows = ["| " + " | ".join(line) + " |" for line in lines]
    return "\n".join([*rows, "", *footer(result), ""])


def as_json(result: Result) -> str:
    """The result as JSON, with ratios by the names of the baselines."""
    measures = yardsticks(result)
    rates = [
        {**rate._asdict(), "beside": {one.yardstick: ratio(rate, one) for one in measures}}
        for rate in result.rates
    ]
    return json.dumps({**result._asdict(), "rates": rates}, indent=2)
