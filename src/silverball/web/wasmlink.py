"""Makes a whole WebAssembly module of the one object that LLVM writes: a linker for modules of one object.

Such an object is nearly a module: its indices are right among themselves, and its data lies from address 0
on. It imports its memory and its stack pointer, though, and exports nothing. `link` gives it both, drops what
only linkers read, and adds custom sections.

    address 0: data | stack (grows down) | heap: from here on memory is the page's

Source: the WebAssembly core specification 1.0, section 5 (binary format); the symbol table is described in
https://github.com/WebAssembly/tool-conventions/blob/main/Linking.md.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

PAGE = 65536  # bytes of a page of memory
STACK = 65536  # bytes
MAGIC = b"\0asm\1\0\0\0"
CUSTOM, TYPE, IMPORT, FUNCTION, TABLE, MEMORY, GLOBAL, EXPORT, START, ELEMENT, CODE, DATA, COUNT = range(13)
ORDER = (TYPE, IMPORT, FUNCTION, TABLE, MEMORY, GLOBAL, EXPORT, START, ELEMENT, COUNT, CODE, DATA)
SYMBOL_TABLE = 8  # a part of the section "linking"
FUNCTION_SYMBOL, DATA_SYMBOL, SECTION_SYMBOL = 0, 1, 3
UNDEFINED, HAS_NAME = 0x10, 0x40  # flags of symbols
I32_CONST, END, I32 = b"\x41", b"\x0b", b"\x7f"
FIXED, VARIABLE = b"\0", b"\1"


class LinkError(Exception):
    """An object is not of the kind that `link` can make a module of."""


def unsigned(number: int) -> bytes:
    """An unsigned LEB128 number."""
    out = bytearray()
    while True:
        number, low = number >> 7, number & 0x7F
        out.append(low | (0x80 if number else 0))
        if not number:
            return bytes(out)


def signed(number: int) -> bytes:
    """A signed LEB128 number."""
    out = bytearray()
    while True:
        low, number = number & 0x7F, number >> 7
        is_last = (number == 0 and not low & 0x40) or (number == -1 and low & 0x40 != 0)
        out.append(low | (0 if is_last else 0x80))
        if is_last:
            return bytes(out)


def text(name: str) -> bytes:
    """A name: its length and its bytes."""
    return unsigned(len(name.encode())) + name.encode()


class Reader:
    """Reads bytes one after the other."""

    def __init__(self, data: bytes, at: int = 0) -> None:
        self.data, self.at = data, at

    @property
    def is_done(self) -> bool:
        """Whether nothing is left."""
        return self.at >= len(self.data)

    def byte(self) -> int:
        """The next byte."""
        self.at += 1
        return self.data[self.at - 1]

    def number(self) -> int:
        """An unsigned LEB128 number."""
        found = shift = 0
        while True:
            byte = self.byte()
            found |= (byte & 0x7F) << shift
            shift += 7
            if not byte & 0x80:
                return found

    def take(self, count: int) -> bytes:
        """The next bytes."""
        self.at += count
        return self.data[self.at - count : self.at]

    def name(self) -> str:
        """A name."""
        return self.take(self.number()).decode()

    def limits(self) -> None:
        """Skip the limits of a table or a memory."""
        for _ in range(1 + (self.byte() & 1)):
            self.number()


def sections(module: bytes) -> tuple[dict[int, bytes], dict[str, bytes]]:
    """The sections of a module by their numbers, and its custom ones by their names."""
    if module[:8] != MAGIC:
        raise LinkError("this is no WebAssembly module of version 1")
    reader = Reader(module, len(MAGIC))
    plain: dict[int, bytes] = {}
    custom: dict[str, bytes] = {}
    while not reader.is_done:
        kind = reader.byte()
        body = Reader(reader.take(reader.number()))
        if kind == CUSTOM:
            name = body.name()
            custom[name] = body.data[body.at :]
        else:
            plain[kind] = body.data
    return plain, custom


def imported(section: bytes) -> dict[int, list[str]]:
    """The names that an import section asks for, by kind: functions, tables, memories, globals."""
    reader, found = Reader(section), {kind: [] for kind in range(4)}  # type: ignore[var-annotated]
    for _ in range(reader.number()):
        reader.name()
        name, kind = reader.name(), reader.byte()
        found[kind].append(name)
        if kind == 0:
            reader.number()
        elif kind == 1:
            reader.byte()
            reader.limits()
        elif kind == 2:
            reader.limits()
        else:
            reader.take(2)
    return found


def function_symbols(linking: bytes) -> dict[str, int]:
    """The numbers of functions by their symbols, from the section "linking"."""
    reader, found = Reader(linking), {}
    if reader.number() != 2:
        raise LinkError("the section 'linking' is not of version 2")
    while not reader.is_done:
        kind = reader.byte()
        part = Reader(reader.take(reader.number()))
        if kind != SYMBOL_TABLE:
            continue
        for _ in range(part.number()):
            what, flags = part.byte(), part.number()
            is_undefined = flags & UNDEFINED != 0
            if what == DATA_SYMBOL:
                part.name()
                for _ in range(0 if is_undefined else 3):
                    part.number()
            elif what == SECTION_SYMBOL:
                part.number()
            else:
                index = part.number()
                name = part.name() if not is_undefined or flags & HAS_NAME else ""
                if what == FUNCTION_SYMBOL and name:
                    found[name] = index
    return found


def data_end(section: bytes) -> int:
    """The first address behind all data."""
    reader, end = Reader(section), 0
    for _ in range(reader.number() if section else 0):
        if reader.number() != 0 or reader.byte() != I32_CONST[0]:
            raise LinkError("data must have fixed addresses in the one memory")
        offset = reader.number()
        reader.byte()
        end = max(end, offset + len(reader.take(reader.number())))
    return end


def link(module: bytes, exports: Sequence[str], custom: Mapping[str, bytes]) -> bytes:
    """Make a module of an object.

    Args:
        module: The object.
        exports: The symbols of the functions to export. Two more exports are `memory`, and the constant
            `heap`: the first free address.
        custom: Custom sections by their names.

    Raises:
        LinkError: The object needs functions from outside, or calls functions by address.
    """
    plain, notes = sections(module)
    wanted = imported(plain.pop(IMPORT))
    if wanted[0] or not set(wanted[2]) <= {"__linear_memory"} or not set(wanted[3]) <= {"__stack_pointer"}:
        raise LinkError(f"the object must be complete, but imports {wanted}")
    if ELEMENT in plain:
        raise LinkError("the object must not call functions by address")
    top = (data_end(plain.get(DATA, b"")) + 15) // 16 * 16 + STACK
    plain[MEMORY] = unsigned(1) + FIXED + unsigned(-(-top // PAGE))
    start = I32_CONST + signed(top) + END
    pointers = len(wanted[3])  # the stack pointer, if there is any stack
    plain[GLOBAL] = unsigned(pointers + 1) + (I32 + VARIABLE + start) * pointers + I32 + FIXED + start
    symbols = function_symbols(notes["linking"])
    rows = [(name, 0, symbols[name]) for name in exports] + [("memory", 2, 0), ("heap", 3, pointers)]
    plain[EXPORT] = unsigned(len(rows)) + b"".join(
        text(name) + bytes([kind]) + unsigned(index) for name, kind, index in rows
    )
    out = bytearray(MAGIC)
    for kind in ORDER:
        if kind in plain:
            out += bytes([kind]) + unsigned(len(plain[kind])) + plain[kind]
    for name, content in custom.items():
        body = text(name) + content
        out += bytes([CUSTOM]) + unsigned(len(body)) + body
    return bytes(out)
