"""Builds `silverball.wasm`: the kernels, compiled for a browser from the same Python source.

    python -m silverball.web.build [FILE]

    Numba    each kernel with all it calls, as LLVM's text, not optimized
    LLVM     all texts in one module, with a plain wrapper for each export; optimized and written for wasm32
    link     what is still missing in that object: memory, stack, exports (see `wasmlink.py`)

No linker, no other compiler: Numba and llvmlite can do all of it. The text must not be optimized before it is
told its target, because Numba's optimizer assumes pointers of 64 bits; so the environment says NUMBA_OPT=0
before Numba is loaded, and the work is done in a process of its own. The arithmetic is the same as on every
other machine: 64-bit floats, no reordering, nothing fused. Loops are not vectorized, since WebAssembly 1.0
has no vectors.

The same sources and the same Numba give the same bytes.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Any

from silverball.web.module import NOTE, PATH, Note, source_hash
from silverball.web.wasmlink import link

if TYPE_CHECKING:
    from collections.abc import Iterable

    from silverball.web.exports import Export

TARGET = "wasm32-unknown-unknown"
FEATURES = "+mutable-globals,+sign-ext"  # both are in every browser with WebAssembly
LEVEL = 3  # of optimization
RGBA = "rgba"  # an export that is no kernel
INSIDE = "SILVERBALL_WEB_BUILD"  # set in the process that compiles
ENVIRONMENT = {"NUMBA_OPT": "0", "NUMBA_CPU_NAME": "generic", "NUMBA_CPU_FEATURES": "", INSIDE: "1"}


def build(path: Path = PATH) -> bytes:
    """Build the module in a process of its own, write it to a file, and return its bytes."""
    with tempfile.TemporaryDirectory() as empty:
        environment = os.environ | ENVIRONMENT | {"SILVERBALL_CACHE": empty}
        command = [sys.executable, "-m", "silverball.web.build", os.fspath(path)]
        subprocess.run(command, env=environment, check=True)
    return path.read_bytes()


def compile_module() -> bytes:
    """Compile all exports to a module; for a process that was started with `ENVIRONMENT`."""
    import llvmlite
    import llvmlite.binding as untyped_llvm
    import numba

    from silverball.web.exports import exports
    from silverball.web.wrappers import FLOATS, MEMORY, RGBA as RGBA_TEXT, wrapper

    llvm: Any = untyped_llvm
    llvm.initialize_all_targets()
    llvm.initialize_all_asmprinters()
    machine = llvm.Target.from_triple(TARGET).create_target_machine(
        cpu="mvp", features=FEATURES, opt=LEVEL, reloc="static", codemodel="default"
    )
    head = f'target triple = "{TARGET}"\ntarget datalayout = "{machine.target_data}"\n'
    whole = llvm.parse_assembly(head)
    wrappers = []
    _keep_unoptimized()
    for one in exports():
        text, symbol, types, result = _compiled(one)
        whole.link_in(_shareable(llvm.parse_assembly(head + text), symbol))
        wrappers.append(wrapper(one.name, symbol, types, result))
    for text in (*wrappers, FLOATS, RGBA_TEXT):
        whole.link_in(llvm.parse_assembly(head + text))
    names = [*(one.name for one in exports()), RGBA]
    _hide((*whole.functions, *whole.global_variables), names)
    whole.verify()
    _optimize(llvm, machine, whole)
    whole.link_in(llvm.parse_assembly(head + MEMORY))
    note = Note(source_hash(), numba.__version__, llvmlite.__version__)
    return link(machine.emit_object(whole), names, {NOTE: note.to_bytes()})


def _keep_unoptimized() -> None:
    """Leave the text of kernels as Numba writes it: functions that call each other."""
    from silverball.physics.linkage import KernelLibrary

    KernelLibrary._optimize_final_module = lambda self: None  # type: ignore[method-assign]


def _compiled(export: Export) -> tuple[str, str, tuple[Any, ...], Any]:
    """A kernel as LLVM's text without a target, its symbol, and the types of its arguments and result."""
    from numba import typeof as untyped_typeof

    typeof: Any = untyped_typeof
    kernel: Any = export.kernel
    types = tuple(typeof(argument) for argument in export.arguments)
    kernel.compile(types)
    found = kernel.overloads[types]
    lines = kernel.inspect_llvm(types).splitlines()
    text = "\n".join(_portable(line) for line in lines if not line.startswith("target "))
    return text, found.fndesc.llvm_func_name, types, found.signature.return_type


def _portable(line: str) -> str:
    """A line without what only Numba's loader understands; instructions in place of functions of C."""
    line = line.replace("common local_unnamed_addr global", "global").replace("common global", "global")
    # At level 0 Numba marks everything; inlined, the code is three times as large and runs half as fast.
    line = line.replace("alwaysinline", "nounwind")
    return line.replace("@sqrt(", "@llvm.sqrt.f64(").replace("@floor(", "@llvm.floor.f64(")


def _shareable(module: Any, symbol: str) -> Any:
    """Let all functions but the kernel itself be there several times, in the texts of several kernels."""
    for thing in (*module.functions, *module.global_variables):
        if not thing.is_declaration and thing.name != symbol:
            thing.linkage = "linkonce_odr"
    return module


def _hide(things: Iterable[Any], names: Iterable[str]) -> None:
    """Make everything internal that is not exported, so that the optimizer may change or drop it."""
    kept = set(names)
    for thing in things:
        if not thing.is_declaration and thing.name not in kept:
            thing.linkage = "internal"


def _optimize(llvm: Any, machine: Any, module: Any) -> None:
    options = llvm.create_pipeline_tuning_options(LEVEL)
    options.loop_vectorization = options.slp_vectorization = False
    builder = llvm.create_pass_builder(machine, options)
    builder.getModulePassManager().run(module, builder)


def main() -> None:
    """Build the module and say how large it is."""
    path = Path(sys.argv[1]) if len(sys.argv) > 1 else PATH
    if os.environ.get(INSIDE):
        path.write_bytes(compile_module())
    else:
        print(f"{path}: {len(build(path)):,} bytes")


if __name__ == "__main__":
    main()
