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
from silverball.cli.streams import give_up, is_broken_pipe
from silverball.cli.tables import tables
from silverball.errors import SilverballError
from silverball.plain import plain

LONGEST = 1000  # characters of a line of a message; what a person typed may be longer

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

    0: done, or nobody reads on. 2: a mistake of a person, a file or stream that cannot be read or written, or
    too little memory; one message says which.
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
    except (BrokenPipeError, SystemExit) as error:
        if not is_broken_pipe(error):
            raise
        give_up(sys.stdout)
        give_up(sys.stderr)
        return 0
    except OSError as error:
        give_up(sys.stdout)
        where = f"{error.filename}: " if error.filename else ""
        return complain(f"silverball: {where}{error.strerror or error}")
    except MemoryError:
        return complain("silverball: there is too little memory for this; ask for fewer or smaller things")
    except Exception as error:
        if not hasattr(error, "format_message"):
            raise
        return complain(usage_message(error, arguments))
    if code == STOPPED:
        return stopped()
    return code if isinstance(code, int) else 0


def complain(message: str) -> int:
    """Print the message of a mistake, whatever stands in it; its exit code."""
    try:
        print("\n".join(map(shortened, plain(message, keep="\n").split("\n"))), file=sys.stderr)
        sys.stderr.flush()
    except OSError:
        give_up(sys.stderr)
    return 2


def shortened(line: str) -> str:
    """A line with its middle left out if it is very long."""
    if len(line) <= LONGEST:
        return line
    return f"{line[: LONGEST // 2]} … {line[-LONGEST // 2 :]}"


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
