"""Write the cards of the environments into docs/agents.md, from the environments themselves.

    python docs/make_agents.py

A test fails when the page is not what this script would write.
"""

from __future__ import annotations

from pathlib import Path

from silverball.envs import IDS
from silverball.envs.cards import card

PAGE = Path(__file__).parent / "agents.md"
MARK = "<!-- The cards: written by docs/make_agents.py, which takes them from the code. -->\n"


def page() -> str:
    """The page with the cards as they should be."""
    before, _, _ = PAGE.read_text(encoding="utf-8").partition(MARK)
    return before + MARK + "\n" + "\n".join(card(id_) for id_ in IDS)


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
