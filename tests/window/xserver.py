"""A private X server, and its keyboard layout."""

from __future__ import annotations

import ctypes
import ctypes.util
import os
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from patience import PATIENCE


@contextmanager
def x_server(width: int, height: int) -> Iterator[str]:
    """Xvfb with one screen of this size; its name, as in DISPLAY."""
    read, write = os.pipe()
    screen = f"{width}x{height}x24"
    command = ["Xvfb", "-displayfd", str(write), "-screen", "0", screen, "-noreset", "-nolisten", "tcp"]
    server = subprocess.Popen(command, pass_fds=(write,), stderr=subprocess.DEVNULL)
    os.close(write)
    with os.fdopen(read) as number:
        name = f":{number.readline().strip()}"
    try:
        yield name
    finally:
        server.terminate()
        server.wait()


def signs(display: str) -> dict[int, str]:
    """What the keys of the main block bear without Shift, by X's numbers: the server says it.

    A row of digits that bears none is left out: SDL takes it for digits all the same.
    """
    x11 = ctypes.CDLL(ctypes.util.find_library("X11"))
    xkb = ctypes.CDLL(ctypes.util.find_library("xkbcommon"))
    x11.XOpenDisplay.restype = ctypes.c_void_p
    x11.XCloseDisplay.argtypes = (ctypes.c_void_p,)
    x11.XkbKeycodeToKeysym.argtypes = (ctypes.c_void_p, ctypes.c_ubyte, ctypes.c_int, ctypes.c_int)
    x11.XkbKeycodeToKeysym.restype = ctypes.c_ulong
    connection = x11.XOpenDisplay(display.encode())
    assert connection, f"{display} does not answer"
    main_block = (*range(10, 22), *range(24, 36), *range(38, 50), *range(51, 62), 94)
    codes = {key: x11.XkbKeycodeToKeysym(connection, key, 0, 0) for key in main_block}
    x11.XCloseDisplay(connection)
    found = {key: xkb.xkb_keysym_to_utf32(code) for key, code in codes.items()}
    has_digits = any(chr(found[key]).isascii() and chr(found[key]).isdigit() for key in range(10, 20))
    return {key: chr(sign) for key, sign in found.items() if sign and (has_digits or key > 19)}


def choose_layout(display: str, layout: str, variant: str = "") -> None:
    """Give the server another keyboard."""
    command = ["setxkbmap", "-display", display, "-layout", layout, "-variant", variant]
    subprocess.run(command, check=True, timeout=PATIENCE)


def all_layouts() -> list[str]:
    """Every layout that xkeyboard-config lists, and every variant, as "us" or "us:dvorak"."""
    try:
        listed = Path("/usr/share/X11/xkb/rules/base.lst").read_text(encoding="utf-8")
    except OSError:
        return []
    parts = {part.split("\n")[0].strip(): part.split("\n")[1:] for part in listed.split("! ")[1:]}
    layouts = [words[0] for line in parts["layout"] if (words := line.split())]
    variants = [f"{words[1].rstrip(':')}:{words[0]}" for line in parts["variant"] if (words := line.split())]
    return [name for name in (*layouts, *variants) if name != "custom"]
