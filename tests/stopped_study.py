"""A study that is stopped at random moments and goes on, until it is done.

    python stopped_study.py FOLDER MOMENTS SEED

plays a study in one go, then the same one in processes that are stopped by SIGINT or SIGKILL after random
times, at MOMENTS moments at least; at last it prints how often each signal has stopped one before its end,
and `same` if all files have the same bytes.
"""

from __future__ import annotations

import os
import random
import shutil
import signal
import sys
import time
from pathlib import Path

from silverball.studies.result_folder import write_text
from silverball.studies.study import Study
from silverball.studies.study_plan import Plan, arms_of
from silverball.studies.study_report import report_page
from silverball.table import load_table

PLAN = Plan(
    arms_of([("classic", load_table("classic"))], ["idle", "beginner"]), games=120, seed=7, chunk_games=6
)


def play(folder: Path) -> None:
    """Play what is missing, and write the report."""
    study = Study(PLAN, folder)
    study.run()
    write_text(folder / "report.html", report_page(study, "a command"))


def bytes_of(folder: Path) -> dict[str, bytes]:
    """All files of a folder, without what killed processes have left."""
    files = (path for path in folder.rglob("*") if path.is_file())
    return {str(path.relative_to(folder)): path.read_bytes() for path in files}


def stopped(folder: Path, number: int, after: float) -> bool:
    """Play in a process that gets a signal after some seconds; whether that stopped it."""
    child = os.fork()
    if child == 0:
        signal.signal(signal.SIGINT, signal.default_int_handler)
        try:
            play(folder)
        except KeyboardInterrupt:
            os._exit(1)
        os._exit(0)
    time.sleep(after)
    os.kill(child, number)
    return os.waitpid(child, 0)[1] != 0


def main() -> None:
    """Stop a study again and again."""
    base, moments, chance = Path(sys.argv[1]), int(sys.argv[2]), random.Random(int(sys.argv[3]))
    begun = time.perf_counter()
    play(base / "whole")
    begun = time.perf_counter()
    shutil.rmtree(base / "whole")
    play(base / "whole")
    lasts = time.perf_counter() - begun
    expected = bytes_of(base / "whole")
    counts, is_same = {signal.SIGINT: 0, signal.SIGKILL: 0}, True
    while sum(counts.values()) < moments:
        folder = base / "stopped"
        for _ in range(4):
            number = chance.choice(list(counts))
            counts[number] += stopped(folder, number, chance.uniform(0.0, 0.5 * lasts))
        play(folder)
        is_same = is_same and bytes_of(folder) == expected
        shutil.rmtree(folder)
    print(*(f"{number.name} {count}" for number, count in counts.items()), "same" if is_same else "different")


if __name__ == "__main__":
    main()
