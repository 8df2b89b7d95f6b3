import subprocess
import sys
from pathlib import Path

import pytest

import silverball
from patience import PATIENCE

SOURCES = Path(silverball.__file__).parent
OWN_THREADS = {"background_thread.py", "compile_thread.py"}  # the compiler's ends by itself at exit

BEGINS = """
import threading, time
from silverball.background_thread import BackgroundThread
stop = threading.Event()
"""


def run(program: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-c", BEGINS + program],
        capture_output=True,
        text=True,
        timeout=PATIENCE,
        check=False,
    )


def test_an_error_in_a_thread_while_the_program_ends_is_not_told():
    ended = run("""
def work():
    threading.main_thread().join()
    import concurrent.futures.thread  # refused from here on
    raise AssertionError
BackgroundThread(work, "work").start()
""")
    assert (ended.returncode, ended.stderr) == (0, "")


def test_an_error_in_a_thread_before_the_end_is_told():
    ended = run("""
def work():
    raise ValueError("told")
thread = BackgroundThread(work, "work")
thread.start()
thread.join()
""")
    assert "Exception in thread silverball work" in ended.stderr
    assert "ValueError: told" in ended.stderr


def test_a_thread_is_stopped_and_waited_for_at_exit():
    ended = run("""
def work():
    stop.wait()
    time.sleep(0.2)
    print("cleaned up", flush=True)
BackgroundThread(work, "work", stop).start()
""")
    assert (ended.returncode, ended.stdout, ended.stderr) == (0, "cleaned up\n", "")


def test_a_thread_that_does_not_stop_holds_up_nobody():
    ended = run("""
start = time.monotonic()
import atexit
import silverball.background_thread as module
module.EXIT_WAIT = 0.2
BackgroundThread(lambda: time.sleep(60), "work", stop).start()
""")
    assert (ended.returncode, ended.stderr) == (0, "")


@pytest.mark.parametrize("seconds", [0.0, 0.05, 0.3, 0.8])
def test_a_program_may_end_at_any_moment_of_the_baking(seconds, tmp_path):
    ended = run(f"""
import os
os.environ["SDL_VIDEODRIVER"] = "dummy"
from silverball.drawing import Renderer
from silverball.table import load_table
renderer = Renderer(load_table("classic"), (60, 100), background=True)
time.sleep({seconds})
""")
    assert (ended.returncode, ended.stderr) == (0, "")


def test_no_other_daemon_thread_is_left_to_the_interpreter():
    found = {path.name for path in SOURCES.rglob("*.py") if "daemon=True" in path.read_text("utf-8")}
    assert found == OWN_THREADS
