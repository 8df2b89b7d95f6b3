"""Take the picture of docs/studies.md: `python docs/make_study.py FOLDER`.

FOLDER is that of `silverball study classic --games 10000`; needs Chromium and playwright, which is part of
the extra `test`.
"""

from __future__ import annotations

import io
import shutil
import sys
from pathlib import Path

from PIL import Image
from playwright.sync_api import sync_playwright

WIDTH, HEIGHT = 1180, 2260  # [pixel] of the part of the report that is shown
SHOWN = 0.6  # size of the picture


def main() -> None:
    """Write docs/study_report.png."""
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=shutil.which("chromium"), args=["--no-sandbox"])
        page = browser.new_page(viewport={"width": WIDTH, "height": HEIGHT}, color_scheme="light")
        page.goto((Path(sys.argv[1]) / "report.html").resolve().as_uri())
        picture = Image.open(io.BytesIO(page.screenshot()))
        browser.close()
    small = picture.convert("RGB").resize(
        (round(WIDTH * SHOWN), round(HEIGHT * SHOWN)), Image.Resampling.LANCZOS
    )
    small.quantize(128).save(Path(__file__).with_name("study_report.png"), optimize=True)


if __name__ == "__main__":
    main()
