"""Points at which Ctrl-C may raise, and how a command then ends."""

from __future__ import annotations

import signal
import subprocess
import sys
import threading
import weakref

import pytest

from commandline import hear_ctrl_c
from patience import PATIENCE
from silverball.cli import signals

SCRIPT = """
import os, signal, sys, threading, time
{before}
from silverball.cli.signals import run_until_stopped

def send(number, after):
    threading.Timer(after, lambda: os.kill(os.getpid(), number)).start()

def command():
{command}

run_until_stopped(command)
"""


def ended(command: str, before: str = "") -> tuple[int, str, str]:
    """Run a process whose command has this body; returns its exit code, output and errors."""
    body = "\n".join(f"    {line}" for line in command.strip().splitlines())
    done = subprocess.run(
        [sys.executable, "-c", SCRIPT.format(before=before, command=body)],
        capture_output=True, text=True, timeout=PATIENCE, check=False,
        preexec_fn=hear_ctrl_c if sys.platform != "win32" else None,
    )  # fmt: skip
    return done.returncode, done.stdout, done.stderr


posix = pytest.mark.skipif(sys.platform == "win32", reason="Windows has no signals to send")


@posix
@pytest.mark.parametrize(
    ("number", "code", "words"),
    [(signal.SIGINT, 130, "stopped\n"), (signal.SIGTERM, 143, ""), (getattr(signal, "SIGHUP", 1), 129, "")],
)
def test_a_signal_ends_a_command_by_way_of_what_it_cleans_up(number, code, words):
    command = f"""
send({int(number)}, 0.1)
try:
    time.sleep(30)
finally:
    print("cleaned up")
"""
    assert ended(command) == (code, "cleaned up\n", words)


@posix
def test_a_command_that_ends_by_itself_keeps_its_code_and_an_error_its_traceback():
    assert ended("return 2") == (2, "", "")
    code, _, words = ended("return 1 // 0")
    assert code == 1
    assert words.count("Traceback") == 1
    assert "ZeroDivisionError" in words
    assert ended("sys.exit('no')")[0] == 1


@posix
def test_a_thread_that_is_busy_does_not_hold_up_the_end():
    command = """
threading.Thread(target=time.sleep, args=(30,), daemon=True).start()
send(signal.SIGINT, 0.1)
time.sleep(30)
"""
    assert ended(command) == (130, "", "stopped\n")


@posix
@pytest.mark.parametrize("name", ["SIGINT", "SIGHUP"])
def test_a_signal_that_is_ignored_from_the_start_stays_so(name):
    """As for what `nohup` starts, or a shell in the background."""
    command = f"""
os.kill(os.getpid(), signal.{name})
time.sleep(0.1)
print("went on")
return 0
"""
    before = f"signal.signal(signal.{name}, signal.SIG_IGN)"
    assert ended(command, before) == (0, "went on\n", "")


@posix
def test_a_signal_in_an_import_waits_until_it_is_done(tmp_path):
    (tmp_path / "slow.py").write_text(
        "import os, signal, time\n"
        "os.kill(os.getpid(), signal.SIGINT)\n"
        "try:\n    time.sleep(0.3)\nexcept BaseException:\n    print('swallowed')\n"
        "print('imported')\n"
    )
    command = "import slow\ntime.sleep(30)"
    before = f"sys.path.insert(0, {str(tmp_path)!r})"
    assert ended(command, before) == (130, "imported\n", "stopped\n")


@posix
def test_a_signal_in_a_destructor_waits_until_it_is_done():
    command = """
class Thing:
    def __del__(self):
        os.kill(os.getpid(), signal.SIGINT)
        time.sleep(0.1)
        print("destroyed")
thing = Thing()
del thing
time.sleep(30)
"""
    assert ended(command) == (130, "destroyed\n", "stopped\n")


def frame_in(call) -> list[bool]:
    """Whether the place from which `call` calls its argument is safe."""
    said: list[bool] = []
    call(lambda *_: said.append(signals._is_safe(sys._getframe())))
    return said


def test_the_start_of_a_thread_is_not_left_half_done(monkeypatch):
    def starts(look):
        for name in ("_start_new_thread", "_start_joinable_thread"):
            monkeypatch.setattr(threading, name, lambda *_, **__: look(), raising=False)
        monkeypatch.setattr(threading.Event, "wait", lambda *_: True)
        threading.Thread(target=print).start()

    assert frame_in(lambda look: look()) == [True]
    assert frame_in(starts) == [False]


def test_what_is_called_when_an_object_goes_is_not_left_half_done():
    class Thing:
        pass

    def goes(look):
        thing = Thing()
        weakref.finalize(thing, look)
        del thing

    assert frame_in(goes) == [False]


@posix
def test_a_signal_is_not_lost_where_c_code_looks_something_up():
    """NumPy asks the class of what it compares for attributes, and discards every exception of that."""
    command = """
import enum, numpy
numbers = []
class Asked(enum.EnumMeta):
    def __getattr__(cls, name):
        numbers.append(name)
        os.kill(os.getpid(), signal.SIGINT)
        return super().__getattr__(name)
class Role(enum.IntEnum, metaclass=Asked):
    GUTTER = 1
numpy.zeros(1) == Role.GUTTER
print(bool(numbers), flush=True)
time.sleep(5)
"""
    assert ended(command) == (130, "True\n", "stopped\n")
