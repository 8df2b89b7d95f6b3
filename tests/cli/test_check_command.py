"""`silverball check` tells errors from warnings, in text, in JSON and by its exit code."""

import json

import pytest

from commandline import ran

OVERLAP = """format = 1
[[cylinder]]
center = [0, 0]
radius = 1
[[cylinder]]
center = [1, 0]
radius = 1
"""
BEYOND = OVERLAP + "[[cylinder]]\ncenter = [20, 0]\nradius = 1\n"


@pytest.fixture
def table(tmp_path):
    def write(text):
        path = tmp_path / "mine.toml"
        path.write_text(text, encoding="utf-8")
        return str(path)

    return write


def test_warnings_are_printed_and_the_exit_code_is_0(table):
    path = table(OVERLAP)
    result = ran("check", path)
    assert (result.returncode, result.stderr) == (0, "")
    expected = "  warning: cylinder[1].center: overlaps cylinder[0]: move one of the two"
    assert result.stdout.splitlines() == [f"{path}: 1 warning", expected]


def test_errors_go_to_standard_error_and_the_exit_code_is_2(table):
    result = ran("check", table(BEYOND))
    assert result.returncode == 2
    assert "warning: cylinder[1].center" in result.stdout
    assert "cylinder[2].center: lies beyond the edge" in result.stderr
    assert "overlaps" not in result.stderr


def test_strict_makes_errors_of_warnings(table):
    result = ran("check", "--strict", table(OVERLAP))
    assert (result.returncode, result.stdout) == (2, "")
    assert "overlaps cylinder[0]" in result.stderr
    assert ran("check", "--strict", "classic").returncode == 0


@pytest.mark.parametrize(
    ("text", "options", "code", "errors"),
    [(OVERLAP, [], 0, 0), (OVERLAP, ["--strict"], 2, 0), (BEYOND, [], 2, 1)],
)
def test_json_has_every_problem_with_its_severity(table, text, options, code, errors):
    result = ran("check", "--json", *options, table(text))
    report = json.loads(result.stdout)
    assert result.returncode == code
    assert (report["errors"], report["warnings"]) == (errors, 1)
    assert {problem["severity"] for problem in report["problems"]} == {"warning", *["error"] * errors}
    assert all(problem.keys() == {"path", "message", "severity"} for problem in report["problems"])
