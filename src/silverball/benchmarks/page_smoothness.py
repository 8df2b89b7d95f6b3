"""How smoothly a page plays in a browser: its start, its pictures per second, the work of a picture.

Debian's Chromium, without a screen, opens the page of a table and plays it: a ball whenever none is in play,
and the paddles by key events.
"""

from __future__ import annotations

import os
import shutil
import tempfile
from collections.abc import Callable
from pathlib import Path

import numpy as np

from silverball.benchmarks.speed import Figure
from silverball.drawing.themes import THEMES
from silverball.errors import MissingExtra, SilverballError
from silverball.table import Table
from silverball.web.page import game_page, write_page

SEED = 7
BEAT = 20  # pictures between two presses
# Notes when the page is ready; it says so by setting `silverball`.
NOTE_READY = """
let kept;
Object.defineProperty(window, "silverball", {
  get: () => kept, set: (value) => { kept = value; window.readyAt = performance.now(); },
});
"""
PLAY = """(pictures) => new Promise((done) => {
  const { page, stage } = silverball, frame = page.frame.bind(page), starts = [], work = [];
  const press = (kind, code) => dispatchEvent(new KeyboardEvent(kind, { code, bubbles: true }));
  page.goOn();
  page.frame = (now) => {
    const start = performance.now(), beat = Math.floor(starts.length / BEAT);
    frame(now);
    starts.push(start);
    work.push(performance.now() - start);
    if (starts.length % BEAT === 0) {
      press(beat % 2 ? "keydown" : "keyup", "KeyA");
      press(beat % 3 ? "keydown" : "keyup", "KeyD");
      press(beat % 4 ? "keydown" : "keyup", "Enter");
      if (!stage.world.balls().length) page.act("create");
    }
    if (starts.length === pictures) done({ starts, work });
  };
})""".replace("BEAT", str(BEAT))


def measure_page(
    table: Table, size: tuple[int, int], pictures: int, advance: Callable[[str], None] = lambda _: None
) -> list[Figure]:
    """Open the page of a table in Chromium, play it, and measure.

    Args:
        table: Its table.
        size: Width and height of the browser's window [pixel].
        pictures: How many pictures are timed.
        advance: Called with the name of what is measured next.

    Raises:
        MissingExtra: Playwright is not installed.
        SilverballError: There is no Chromium.
    """
    try:
        from playwright.sync_api import sync_playwright
    except ModuleNotFoundError:
        raise MissingExtra("measuring a page", "test") from None
    chromium = browser_path()
    advance("writing the page")
    with tempfile.TemporaryDirectory() as folder, sync_playwright() as playwright:
        path = Path(folder) / "table.html"
        write_page(path, game_page(table, SEED, THEMES["neon"]))
        browser = playwright.chromium.launch(executable_path=chromium, args=["--no-sandbox"])
        try:
            page = browser.new_page(viewport={"width": size[0], "height": size[1]})
            page.add_init_script(NOTE_READY)
            page.goto(path.as_uri())
            while not page.evaluate("window.readyAt ?? 0"):
                page.wait_for_timeout(10)
            advance(f"playing {pictures} pictures")
            ready, seen = page.evaluate("readyAt"), page.evaluate(PLAY, pictures)
        finally:
            browser.close()
        length = path.stat().st_size
    work = np.array(seen["work"])
    return [
        Figure("size of the page", length / 1e6, "MB"),
        Figure("opened until it can be played", ready, "ms"),
        Figure("pictures", 1000.0 / float(np.median(np.diff(seen["starts"]))), "pictures/s"),
        Figure("work of a picture, median", float(np.median(work)), "ms"),
        Figure("work of a picture, 99 %", float(np.percentile(work, 99)), "ms"),
        Figure("work of a picture, longest", float(work.max()), "ms"),
    ]


def browser_path() -> str:
    """The path of Chromium or Chrome, or what the variable SILVERBALL_CHROMIUM names.

    Raises:
        SilverballError: There is none.
    """
    names = ("chromium", "google-chrome")
    found = os.environ.get("SILVERBALL_CHROMIUM") or next(filter(None, map(shutil.which, names)), None)
    if found is None:
        raise SilverballError(
            "measuring a page needs a browser, and neither chromium nor google-chrome is on the path: "
            "install Debian's package chromium, or set SILVERBALL_CHROMIUM to the path of one"
        )
    return found
