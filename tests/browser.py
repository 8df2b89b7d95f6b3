"""A page in Debian's Chromium, driven by Playwright: the tests of the table in a browser."""

from __future__ import annotations

from contextlib import contextmanager
from pathlib import Path
from typing import Any

from patience import PATIENCE
from silverball.benchmarks.page_smoothness import browser_path
from silverball.errors import SilverballError

try:
    from playwright.sync_api import sync_playwright
except ModuleNotFoundError:
    sync_playwright = None

PHONE, DESKTOP = (390, 844), (1280, 900)
MISSING = "" if sync_playwright else "needs the package playwright, which is part of the extra `test`"
try:
    CHROMIUM = browser_path()
except SilverballError as error:
    MISSING = str(error)


class Browser:
    """A browser that opens one page after the other."""

    def __init__(self, chromium: Any) -> None:
        self._chromium = chromium

    @contextmanager
    def open(self, path: Path, size: tuple[int, int] = DESKTOP, *, is_phone: bool = False, setup: str = ""):
        """Open a page, and fail if it writes to the console or asks for anything but itself."""
        context = self._chromium.new_context(
            viewport={"width": size[0], "height": size[1]}, has_touch=is_phone, is_mobile=is_phone,
            accept_downloads=True,
        )  # fmt: skip
        page = context.new_page()
        said: list[str] = []
        asked: list[str] = []
        page.on("console", lambda message: said.append(message.text))
        page.on("pageerror", lambda error: said.append(str(error)))
        page.on("request", lambda request: asked.append(request.url))
        page.on("dialog", lambda dialog: said.append(f"dialog {dialog.message}"))
        if setup:
            page.add_init_script(setup)
        page.goto(path.as_uri())
        wait_until(page, "document.getElementById('notice').textContent !== 'loading'")
        assert page.evaluate("!!window.silverball"), page.inner_text("#notice")
        try:
            yield page
            assert said == []
            assert [url for url in asked if not url.startswith("blob:")] == [path.as_uri()]
        finally:
            context.close()


def wait_until(page: Any, condition: str, seconds: float = PATIENCE) -> None:
    """Wait for a condition; Playwright's own way evaluates text, which the policy of the page forbids."""
    for _ in range(int(100 * seconds)):
        if page.evaluate(condition):
            return
        page.wait_for_timeout(10)
    raise AssertionError(f"after {seconds} s it is not true that {condition}")


@contextmanager
def browser():
    """Start the browser."""
    with sync_playwright() as playwright:
        chromium = playwright.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        try:
            yield Browser(chromium)
        finally:
            chromium.close()
