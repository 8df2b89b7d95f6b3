"""Is a score true? Its replay, played back, must be of that game and reach it."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from silverball.errors import SilverballError
from silverball.table import generate_table, load_table, table_digest, table_names

if TYPE_CHECKING:
    from silverball.game.replay import Replay
    from silverball.game.store import Score


class Proof(NamedTuple):
    """What came of playing a replay back, as `Store.mark` takes it.

    Attributes:
        verified: Whether the score is true; None if this program cannot tell.
        why: Why it is not, or why nobody can tell; else empty.
    """

    verified: bool | None
    why: str = ""


def prove(score: Score, text: str) -> Proof:
    """Play the replay of a score back.

    Args:
        score: What is claimed.
        text: Its replay.
    """
    from silverball.game.replay import Replay, verify

    if of_another_version(text):
        return Proof(None, "its replay is of another version of the physics or the rules")
    try:
        replay = Replay.from_text(text)
        why = _another_game(score, replay)
        if why:
            return Proof(False, why)
        verdict = verify(replay)
    except SilverballError as error:
        return Proof(False, " ".join(str(error).split()))
    if not verdict.ok:
        return Proof(False, verdict.message)
    if verdict.score != score.score:
        return Proof(False, f"its replay reaches {verdict.score:,}")
    return Proof(True)


def of_another_version(text: str) -> bool:
    """Whether a replay was written by a program whose games go otherwise; it is not false for that."""
    from silverball.game.rules import RULES_VERSION
    from silverball.physics import PHYSICS_VERSION

    ours = {"physics": PHYSICS_VERSION, "rules": RULES_VERSION}
    for line in text.splitlines()[:6]:
        key, _, value = line.partition(" = ")
        if key in ours and value.isdecimal() and int(value) != ours[key]:
            return True
    return False


def _another_game(score: Score, replay: Replay) -> str:
    """What shows that a replay is one of another game; empty if nothing does."""
    for what, claimed, found in (("mode", score.mode, replay.mode), ("seed", score.seed, replay.seed)):
        if claimed != found:
            return f"its replay is of another game: the {what} is {found}, not {claimed}"
    if not _may_be_its_table(score, replay):
        return f"its replay is of another game: the table is {replay.table.name!r}"
    return ""


def _may_be_its_table(score: Score, replay: Replay) -> bool:
    """Whether a replay's table is that of the score, or a board of it."""
    digest = table_digest(replay.table)
    if digest == score.table_digest:
        return True
    for table in map(load_table, table_names()):
        if table_digest(table) == score.table_digest:
            return table.random is not None and digest == table_digest(generate_table(score.seed, table))
    return True  # it may be a board of a recipe that somebody has written, which is not at hand
