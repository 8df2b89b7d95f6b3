"""The command line: `silverball <command>`, thin, one file a command.

Every command turns what a person typed into one call of the library. A mistake of a person ends in
`app.run`: its message is printed alone and the exit code is 2, without a traceback.
"""

from __future__ import annotations

import sys

from silverball.cli.signals import run_until_stopped


def main() -> None:
    """The entry point of `silverball` and `python -m silverball`."""
    run_until_stopped(_run)


def _run() -> int:
    from silverball.cli.streams import prepare

    prepare()
    from silverball.cli.app import run

    return run(sys.argv[1:])
