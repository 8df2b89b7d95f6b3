"""`silverball dataset`: data sets that Minari's own reader loads, whole or not at all."""

from __future__ import annotations

import json
import signal
import time

import numpy as np
import pytest

from commandline import started
from silverball.export.episodes import Recording

minari = pytest.importorskip("minari")
pytest.importorskip("h5py")

CLASSIC = "silverball/PinballClassic-v0"
FEW = [
    "dataset", CLASSIC, "--episodes", "5", "--seed", "7",
    "--option", "frame_skip=4", "--option", "time_limit=3",
]  # fmt: skip
NAME = f"{CLASSIC}/reflex-v0"


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    monkeypatch.setenv("MINARI_DATASETS_PATH", str(tmp_path))
    return tmp_path


def test_minari_loads_the_episodes_of_the_player(silverball, folder):
    made = silverball(*FEW, "--infos")
    assert made.returncode == 0, made.stderr
    assert f"minari.load_dataset('{NAME}')" in made.stdout
    data = minari.load_dataset(NAME)
    recording = Recording(CLASSIC, {"frame_skip": 4, "time_limit": 3}, "reflex", 7)
    for stored, played in zip(data, recording.episodes(5), strict=True):
        assert (stored.observations == played.observations).all()
        assert (stored.actions == played.actions).all()
        assert (stored.rewards == played.rewards).all()
        assert (stored.terminations == played.terminated).all()
        assert (stored.truncations == played.truncated).all()
        assert (stored.infos["score"] == played.counts["score"]).all()
    assert [one["seed"] for one in data.storage.get_episode_metadata(range(5))] == [7, 8, 9, 10, 11]
    assert list(minari.list_local_datasets()) == [NAME]
    env = data.recover_environment()
    assert env.unwrapped.options.frame_skip == 4
    assert env.observation_space == data.observation_space


def test_its_metadata_hold_the_command_that_makes_the_same_data_again(silverball, folder):
    report = json.loads(silverball(*FEW, "--json").stdout)
    described = minari.load_dataset(NAME).storage.metadata["silverball"]
    assert described["digest"] == report["digest"]
    assert (described["player"], described["seed"], len(described["tables"])) == ("reflex", 7, 1)
    command, *arguments = described["command"].split()
    assert command == "silverball"
    again = silverball(*arguments, "--force", "--json")
    assert json.loads(again.stdout)["digest"] == report["digest"]
    other = silverball(*arguments, "--force", "--json", "--player", "random")
    assert json.loads(other.stdout)["digest"] != report["digest"]


def test_pictures_are_kept_as_they_are(silverball):
    options = ["--option", "observation=pixels", "--option", "stack=1", "--option", "time_limit=1"]
    assert silverball("dataset", "--episodes", "1", *options).returncode == 0
    (episode,) = minari.load_dataset(NAME)
    assert episode.observations.shape == (len(episode.rewards) + 1, 84, 84)
    recording = Recording(CLASSIC, {"observation": "pixels", "stack": 1, "time_limit": 1}, "reflex", 0)
    (played,) = recording.episodes(1)
    assert np.array_equal(episode.observations, played.observations)


def test_a_data_set_is_replaced_only_if_asked(silverball, folder):
    assert silverball(*FEW).returncode == 0
    before = {path: path.stat().st_mtime_ns for path in folder.rglob("*") if path.is_file()}
    refused = silverball(*FEW)
    assert (refused.returncode, refused.stdout) == (2, "")
    assert "this data set exists" in refused.stderr
    assert {path: path.stat().st_mtime_ns for path in folder.rglob("*") if path.is_file()} == before
    assert silverball(*FEW, "--force").returncode == 0
    assert sorted(path.name for path in (folder / CLASSIC).iterdir()) == ["reflex-v0"]


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGKILL])
def test_an_interrupted_data_set_is_none(silverball, folder, number):
    long = started("dataset", CLASSIC, "--episodes", "100000", "--option", "time_limit=1", "--seed", "1")
    hidden = folder / CLASSIC / ".reflex-v0.unfinished"
    try:
        deadline = time.monotonic() + 60
        while not (hidden / "data" / "main_data.hdf5").exists() and time.monotonic() < deadline:
            time.sleep(0.05)
        time.sleep(0.3)
        busy = silverball(*FEW)
        assert busy.returncode == 2
        assert "another process is writing this data set" in busy.stderr
        long.send_signal(number)
        long.wait(30)
    finally:
        long.kill()
    assert not (folder / NAME).exists()
    assert minari.list_local_datasets() == {}
    assert hidden.exists() == (number == signal.SIGKILL)
    assert silverball(*FEW).returncode == 0
    assert list(minari.list_local_datasets()) == [NAME]
    assert not hidden.exists()


def test_a_folder_that_cannot_hold_it_is_named_in_a_sentence(silverball, folder):
    (folder / "full").write_text("a file")
    for arguments, words in (
        (["--folder", str(folder / "full")], "cannot be written"),
        (["--name", "no version"], "must be letters, digits"),
        (["--name", "../x-v0"], "must be letters, digits"),
        (["--option", "frame_skip"], "--option must be KEY=VALUE"),
        (["--option", "frame_skip=4"], "is given twice"),
        (["--player", "nobody"], "no player is called"),
    ):
        made = silverball(*FEW, *arguments)
        assert made.returncode == 2
        assert words in made.stderr
        assert len(made.stderr.splitlines()) == 1
    (folder / "something-v0").mkdir()
    made = silverball(*FEW, "--name", "something-v0", "--force")
    assert "something else than a data set" in made.stderr


def test_a_full_disk_leaves_nothing(silverball, folder, monkeypatch):
    from minari.dataset._storages.hdf5_storage import HDF5Storage

    def full(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(HDF5Storage, "update_episodes", full)
    made = silverball(*FEW)
    assert made.returncode == 2
    assert "No space left on device" in made.stderr
    assert [path for path in folder.rglob("*") if path.is_file()] == []
