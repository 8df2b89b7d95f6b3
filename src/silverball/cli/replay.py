"""`silverball replay`: watches, verifies, compares or films a recorded game."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from silverball.cli.browser_page import ENDING, make_replay_page
from silverball.cli.completion import LAST_REPLAY, complete_replay
from silverball.cli.console import baking, compiling, error_console, print_json, print_lines, progress_bar
from silverball.cli.shared_options import Force, Music, Size, ThemeName, check_output, file_name, theme_named
from silverball.errors import SilverballError

if TYPE_CHECKING:
    from silverball.game.replay.format import Replay
    from silverball.game.replay.verify import Verdict

DIFFERS = 1  # exit code if playing a replay does not reproduce what it records


def replay(
    file: Annotated[
        str,
        typer.Argument(
            metavar="FILE",
            help="Replay file, or `last` for the game that was played last.",
            autocompletion=complete_replay,
        ),
    ],
    verify: Annotated[
        bool, typer.Option("--verify", help="Play it without a window, and check every recorded result.")
    ] = False,
    against: Annotated[
        str | None,
        typer.Option(metavar="OTHER", help="Find the first tick and field in which another replay differs."),
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option(
            parser=file_name,
            metavar="FILE",
            help="Film to write, .gif, .mp4 or .png; or .html, a page for a browser.",
        ),
    ] = None,
    start: Annotated[
        float, typer.Option("--from", min=0.0, max=86_400.0, help="Where in the game the film begins [s].")
    ] = 0.0,
    seconds: Annotated[
        float | None,
        typer.Option(
            min=0.1,
            max=600.0,
            help="Length of the film [s]; a PNG shows its end. [default: to the end]",
        ),
    ] = None,
    size: Size = None,
    theme: ThemeName = "neon",
    music: Music = True,
    force: Force = False,
    as_json: Annotated[bool, typer.Option("--json", help="Print one JSON object on one line.")] = False,
) -> None:
    """Watch a recorded game in the window, film it, verify it, or compare it with another.

    Exit codes: 0 success, 1 the replay differs, 2 it cannot be played.

    Example: `silverball replay last --out game.gif --from 10 --seconds 8`

    Example: `silverball replay last --out game.html`
    """
    game = load(file)
    report = replay_summary(file, game)
    verdict: Verdict | None = None
    if verify:
        verdict = verified(game)
        report["verify"] = verdict._asdict()
        print_unless(as_json, f"{file}: {verdict.message}")
    if against is not None and (verdict is None or verdict.ok):
        verdict = compared(game, load(against))
        report["against"] = {"file": against} | verdict._asdict()
        print_unless(as_json, f"{file} and {against}: {verdict.message}")
    if out is not None and out.suffix.lower() == ENDING and (verdict is None or verdict.ok):
        make_page(out, game, start, seconds, size, theme=theme, force=force)
        report["out"] = str(out)
    elif out is not None and (verdict is None or verdict.ok):
        make_film(out, game, start, seconds, size, theme=theme, music=music, force=force, quiet=as_json)
        report["out"] = str(out)
    if as_json:
        print_json(report, indent=None)
    elif out is None and verdict is None:
        watch(game)
    if verdict is not None and not verdict.ok:
        raise typer.Exit(DIFFERS)


def load(file: str) -> Replay:
    """The replay of a file, or of the last game.

    Raises:
        SilverballError: There is no such replay, or it cannot be played.
    """
    with compiling():
        from silverball.game.replay.format import Replay

    if file != LAST_REPLAY:
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


def replay_summary(file: str, game: Replay) -> dict[str, Any]:
    """The header of a replay, for the JSON report."""
    return {
        "file": file,
        "program": game.program,
        "mode": str(game.mode),
        "players": game.players,
        "table": game.table.name,
        "seed": game.seed,
        "tick_rate": game.tick_rate,
        "ticks": game.ticks,
        "seconds": game.seconds,
        "score": game.score,
        "ended": game.ended,
    }


def print_unless(as_json: bool, sentence: str) -> None:
    """Print a sentence, unless the report is JSON."""
    if not as_json:
        print_lines(sentence)


def verified(game: Replay) -> Verdict:
    """Verify a replay, with a progress bar."""
    from silverball.game.replay.verify import verify

    with progress_bar() as bar:
        task = bar.add_task("playing", total=game.ticks)
        return verify(game, lambda ticks: bar.update(task, completed=ticks))


def compared(game: Replay, other: Replay) -> Verdict:
    """Compare two replays tick by tick."""
    from silverball.game.replay.verify import compare

    with error_console.status("playing both …"):
        return compare(game, other)


def watch(game: Replay) -> None:
    """Watch a replay in the window."""
    from silverball.cli.play import open_window

    open_window(replay=game)


def make_page(
    out: Path,
    game: Replay,
    start: float,
    seconds: float | None,
    size: int | None,
    *,
    theme: str,
    force: bool,
) -> None:
    """Write a page in which the whole replay is watched.

    Raises:
        SilverballError: A part of it is asked for, or the file cannot be written.
    """
    check_output(out, (ENDING,), force=force)
    if start > 0.0 or seconds is not None:
        raise SilverballError("a page shows the whole game; leave --from and --seconds out")
    make_replay_page(out, game, size, theme)


def make_film(
    out: Path,
    game: Replay,
    start: float,
    seconds: float | None,
    size: int | None,
    *,
    theme: str = "neon",
    music: bool = True,
    force: bool,
    quiet: bool = False,
) -> None:
    """Film a part of a replay, or draw its last frame.

    Raises:
        SilverballError: The part is empty, or the file cannot be written.
    """
    from silverball.app.sessions import ReplaySession
    from silverball.cli.filming import ENDINGS, film_size, record
    from silverball.drawing import Renderer
    from silverball.game.replay.player import ReplayPlayer

    check_output(out, ENDINGS, force=force)
    if start >= game.seconds:
        raise SilverballError(f"--from must be before the game's end at {game.seconds:.2f} s, got {start:g}")
    length = min(game.seconds - start, game.seconds if seconds is None else seconds)
    with baking() as progress:
        renderer = Renderer(
            game.table, film_size(out, game.table, length, size), theme=theme_named(theme), progress=progress
        )
    session = ReplaySession(ReplayPlayer(game))
    session.player.seek(round(start * game.tick_rate))
    record(out, session, renderer, length, theme=theme, has_music=music, quiet=quiet)
    renderer.close()
