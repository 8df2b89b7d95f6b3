"""Write `constraints/lowest.txt`: the lowest version of every package that pyproject.toml says is enough.

`.ci/run` installs exactly these and runs tests with them; `tests/test_lowest_versions.py` fails if the two
files differ.
"""

from __future__ import annotations

import re
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
EXTRAS = ("video", "rl", "design", "test")
HEAD = "# Written by constraints/make_lowest.py: what pyproject.toml names as the lowest versions.\n"


def lowest(project: str) -> str:
    """The constraints that follow from the text of a pyproject.toml."""
    named = tomllib.loads(project)["project"]
    wanted = [*named["dependencies"]]
    for extra in EXTRAS:
        more = named["optional-dependencies"][extra]
        wanted += [one for one in more if not one.startswith(f"{named['name']}[")]
    pairs = [re.fullmatch(r"([\w.-]+)>=([\d.]+)", one) for one in wanted]
    if None in pairs:
        raise ValueError(f"expected NAME>=VERSION everywhere, got {wanted[pairs.index(None)]!r}")
    return HEAD + "".join(f"{pair[1]}=={pair[2]}\n" for pair in pairs if pair)


if __name__ == "__main__":
    (ROOT / "constraints" / "lowest.txt").write_text(
        lowest((ROOT / "pyproject.toml").read_text(encoding="utf-8")), encoding="utf-8"
    )
