"""Folders of studies: stopped at any moment, they go on and come to the same bytes."""

from __future__ import annotations

import errno
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from patience import PATIENCE
from silverball.errors import OutputError, StateError
from silverball.studies.result_folder import ResultFolder
from silverball.studies.study import Study
from silverball.studies.study_plan import Plan, arms_of
from silverball.table import load_table

TESTS = Path(__file__).parents[2]
PLAN = Plan(arms_of([("classic", load_table("classic"))], ["idle"]), games=20, chunk_games=10, longest=5.0)


def stop(folder: Path, moments: int, seed: int) -> str:
    """What `stopped_study.py` says."""
    script = [sys.executable, str(TESTS / "stopped_study.py"), str(folder), str(moments), str(seed)]
    return subprocess.run(script, capture_output=True, text=True, check=True, timeout=PATIENCE).stdout


@pytest.mark.skipif(not hasattr(os, "fork"), reason="forks a process for each interruption")
def test_a_study_that_is_stopped_and_goes_on_has_the_same_bytes(tmp_path):
    assert stop(tmp_path, 3, 1).split()[-1] == "same"


@pytest.mark.slow
@pytest.mark.skipif(not hasattr(os, "fork"), reason="forks a process for each interruption")
def test_a_study_that_is_stopped_at_twenty_moments_has_the_same_bytes(tmp_path):
    assert stop(tmp_path, 20, 2).split()[-1] == "same"


def test_the_folder_of_another_study_is_refused(tmp_path):
    ResultFolder(tmp_path / "study", PLAN)
    with pytest.raises(StateError, match="begun with other games; give the same command"):
        ResultFolder(tmp_path / "study", PLAN._replace(games=30))
    with pytest.raises(StateError, match="other tables or players"):
        ResultFolder(tmp_path / "study", PLAN._replace(arms=PLAN.arms[:0]))


@pytest.mark.parametrize("text", ["", "{", "[]", "null", '"\x1b"', "{" * 100_000])
def test_a_plan_that_is_none_is_told(tmp_path, text: str):
    (tmp_path / "plan.json").write_text(text)
    with pytest.raises(StateError, match="give another --out") as caught:
        ResultFolder(tmp_path, PLAN)
    assert "\n" not in str(caught.value)


def test_chunks_without_a_plan_are_not_taken_for_results(tmp_path):
    (tmp_path / "chunks").mkdir()
    (tmp_path / "chunks" / "000000.npz").write_bytes(b"")
    with pytest.raises(StateError, match="chunks without a plan"):
        ResultFolder(tmp_path, PLAN)


@pytest.mark.parametrize("size", [0, 100, 3000])
def test_a_damaged_chunk_is_told(tmp_path, size: int):
    Study(PLAN, tmp_path).run()
    path = tmp_path / "chunks" / "000001.npz"
    path.write_bytes(path.read_bytes()[:size])
    with pytest.raises(StateError, match="not a whole chunk of a study: remove it"):
        Study(PLAN, tmp_path)
    path.unlink()
    study = Study(PLAN, tmp_path)
    study.run()
    assert study.is_done


def test_a_full_disk_loses_nothing(tmp_path, monkeypatch):
    def full(place: Path, **arrays: object) -> None:
        Path(place).write_bytes(b"half a chunk")
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    folder = tmp_path / "study"
    with monkeypatch.context() as patched:
        patched.setattr(np, "savez_compressed", full)
        with pytest.raises(OutputError, match=r"No space left on device.*; what is done stays"):
            Study(PLAN, folder).run()
    assert [path.name for path in folder.rglob("*") if path.is_file()] == ["plan.json"]
    study = Study(PLAN, folder)
    study.run()
    assert study.is_done


def test_a_folder_that_cannot_be_made_is_told(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(OutputError, match="cannot be written"):
        ResultFolder(tmp_path / "file" / "study", PLAN)
