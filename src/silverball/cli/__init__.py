"""The command line, `silverball <command>`: a thin layer with one file for each command.

A command turns its arguments into calls of the library and prints the result. `app` collects the commands and
ends errors, `options` and `console` hold what commands share, `signals` and `streams` make Ctrl-C and closed
standard streams safe.
"""

from __future__ import annotations

import sys

from silverball.cli.signals import run_until_stopped


def main() -> None:
    """Run `silverball` or `python -m silverball`."""
    run_until_stopped(_run)


def _run() -> int:
    from silverball.cli.streams import prepare

    prepare()
    from silverball.cli.app import run

    return run(sys.argv[1:])
