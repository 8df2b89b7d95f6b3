"""Campaigns: findings that can be reproduced, and totals that continue from a file."""

from __future__ import annotations

import json

import pytest

from boards import full_table, table_of
from holed import Holed, Narrow, options_of
from silverball.errors import StateError
from silverball.soak import rounds as soak_module
from silverball.soak.campaign import SoakLog, code_digest, log_name, soak
from silverball.soak.checks import STUCK_AFTER, Found
from silverball.soak.finding import Finding, reproduce
from silverball.soak.rounds import Options
from silverball.table import SlantWall, parse_table

BOARD = full_table()


@pytest.mark.parametrize(("solver", "kinds"), [(Holed, {"penetration", "passage"}), (Narrow, {"fault"})])
def test_a_finding_is_recorded_and_reproduced_with_the_same_broken_solver_only(
    short_rounds, monkeypatch, tmp_path, solver, kinds
) -> None:
    path = tmp_path / "soak.json"
    with monkeypatch.context() as broken:
        broken.setattr(soak_module, "WorldBatch", solver)
        log = soak(options_of(), 1, path)
        assert sum(log.totals.found.values()) == len(log.findings) >= 2
        findings = [Finding.from_text((tmp_path / name).read_text(), name) for name in log.findings]
        assert {finding.kind for finding in findings} <= kinds
        for finding in findings:
            assert reproduce(finding) == Found[finding.kind.upper()] != Found.NOTHING
            assert len(finding.actions) <= 60 + 1
            assert parse_table(finding.table_text).name.startswith("Random")
            assert Finding.from_text(finding.to_text(), "") == finding
    assert {reproduce(finding) for finding in findings} == {Found.NOTHING}
    assert sorted(tmp_path.iterdir()) == sorted([path, *(tmp_path / name for name in log.findings)])


def test_a_stuck_ball_is_recorded_with_all_of_its_minute(monkeypatch, tmp_path) -> None:
    monkeypatch.setattr(soak_module, "ROUND_SECONDS", 74.0)
    monkeypatch.setattr(soak_module, "has_problems", lambda recipe: False)  # of the cradle
    cradle = [SlantWall(start=(-3.0, 0.0), end=(1.0, side * 4.1)) for side in (-1.0, 1.0)]
    log = soak(Options(table_of(*cradle), 0, 1, 60, False), 1, tmp_path / "soak.json")
    assert log.totals.found["stuck"] == 1  # both balls come to lie in there
    finding = Finding.from_text((tmp_path / log.findings[0]).read_text(), "")
    assert len(finding.actions) == STUCK_AFTER * 60 + 1
    assert reproduce(finding) == Found.STUCK


def test_a_changed_finding_is_refused() -> None:
    good = json.dumps({"format": 1})
    for text in ("", "[]", "{}", good, '{"format": 2}'):
        with pytest.raises(StateError, match=r"mine\.json"):
            Finding.from_text(text, "mine.json")


def test_a_soak_in_two_runs_gives_the_totals_of_one_run(short_rounds, tmp_path) -> None:
    options, one_round = options_of(), 4 * 20 * 60
    seen: list[int] = []
    whole = soak(options, 3 * one_round, tmp_path / "whole.json", seen.append)
    assert seen == sorted(seen)
    assert seen[-1] == whole.totals.frames == 3 * one_round
    parts = [soak(options, frames, tmp_path / "parts.json") for frames in (1, one_round + 1, 3 * one_round)]
    assert [part.rounds for part in parts] == [1, 2, 3]
    assert parts[-1] == whole
    assert SoakLog.from_text((tmp_path / "parts.json").read_text(), "") == whole
    before = (tmp_path / "parts.json").stat().st_mtime_ns
    assert soak(options, 1, tmp_path / "parts.json") == whole
    assert (tmp_path / "parts.json").stat().st_mtime_ns == before


@pytest.mark.parametrize("key", ["seed", "worlds", "tick_rate", "hostile", "table"])
def test_a_file_of_other_options_is_refused_and_kept(short_rounds, tmp_path, key: str) -> None:
    path = tmp_path / "soak.json"
    soak(options_of(worlds=1), 1, path)
    text = path.read_text()
    other = {
        "seed": options_of(worlds=1, seed=4),
        "worlds": options_of(worlds=2),
        "tick_rate": options_of(worlds=1, tick_rate=240),
        "hostile": options_of(worlds=1, hostile=True),
        "table": Options(BOARD, 3, 1, 60, False),
    }[key]
    named = "table" if key == "hostile" else key  # a hostile soak has no table
    with pytest.raises(StateError, match=rf"soak\.json: .* with {named} .*--progress"):
        soak(other, 1, path)
    assert path.read_text() == text
    assert log_name(other) != log_name(options_of(worlds=1))


def test_a_file_of_other_code_or_of_no_soak_is_refused(short_rounds, tmp_path) -> None:
    path = tmp_path / "soak.json"
    soak(options_of(worlds=1), 1, path)
    path.write_text(path.read_text().replace(code_digest(), "0" * 16))
    with pytest.raises(StateError, match="another version of the code"):
        soak(options_of(worlds=1), 1, path)
    for text in ("", "[]", '{"format": 1}', '{"format": 1, "totals": {"frames": "many"}}'):
        path.write_text(text)
        with pytest.raises(StateError, match=r"soak\.json"):
            soak(options_of(worlds=1), 1, path)


def test_a_soak_of_a_hopeless_solver_ends_and_writes_some_of_its_findings(
    short_rounds, monkeypatch, tmp_path
) -> None:
    monkeypatch.setattr("silverball.soak.campaign.MAX_FINDINGS", 3)
    monkeypatch.setattr("silverball.soak.campaign.MAX_FILES", 2)
    monkeypatch.setattr(soak_module, "WorldBatch", Holed)
    log = soak(options_of(worlds=6), 10**9, tmp_path / "soak.json")
    assert sum(log.totals.found.values()) >= 3
    assert len(log.findings) == 2
