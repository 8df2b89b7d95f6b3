"""Do the documents tell the truth? Every command and example in them is tried."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from silverball.cli.app import app

ROOT = Path(__file__).parent.parent
README = (ROOT / "README.md").read_text(encoding="utf-8")
DOCUMENTS = sorted([*ROOT.glob("*.md"), *ROOT.glob("docs/*.md")])


def test_readme_names_every_command():
    commands = [command.callback.__name__ for command in app.registered_commands if command.callback]
    assert [name for name in commands if f"silverball {name}" not in README] == []


def test_readme_prints_the_two_commands():
    start = "python3 -m venv .venv && .venv/bin/pip install "
    assert f"    {start}. && .venv/bin/silverball\n" in README
    assert f"    {start}-e '.[test]' && .venv/bin/pytest\n" in README


@pytest.mark.parametrize("example", re.findall(r"```python\n(.*?)```", README, re.DOTALL))
def test_the_example_in_readme_runs_and_scores(example, capsys):
    assert len([line for line in example.splitlines() if line.strip()]) <= 12
    exec(compile(example, "README.md", "exec"), {})
    printed = capsys.readouterr().out.splitlines()
    assert len(printed) > 2
    assert re.fullmatch(r"\d+ [0-9a-f]{12}", printed[-1])


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda path: path.name)
def test_every_local_link_leads_somewhere(document):
    links = re.findall(r"\]\((?!https?:)([^)#]+)\)", document.read_text(encoding="utf-8"))
    assert [link for link in links if not (document.parent / link).exists()] == []


def test_every_file_and_folder_that_architecture_names_exists():
    named = re.findall(r"`([a-z_/]+(?:\.py|/))`", (ROOT / "ARCHITECTURE.md").read_text(encoding="utf-8"))
    package = ROOT / "src" / "silverball"
    everything = {path.name for path in package.rglob("*")}
    missing = [name for name in named if not (package / name).exists() and Path(name).name not in everything]
    assert len(named) > 10
    assert missing == []


def test_the_reference_of_the_table_file_is_what_the_models_say():
    script = ROOT / "docs" / "make_reference.py"
    names: dict = {"__name__": "reference", "__file__": str(script)}
    exec(compile(script.read_text(encoding="utf-8"), script.name, "exec"), names)
    assert names["PAGE"].read_text(encoding="utf-8") == names["page"](), "run: python docs/make_reference.py"
