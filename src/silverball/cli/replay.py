"""`silverball replay`: watch a game again, verify it, compare it with another, or make a film of it."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from silverball.cli.output import file_name
from silverball.cli.say import say, say_json
from silverball.errors import SilverballError

if TYPE_CHECKING:
    from silverball.game.replay.format import Replay
    from silverball.game.replay.verify import Verdict

LAST = "last"
DIFFERS = 1  # the exit code for a replay that does not lead to what it says


def replay(
    file: str = typer.Argument(metavar="FILE", help="A replay, or `last` for the game that was played last."),
    verify: bool = typer.Option(False, "--verify", help="Play it unseen and say whether the same comes out."),
    against: str | None = typer.Option(
        None, metavar="OTHER", help="Find the first tick and field in which another replay differs."
    ),
    out: Path | None = typer.Option(
        None, parser=file_name, metavar="FILE", help="Make a film: ends in .gif, .mp4 or .png."
    ),
    start: float = typer.Option(0.0, "--from", min=0.0, max=86_400.0, help="Where the film begins [s]."),
    seconds: float | None = typer.Option(
        None, min=0.1, max=600.0, help="How much of it to film; a PNG shows the last moment."
    ),
    size: int | None = typer.Option(None, min=100, max=4320, help="Height of the picture in pixels."),
    theme: str = typer.Option("neon", help="The look: neon, parlour or clear (for colour-blind eyes)."),
    force: bool = typer.Option(False, "--force", help="Overwrite a file that exists."),
    as_json: bool = typer.Option(False, "--json", help="Print what there is to tell as JSON."),
) -> None:
    """Watch a recorded game again, in the window or as a film, or verify that it is true.

    Exit codes: 0 done and equal, 1 it differs, 2 it cannot be played.

    Example: `silverball replay last --out game.gif --from 10 --seconds 8`
    """
    game = load(file)
    told = facts(file, game)
    verdict: Verdict | None = None
    if verify:
        verdict = verified(game)
        told["verify"] = verdict._asdict()
        tell(as_json, f"{file}: {verdict.message}")
    if against is not None and (verdict is None or verdict.ok):
        verdict = compared(game, load(against))
        told["against"] = {"file": against} | verdict._asdict()
        tell(as_json, f"{file} and {against}: {verdict.message}")
    if out is not None and (verdict is None or verdict.ok):
        make_film(out, game, start, seconds, size, theme=theme, force=force, quiet=as_json)
        told["out"] = str(out)
    if as_json:
        say_json(told, indent=None)
    elif out is None and verdict is None:
        watch(game)
    if verdict is not None and not verdict.ok:
        raise typer.Exit(DIFFERS)


def load(file: str) -> Replay:
    """The replay of a file, or of the last game.

    Raises:
        SilverballError: There is none, or it cannot be played.
    """
    from silverball.cli.console import compiling

    with compiling():
        from silverball.game.replay.format import Replay

    if file != LAST:
        return Replay.load(file)
    text = last_game()
    if text is None:
        raise SilverballError("there is no last game yet; play one, or give the path of a replay")
    return Replay.from_text(text, "the last game")


def last_game() -> str | None:
    """The replay of the game that was played last, if there is one."""
    from silverball.game.scores.store import Store

    with Store() as store:
        return store.last_game()


def facts(file: str, game: Replay) -> dict[str, Any]:
    """What a replay says of itself."""
    return {
        "file": file,
        "program": game.program,
        "mode": str(game.mode),
        "table": game.table.name,
        "seed": game.seed,
        "tick_rate": game.tick_rate,
        "ticks": game.ticks,
        "seconds": game.seconds,
        "score": game.score,
        "ended": game.ended,
    }


def tell(as_json: bool, sentence: str) -> None:
    """Print a sentence, unless JSON is to be printed."""
    if not as_json:
        say(sentence)


def verified(game: Replay) -> Verdict:
    """Play a replay with a moving line."""
    from rich.progress import Progress

    from silverball.cli.console import errors
    from silverball.game.replay.verify import verify

    with Progress(console=errors, transient=True, disable=not errors.is_terminal) as bar:
        task = bar.add_task("playing", total=game.ticks)
        return verify(game, lambda ticks: bar.update(task, completed=ticks))


def compared(game: Replay, other: Replay) -> Verdict:
    """Play two replays side by side."""
    from silverball.cli.console import errors
    from silverball.game.replay.verify import compare

    with errors.status("playing both …"):
        return compare(game, other)


def watch(game: Replay) -> None:
    """Watch a replay in the window."""
    from silverball.cli.play import open_window

    open_window(replay=game)


def make_film(
    out: Path,
    game: Replay,
    start: float,
    seconds: float | None,
    size: int | None,
    *,
    theme: str = "neon",
    force: bool,
    quiet: bool = False,
) -> None:
    """Make a film, or a picture of the last moment, of a part of a replay.

    Raises:
        SilverballError: The part is empty, or the file cannot be written.
    """
    from silverball.app.sessions import ReplaySession
    from silverball.cli.look import baking, theme_named
    from silverball.cli.recording import ENDINGS, film_size, record
    from silverball.drawing import Renderer
    from silverball.export.film import check_output
    from silverball.game.replay.player import ReplayPlayer

    check_output(out, ENDINGS, force=force)
    if start >= game.seconds:
        raise SilverballError(f"--from must be before the game's end at {game.seconds:.2f} s, got {start:g}")
    length = min(game.seconds - start, game.seconds if seconds is None else seconds)
    with baking() as progress:
        renderer = Renderer(
            game.table, film_size(out, game.table, length, size), theme=theme_named(theme), progress=progress
        )
    stage = ReplaySession(ReplayPlayer(game))
    stage.player.seek(round(start * game.tick_rate))
    record(out, stage, renderer, length, quiet=quiet)
    renderer.close()
