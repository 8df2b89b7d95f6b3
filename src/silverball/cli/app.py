"""Which commands are there, and how does a mistake end?

The modules of the commands import what they need when they run, so that `silverball --help` is quick.
"""

from __future__ import annotations

import sys
from typing import Any

import typer

from silverball.cli.bench import bench
from silverball.cli.check import check
from silverball.cli.demo import demo
from silverball.cli.generate import generate
from silverball.cli.play import play
from silverball.cli.replay import replay
from silverball.cli.scores import scores
from silverball.cli.show import show
from silverball.cli.signals import STOPPED, stopped
from silverball.cli.simulate import simulate
from silverball.cli.tables import tables
from silverball.errors import SilverballError

app = typer.Typer(
    add_completion=False,
    rich_markup_mode="markdown",
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)
for command in (play, replay, scores, demo, tables, show, check, generate, simulate, bench):
    app.command()(command)
COMMANDS = tuple(command.callback.__name__ for command in app.registered_commands if command.callback)


@app.callback(invoke_without_command=True)
def silverball(
    ctx: typer.Context,
    version: bool = typer.Option(False, "--version", help="Print the version and end."),
) -> None:
    """A pinball table: play it, build it, and run it a million times.

    Without a command, `silverball` opens the window, or makes a demo file where there is no display.
    """
    if version:
        from silverball import __version__

        typer.echo(f"silverball {__version__}")
        raise typer.Exit
    if ctx.invoked_subcommand is None:
        from silverball.cli.play import play_or_demo

        play_or_demo()


def run(arguments: list[str]) -> int:
    """Run the command line and return the exit code.

    0: done. 2: a mistake of a person, or a file or stream that cannot be written; one message says which.
    130: stopped by Ctrl-C.
    """
    try:
        code = app(args=arguments, prog_name="silverball", standalone_mode=False)
        sys.stdout.flush()
    except SilverballError as error:
        return complain(str(error))
    except KeyboardInterrupt:
        code = STOPPED
    except typer.Abort as end:
        if isinstance(end.__cause__, EOFError):  # nobody is asked anything here, so no Ctrl-D ends anything
            raise end.__cause__ from None
        code = STOPPED
    except OSError as error:
        where = f"{error.filename}: " if error.filename else ""
        return complain(f"silverball: {where}{error.strerror or error}")
    except Exception as error:
        if not hasattr(error, "format_message"):
            raise
        return complain(usage_message(error, arguments))
    if code == STOPPED:
        return stopped()
    return code if isinstance(code, int) else 0


def complain(message: str) -> int:
    """Print the message of a mistake; its exit code."""
    print(message, file=sys.stderr)
    return 2


def usage_message(error: Any, arguments: list[str]) -> str:
    """One sentence for arguments that do not fit: where, what, what was given, and where to look."""
    command = next((word for word in arguments if word in COMMANDS), "")
    name = f"silverball {command}".strip()
    message = error.format_message().rstrip(".?")
    given = given_value(getattr(error, "param", None), arguments)
    if given is not None:
        message += f", got {given!r}"
    elif not command and "mean" not in message:
        message += f"; there are {', '.join(COMMANDS)}"
    return f"{name}: {message}. `{name} --help` shows what there is"


def given_value(parameter: Any, arguments: list[str]) -> str | None:
    """What was given for an option, if it was given."""
    for option in getattr(parameter, "opts", ()):
        for index, word in enumerate(arguments):
            if word == option and index + 1 < len(arguments):
                return arguments[index + 1]
            if word.startswith(f"{option}="):
                return word.split("=", 1)[1]
    return None
