"""Another program that holds the file of the scores, as a backup or a database browser does.

    python holder.py FILE HOW

takes the file, says `held`, and lets it go when its standard input ends.
"""

from __future__ import annotations

import sqlite3
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

WRITES = "writes"  # nobody else can write
ALONE = "alone"  # nobody else can even read


@contextmanager
def held(file: Path, how: str = WRITES) -> Iterator[subprocess.Popen[str]]:
    """Let another program hold a file meanwhile."""
    command = [sys.executable, __file__, str(file), how]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as program:
        assert program.stdout is not None
        assert program.stdout.readline() == "held\n"
        yield program
        program.communicate()


def main() -> None:
    """Hold the file."""
    file, how = sys.argv[1:]
    connection = sqlite3.connect(file, isolation_level=None)
    if how == ALONE:
        connection.execute("PRAGMA locking_mode = EXCLUSIVE").fetchall()
    connection.execute("BEGIN EXCLUSIVE")
    connection.execute("CREATE TABLE IF NOT EXISTS of_a_backup (id)")  # it has begun to write
    print("held", flush=True)
    sys.stdin.read()
    connection.execute("ROLLBACK")
    connection.close()


if __name__ == "__main__":
    main()
