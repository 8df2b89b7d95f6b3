"""The report of a study: one file, from which no request leaves, whatever the names in it."""

from __future__ import annotations

import re
from html.parser import HTMLParser
from pathlib import Path

import pytest

import browser
from silverball.studies.study import Study
from silverball.studies.study_plan import Arm, Plan, arms_of
from silverball.studies.study_report import WatchedGame, report_page
from silverball.studies.sweep_arms import swept
from silverball.studies.table_change import parse_sweep
from silverball.table import load_table

HOSTILE = "</script><b onload=x>\x1b[2J & %BODY% \u202e"


class Elements(HTMLParser):
    """Collects the elements of a page, and checks that they are closed in order."""

    VOID = frozenset(("meta", "link", "path", "rect", "circle", "image", "polyline", "polygon"))

    def __init__(self) -> None:
        super().__init__()
        self.open: list[str] = []
        self.found: list[tuple[str, dict[str, str | None]]] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.found.append((tag, dict(attrs)))
        if tag not in self.VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.found.append((tag, dict(attrs)))

    def handle_endtag(self, tag: str) -> None:
        if tag not in self.VOID:
            assert self.open.pop() == tag


@pytest.fixture(scope="module")
def report(tmp_path_factory) -> str:
    """A report of two players of a table with a name that would break a page."""
    classic = load_table("classic").replace(name=HOSTILE[:60])
    arms = (Arm(HOSTILE, classic, "idle"), Arm("recipe", load_table("random"), "reflex"))
    study = Study(Plan(arms, games=12, longest=20.0), tmp_path_factory.mktemp("study"))
    study.run()
    page = "<p>a game</p><script>document.title = 'a game'</script>"
    return report_page(study, HOSTILE, [WatchedGame("The best game", HOSTILE, page)])


def test_elements_are_closed_and_nothing_is_asked_for(report: str):
    page = Elements()
    page.feed(report)
    assert page.open == []
    for tag, attributes in page.found:
        for name in ("src", "href"):
            assert (attributes.get(name) or "data:").startswith("data:"), (tag, attributes)
    assert "url(" not in report
    assert not re.search(r"https?://", report.replace("http://www.w3.org/", ""))
    assert [tag for tag, _ in page.found].count("h1") == 1


def test_names_are_escaped(report: str):
    assert "\x1b" not in report
    assert "<b onload" not in report
    assert "\u202e" not in report
    assert report.count("</script>") == 2
    assert "%BODY%" in report


def test_a_report_has_the_figures_the_command_and_the_versions(report: str):
    for words in ("seconds a ball", "balls lost on the left", "Never hit", "Stays", "numba", "physics"):
        assert words in report


def test_a_sweep_of_one_number_is_drawn_as_a_curve(tmp_path: Path):
    arms = swept(
        arms_of([("classic", load_table("classic"))], ["idle"]), [parse_sweep("board.gravity=8,10,12")]
    )
    study = Study(Plan(arms, games=6, longest=5.0), tmp_path)
    study.run()
    text = report_page(study, "")
    assert text.count("by value") == 2
    assert "minus board.gravity=8" in text


def test_a_study_in_which_nothing_happens_has_a_report(tmp_path: Path):
    study = Study(
        Plan(arms_of([("classic", load_table("classic"))], ["idle"]), games=2, longest=0.1), tmp_path
    )
    study.run()
    assert "no game has scored" in report_page(study, "")


@pytest.mark.skipif(bool(browser.MISSING), reason=browser.MISSING)
def test_a_browser_shows_it_without_a_request_or_a_word(report: str, tmp_path: Path):
    path = tmp_path / "report.html"
    path.write_text(report, encoding="utf-8")
    with browser.sync_playwright() as playwright:
        chromium = playwright.chromium.launch(executable_path=browser.CHROMIUM, args=["--no-sandbox"])
        for width, height in (browser.DESKTOP, browser.PHONE):
            page = chromium.new_page(viewport={"width": width, "height": height})
            said: list[str] = []
            asked: list[str] = []
            page.on("console", lambda message, said=said: said.append(message.text))
            page.on("pageerror", lambda error, said=said: said.append(str(error)))
            page.on("request", lambda request, asked=asked: asked.append(request.url))
            page.goto(path.as_uri())
            assert page.evaluate("document.documentElement.scrollWidth") == width
            page.click("[data-game]")
            page.wait_for_selector("iframe")
            assert said == []
            assert {url for url in asked if not url.startswith("data:")} <= {path.as_uri(), "about:srcdoc"}
        chromium.close()
