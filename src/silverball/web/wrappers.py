"""LLVM's text around the kernels: a plain function for each export, and the functions that kernels lack.

A page calls with 32-bit integers and 64-bit floats alone. So each export gets a wrapper, which makes of them
what Numba's code expects:

    array      its address and its lengths       record    its address
    integer    itself, of 32 bits                tuple     its items, one after the other
    boolean    an integer                        float     itself

An integer is returned; a tuple is written to an address, which is the first parameter, as 64-bit items.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, cast

from numba.core import types as untyped_types

types = cast(Any, untyped_types)
WORD = 8  # bytes of an integer, a float or a boolean's place in a record


class _Wrapper:
    """The text of one wrapper, as it is written."""

    def __init__(self) -> None:
        self.parameters: list[str] = []
        self.body: list[str] = []
        self.arguments: list[str] = []  # of the kernel

    def value(self, text: str) -> str:
        """Add an instruction and return the name of its result."""
        name = f"%t{len(self.body)}"
        self.body.append(f"  {name} = {text}")
        return name

    def parameter(self, kind: str) -> str:
        """Add a parameter of a type and return its name."""
        name = f"%p{len(self.parameters)}"
        self.parameters.append(f"{kind} {name}")
        return name

    def pointer(self) -> str:
        """Add an address."""
        return self.value(f"inttoptr i32 {self.parameter('i32')} to ptr")

    def add(self, argument: Any) -> None:
        """Add an argument of the kernel, of a Numba type."""
        if isinstance(argument, types.Array):
            self.add_array(argument)
        elif isinstance(argument, types.Record):
            self.arguments.append(f"ptr {self.pointer()}")
        elif isinstance(argument, types.BaseTuple):
            for item in argument:
                self.add(item)
        elif isinstance(argument, types.Boolean):
            number = self.parameter("i32")
            self.arguments.append("i8 " + self.value(f"trunc i32 {number} to i8"))
        elif isinstance(argument, types.Integer):
            number = self.parameter("i32")
            self.arguments.append("i64 " + self.value(f"sext i32 {number} to i64"))
        elif argument == types.float64:
            self.arguments.append(f"double {self.parameter('double')}")
        else:
            raise TypeError(f"an export has an argument of the type {argument}, which no wrapper knows")

    def add_array(self, argument: Any) -> None:
        """Add an array: owner, parent, number of items, bytes of one, data, lengths and strides."""
        item = _size(argument.dtype)
        data = self.pointer()
        lengths = [self.value(f"zext i32 {self.parameter('i32')} to i64") for _ in range(argument.ndim)]
        strides = [str(item)]
        for length in reversed(lengths[1:]):
            strides.insert(0, self.value(f"mul i64 {strides[0]}, {length}"))
        count = lengths[0]
        for length in lengths[1:]:
            count = self.value(f"mul i64 {count}, {length}")
        self.arguments += ["ptr null", "ptr null", f"i64 {count}", f"i64 {item}", f"ptr {data}"]
        self.arguments += [f"i64 {value}" for value in (*lengths, *strides)]


def wrapper(name: str, symbol: str, arguments: tuple[Any, ...], result: Any) -> str:
    """The text of an export.

    Args:
        name: The name of the export.
        symbol: The symbol of the kernel.
        arguments: The Numba types of its arguments.
        result: That of its result.
    """
    made = _Wrapper()
    is_tuple = isinstance(result, types.BaseTuple)
    room = made.pointer() if is_tuple else made.value("alloca i64")
    error = made.value("alloca ptr")
    for argument in arguments:
        made.add(argument)
    kinds = ", ".join(argument.split()[0] for argument in made.arguments)
    made.value(f'call i32 @"{symbol}"(ptr {room}, ptr {error}, {", ".join(made.arguments)})')
    kind, back = "void", "ret void"
    if isinstance(result, types.Boolean):
        byte = made.value(f"load i8, ptr {room}")
        kind, back = "i32", "ret i32 " + made.value(f"zext i8 {byte} to i32")
    elif isinstance(result, types.Integer):
        wide = made.value(f"load i64, ptr {room}")
        kind, back = "i32", "ret i32 " + made.value(f"trunc i64 {wide} to i32")
    return "\n".join(
        [
            f'declare i32 @"{symbol}"(ptr, ptr, {kinds})',
            f"define {kind} @{name}({', '.join(made.parameters)}) {{",
            *made.body,
            f"  {back}",
            "}\n",
        ]
    )


def _size(item: Any) -> int:
    """The bytes of an item of an array."""
    if isinstance(item, types.Record):
        return int(item.size)
    return int(item.bitwidth) // WORD


def _loop(name: str, parameters: str, result: str, body: str) -> Iterator[str]:
    """A function that does `body` for %i = 0 … %count − 1."""
    yield f'define {result} @{name}({parameters}) noinline "no-builtins" {{'
    yield "entry:"
    yield "  %some = icmp ne i32 %count, 0"
    yield "  br i1 %some, label %loop, label %done"
    yield "loop:"
    yield "  %i = phi i32 [ 0, %entry ], [ %j, %loop ]"
    yield body
    yield "  %j = add i32 %i, 1"
    yield "  %more = icmp ult i32 %j, %count"
    yield "  br i1 %more, label %loop, label %done"
    yield "done:"
    yield f"  ret {result}{' %to' if result == 'ptr' else ''}"
    yield "}\n"


MEMORY = "\n".join(
    (
        *_loop(
            "memset",
            "ptr %to, i32 %value, i32 %count",
            "ptr",
            "  %q = getelementptr i8, ptr %to, i32 %i\n"
            "  %byte = trunc i32 %value to i8\n"
            "  store i8 %byte, ptr %q",
        ),
        *_loop(
            "memcpy",
            "ptr %to, ptr %from, i32 %count",
            "ptr",
            "  %p = getelementptr i8, ptr %from, i32 %i\n"
            "  %q = getelementptr i8, ptr %to, i32 %i\n"
            "  %byte = load i8, ptr %p\n"
            "  store i8 %byte, ptr %q",
        ),
    )
)
"""What LLVM calls by itself. It is linked after the optimization, which would see a memset in memset."""

RGBA = "\n".join(
    _loop(
        "rgba",
        "i32 %rgb, i32 %rgba, i32 %count",
        "void",
        "  %i3 = mul i32 %i, 3\n"
        "  %from = add i32 %rgb, %i3\n"
        "  %i4 = shl i32 %i, 2\n"
        "  %to = add i32 %rgba, %i4\n"
        "  %p = inttoptr i32 %from to ptr\n"
        "  %q = inttoptr i32 %to to ptr\n"
        "  %p1 = getelementptr i8, ptr %p, i32 1\n"
        "  %p2 = getelementptr i8, ptr %p, i32 2\n"
        "  %r = load i8, ptr %p\n"
        "  %g = load i8, ptr %p1\n"
        "  %b = load i8, ptr %p2\n"
        "  %r4 = zext i8 %r to i32\n"
        "  %g4 = zext i8 %g to i32\n"
        "  %b4 = zext i8 %b to i32\n"
        "  %g8 = shl i32 %g4, 8\n"
        "  %b8 = shl i32 %b4, 16\n"
        "  %rg = or i32 %r4, %g8\n"
        "  %gb = or i32 %rg, %b8\n"
        "  %all = or i32 %gb, -16777216\n"
        "  store i32 %all, ptr %q",
    )
)
"""The export `rgba`: the RGB of a frame into the RGBA of a canvas."""

FLOATS = """
declare double @llvm.fabs.f64(double)
define double @numba_frexp(double %x, ptr %exponent) {
  %size = call double @llvm.fabs.f64(double %x)
  %tiny = fcmp olt double %size, 0x0010000000000000
  %scaled = fmul double %x, 0x43F0000000000000
  %y = select i1 %tiny, double %scaled, double %x
  %bias = select i1 %tiny, i32 1086, i32 1022
  %bits = bitcast double %y to i64
  %shifted = lshr i64 %bits, 52
  %wide = and i64 %shifted, 2047
  %stored = trunc i64 %wide to i32
  %zero = fcmp oeq double %x, 0.0
  %strange = icmp eq i32 %stored, 2047
  %kept = or i1 %zero, %strange
  %true = sub i32 %stored, %bias
  %found = select i1 %kept, i32 0, i32 %true
  store i32 %found, ptr %exponent
  %rest = and i64 %bits, -9218868437227405313
  %half = or i64 %rest, 4602678819172646912
  %mantissa = bitcast i64 %half to double
  %result = select i1 %kept, double %x, double %mantissa
  ret double %result
}
define internal { double, i32 } @scaled(double %x, i32 %power) alwaysinline {
  %large = icmp sgt i32 %power, 1023
  %small = icmp slt i32 %power, -1022
  %up = fmul double %x, 0x7FE0000000000000
  %down = fmul double %x, 0x0360000000000000
  %less = sub i32 %power, 1023
  %more = add i32 %power, 969
  %y = select i1 %large, double %up, double %x
  %p = select i1 %large, i32 %less, i32 %power
  %z = select i1 %small, double %down, double %y
  %q = select i1 %small, i32 %more, i32 %p
  %one = insertvalue { double, i32 } poison, double %z, 0
  %two = insertvalue { double, i32 } %one, i32 %q, 1
  ret { double, i32 } %two
}
define double @numba_ldexp(double %x, i32 %power) {
  %first = call { double, i32 } @scaled(double %x, i32 %power)
  %x1 = extractvalue { double, i32 } %first, 0
  %p1 = extractvalue { double, i32 } %first, 1
  %second = call { double, i32 } @scaled(double %x1, i32 %p1)
  %x2 = extractvalue { double, i32 } %second, 0
  %p2 = extractvalue { double, i32 } %second, 1
  %high = icmp sgt i32 %p2, 1023
  %capped = select i1 %high, i32 1023, i32 %p2
  %low = icmp slt i32 %capped, -1022
  %power2 = select i1 %low, i32 -1022, i32 %capped
  %biased = add i32 %power2, 1023
  %wide = zext i32 %biased to i64
  %bits = shl i64 %wide, 52
  %factor = bitcast i64 %bits to double
  %result = fmul double %x2, %factor
  ret double %result
}
"""
"""Numba's own functions of C: `frexp`, and `ldexp`, which scales in three steps.

The step down is 2⁻⁹⁶⁹ and not 2⁻¹⁰²²: 53 bits more than the least exponent, so that only the last
multiplication rounds.
"""
