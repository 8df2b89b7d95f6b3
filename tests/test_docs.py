"""Do the documents tell the truth? Every command and example in them is tried."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any, NamedTuple

import pytest
from PIL import Image

import silverball
from rule_tables import with_rules
from silverball.cli.app import main_command
from silverball.game.game import Game
from silverball.table import check_table, parse_table, table_digest
from silverball.table.table import PART_KINDS

ROOT = Path(__file__).parent.parent
README = (ROOT / "README.md").read_text(encoding="utf-8")
MACHINE = ROOT / "docs" / "tutorials" / "machine.md"
DOCUMENTS = sorted([*ROOT.glob("*.md"), *ROOT.glob("docs/**/*.md")])


def test_readme_names_every_command():
    commands = main_command().commands
    assert [name for name in commands if f"silverball {name}" not in README] == []


def test_the_citation_names_the_version_of_the_package():
    citation = (ROOT / "CITATION.cff").read_text(encoding="utf-8")
    assert re.search(r"^version: (.+)$", citation, re.MULTILINE)[1] == silverball.__version__


def test_readme_prints_the_two_commands():
    start = "python3 -m venv .venv && .venv/bin/pip install "
    assert f"    {start}. && .venv/bin/silverball\n" in README
    assert f"    {start}-e '.[test]' && .venv/bin/pytest\n" in README


class Example(NamedTuple):
    """A block of a document, and the block right after it that shows what it prints, if there is one."""

    document: Path
    text: str
    shown: str


def examples(language: str) -> list[Example]:
    """All blocks of a language, in all documents."""
    block = re.compile(
        rf"^```{language}\n(.*?)^```\n(?:\nprints\n\n```text\n(.*?)^```\n)?", re.DOTALL | re.MULTILINE
    )
    return [
        Example(document, text, shown)
        for document in DOCUMENTS
        for text, shown in block.findall(document.read_text(encoding="utf-8"))
    ]


def name_of(example: Example) -> str:
    return example.document.name


def printed_by(example: Example, capsys) -> list[str]:
    """The lines that an example prints."""
    exec(compile(example.text, example.document.name, "exec"), {})
    return capsys.readouterr().out.splitlines()


(FIRST,) = (example for example in examples("python") if example.document.name == "README.md")


def test_the_example_in_readme_prints_hits_and_a_digest(capsys):
    printed = printed_by(FIRST, capsys)
    assert len(printed) > 2
    assert re.fullmatch(r"\d+ [0-9a-f]{12}", printed[-1])


@pytest.mark.parametrize("example", examples("python"), ids=name_of)
def test_an_example_is_short(example: Example):
    longest = 12 if example.document.name == "README.md" else 30
    assert len([line for line in example.text.splitlines() if line.strip()]) <= longest


@pytest.mark.parametrize("example", examples("python"), ids=name_of)
def test_an_example_runs_and_prints_what_stands_below_it(example: Example, capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    if example.document == MACHINE:
        Path("machine.toml").write_text("\n".join(STEPS), encoding="utf-8")
    printed = printed_by(example, capsys)
    assert printed == (example.shown.splitlines() or printed)


STEPS = [example.text for example in examples("toml") if example.document == MACHINE]
"""The blocks of this tutorial are one table file."""

FILES = [example for example in examples("toml") if example.document != MACHINE]


@pytest.mark.parametrize("example", FILES, ids=name_of)
def test_an_example_of_a_table_file_has_no_mistake(example: Example):
    """A whole file is of format 1 unless it says otherwise; what begins with a part may be a piece of any.

    Rules are for a table that has none of its own.
    """
    if "\nformat = " in example.text:
        table = parse_table(example.text, example.document.name)
    elif example.document.name == "rules.md":
        table = with_rules(example.text)
    else:
        version = 2 if example.text.startswith("[[") else 1
        table = parse_table(f"format = {version}\n{example.text}", example.document.name)
    assert silverball.check_table(table) == []


@pytest.mark.parametrize("count", range(1, len(STEPS) + 1))
def test_the_check_has_no_complaint_after_any_step_of_the_tutorial(count: int):
    table = parse_table("\n".join(STEPS[:count]), MACHINE.name)
    assert silverball.check_table(table) == []


def test_the_tutorial_ends_with_levels_a_bank_and_a_plunger():
    table = parse_table("\n".join(STEPS), MACHINE.name)
    assert table.plunger
    assert table.level
    assert len({target.bank for target in table.drop_target}) == 1 < len(table.drop_target)


def script(name: str) -> dict[str, Any]:
    """What a script of the documents defines."""
    path = ROOT / "docs" / name
    names: dict[str, Any] = {"__name__": path.stem, "__file__": str(path)}
    exec(compile(path.read_text(encoding="utf-8"), path.name, "exec"), names)
    return names


@pytest.mark.parametrize("name", [*PART_KINDS, "machine"])
def test_the_picture_of_a_part_is_small_and_shows_the_example_beside_it(name: str):
    drawing = script("make_parts.py")
    path = drawing["file_of"](name)
    with Image.open(path) as picture:
        assert picture.info[drawing["DIGEST"]] == table_digest(drawing["table_of"](name)), (
            f"run: python docs/make_parts.py {name}"
        )
    assert path.stat().st_size < 100_000


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda path: path.name)
def test_every_local_link_leads_somewhere(document):
    links = re.findall(r"\]\((?!https?:)([^)#]+)\)", document.read_text(encoding="utf-8"))
    assert [link for link in links if not (document.parent / link).exists()] == []


def test_every_file_and_folder_that_architecture_names_exists():
    named = re.findall(r"`([a-z_/]+(?:\.py|/))`", (ROOT / "ARCHITECTURE.md").read_text(encoding="utf-8"))
    package = ROOT / "src" / "silverball"
    folders = (package, ROOT / "tests")
    everything = {path.name for folder in folders for path in [folder, *folder.rglob("*")]}
    missing = [name for name in named if not (package / name).exists() and Path(name).name not in everything]
    assert len(named) > 10
    assert missing == []


def test_the_reference_of_the_table_file_is_what_the_models_say():
    names = script("make_reference.py")
    assert names["PAGE"].read_text(encoding="utf-8") == names["page"](), "run: python docs/make_reference.py"


def test_the_reference_of_rules_is_what_the_models_say():
    names = script("make_reference.py")
    assert names["RULES_PAGE"].read_text(encoding="utf-8") == names["rules_page"](), (
        "run: python docs/make_reference.py"
    )


@pytest.mark.parametrize("path", sorted((ROOT / "docs" / "rules").glob("*.toml")), ids=lambda path: path.stem)
def test_every_example_of_rules_can_be_played_and_has_no_problems(path):
    table = with_rules(path.read_text(encoding="utf-8"))
    assert check_table(table) == []
    game = Game(table, 1)
    game.create_ball()
    game.step(ticks=100, launch=True)
    game.step(ticks=400)
    assert game.replay.verify().ok


def test_every_file_name_and_test_that_the_page_of_the_original_names_exists():
    page = (ROOT / "docs" / "original.md").read_text(encoding="utf-8")
    files = set(re.findall(r"`((?:src|tests|docs)/[\w/.]+)", page))
    assert [name for name in files if not (ROOT / name).is_file()] == []
    tests = set(re.findall(r"`(tests/[\w/.]+)::(\w+)`", page))
    assert len(files) > 20
    assert len(tests) > 30
    gone = [name for file, name in tests if f"\ndef {name}(" not in (ROOT / file).read_text(encoding="utf-8")]
    assert gone == []


def test_every_word_of_the_code_that_the_page_of_the_original_puts_beside_a_file_is_in_it():
    page = (ROOT / "docs" / "original.md").read_text(encoding="utf-8")
    beside = re.findall(r"`(src/[\w/.]+\.py)` \((`\w[^)]*)\)", page)
    named = [(file, word) for file, words in beside for word in re.findall(r"`([\w.]+)`", words)]
    assert len(named) > 10
    code = {file: (ROOT / file).read_text(encoding="utf-8") for file, _ in named}
    gone = [
        (file, word)
        for file, word in named
        if not re.search(rf"^\s*(def|class) {word.rpartition('.')[2]}\b", code[file], re.MULTILINE)
    ]
    assert gone == []


def test_the_pictures_of_the_original_are_small():
    pictures = sorted((ROOT / "docs").glob("original*.png"))
    assert len(pictures) == 3
    assert all(picture.stat().st_size < 300_000 for picture in pictures)
