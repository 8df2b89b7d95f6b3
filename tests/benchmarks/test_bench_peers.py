"""`silverball bench peers`: its output, its files, its error messages, and a missing peer."""

from __future__ import annotations

import importlib.machinery
import importlib.util
import json

import pytest

from silverball.benchmarks.peers import comparison, engines, report
from silverball.benchmarks.peers.accuracy import BOUNCES
from silverball.cli.app import run
from silverball.table import load_table

ERRORS = [1e-15, 1e-14, 1e-14, 1e-13]


def made_up_row(name: str, frames: float, errors: list[float], depth: float) -> comparison.Row:
    batch, world = [8e6, 9e6, 1e7], [4e5, 4e5, 4e5]
    return comparison.row(
        name, "1/60", [frames] * 3, batch, world, comparison.Penetration(1000, 3, depth), errors, 1e-3
    )


@pytest.fixture
def result() -> comparison.Result:
    rows = [
        made_up_row(engines.BATCH, 9e6, ERRORS, 0.0),
        made_up_row(engines.SILVERBALL, 4e5, ERRORS, 0.0),
        made_up_row("pymunk", 1e5, [1e-3, 1e-2, 1e-1, 1.0], 0.25),
        made_up_row("Box2D v3", 2e5, [1e-4, 1e-1, 1.0, 2.0], 0.031),
    ]
    return comparison.Result(rows, comparison.Plan(rounds=3), 1.9, 0.25, "a machine", {"Python": "3.14"})


def without(monkeypatch, *names: str) -> None:
    find = importlib.util.find_spec
    monkeypatch.setattr(engines.util, "find_spec", lambda name: None if name in names else find(name))


def test_ratios_are_medians_of_the_rounds(result):
    assert result.rows[2].batch_ratio == 9e6 / 1e5
    assert result.rows[2].world_ratio == 4.0


def test_digits_ahead_compare_with_the_best_peer(result):
    assert comparison.digits_ahead(result) == pytest.approx([11, 12, 13, 13])


def test_the_markdown_table_has_a_row_for_every_engine_and_names_machine_and_versions(result):
    page = report.markdown(result)
    rows = [line for line in page.splitlines() if line.startswith("|")]
    assert len(rows) == 2 + len(result.rows)
    assert len({line.count("|") for line in rows}) == 1
    assert "| pymunk | 1/60 | 100 k | 90 × | 4 × | 3 in 1,000 | ≥ 0.25 |" in page
    assert "a machine; Python 3.14" in page


def test_the_json_object_holds_every_figure(result):
    told = json.loads(report.as_json(result))
    assert [row["engine"] for row in told["rows"]] == [row.engine for row in result.rows]
    assert told["rows"][0]["errors"] == ERRORS
    assert told["plan"]["rounds"] == 3


def test_progress_is_reported_as_often_as_announced():
    plan = comparison.Plan(4, 2, 0.01, 1, 2, 10, 1, 10)
    said: list[str] = []
    result = comparison.run(load_table("classic"), plan, [], said.append)
    assert len(said) == comparison.units(plan, [])
    assert [row.engine for row in result.rows] == [engines.BATCH, *[engines.SILVERBALL] * 2]
    assert all(row.escapes == 0 and row.deepest <= 1e-9 for row in result.rows)
    assert all(len(row.errors) == len(BOUNCES) and max(row.errors) < 1e-11 for row in result.rows)


def test_help_shows_an_example_of_the_comparison(capsys):
    assert run(["bench", "peers", "--help"]) == 0
    assert "silverball bench peers --out" in " ".join(capsys.readouterr().out.split())


def test_a_missing_peer_is_named_with_the_remedy_and_the_others_play_on(
    monkeypatch, capsys, tmp_path, result
):
    played = []

    def run_instead(recipe, plan, peers, advance):
        played.extend(engine.name for engine in peers)
        return result

    monkeypatch.setattr(
        engines.util, "find_spec", lambda name: None if name == "pymunk" else importlib.machinery
    )
    monkeypatch.setattr(comparison, "run", run_instead)
    monkeypatch.setattr(comparison, "units", lambda plan, peers: 1)
    page = tmp_path / "peers.md"
    assert run(["bench", "peers", "--out", str(page)]) == 0
    printed = capsys.readouterr()
    assert "pymunk is not installed: pip install 'silverball[bench]'" in printed.err
    assert played == ["Box2D v3", "Box2D 2.3"]
    assert "Against pymunk, a batch is faster by 90 × at 1/60" in printed.out
    assert page.read_text(encoding="utf-8") == report.markdown(result)


def test_without_any_peer_the_command_ends_with_2_and_names_all(monkeypatch, capsys):
    without(monkeypatch, *(peer.imported for peer in engines.PEERS))
    assert run(["bench", "peers", "--quick"]) == 2
    said = capsys.readouterr().err
    for peer in engines.PEERS:
        assert f"{peer.package} is not installed: pip install 'silverball[bench]'" in said
    assert "Traceback" not in said


def test_without_mpmath_the_command_ends_with_2(monkeypatch, capsys):
    monkeypatch.setattr(
        engines.util, "find_spec", lambda name: None if name == "mpmath" else importlib.machinery
    )
    assert run(["bench", "peers", "--quick"]) == 2
    assert "mpmath is not installed" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("arguments", "word"),
    [
        ("step --quick", "--quick"),
        ("step --out a.md", "--out"),
        ("step --worlds 1000000 --frames 10000", "300,000,000"),
        ("peers --threads 2", "--threads"),
        ("peers --out a.gif", ".png or .md"),
        ("peers --out nowhere/a.md", "nowhere"),
        ("peers --table clasic", "classic"),
        ("envs --out a.png", ".md"),
        ("planner --table clasic", "classic"),
    ],
)
def test_what_does_not_fit_together_is_refused_in_words(arguments, word, capsys):
    assert run(["bench", *arguments.split()]) == 2
    assert word in capsys.readouterr().err


def test_the_plot_is_a_picture(result, tmp_path):
    pytest.importorskip("matplotlib")
    report.draw_plot(result, tmp_path / "peers.png")
    assert (tmp_path / "peers.png").read_bytes().startswith(b"\x89PNG")


@pytest.mark.slow
def test_a_quick_comparison_writes_its_table_and_shows_silverball_ahead(tmp_path, capsys):
    if not any(peer.is_installed for peer in engines.PEERS):
        pytest.skip("no peer is installed: pip install 'silverball[bench]'")
    page = tmp_path / "peers.md"
    assert run(["bench", "peers", "--quick", "--json", "--out", str(page)]) == 0
    told = json.loads(capsys.readouterr().out)
    assert min(told["orders_ahead"]) >= 9
    assert page.read_text(encoding="utf-8").count("\n| ") > len(told["rows"])
