"""How kernels are linked: only the kernel itself is visible in its machine code.

Numba links every callee into its caller as a weak symbol that another module may replace, so LLVM has to keep
its signature and its unused arguments. And it makes machine code of every function, also of those that only
other kernels call, each of which contains its own callees once more. Here

* a kernel's callees become internal when the kernel is optimized: play is a tenth faster;
* a function that only kernels call is kept as bitcode, for linking: a tenth less to compile.

Where Numba's classes have changed, its own linkage is used.

Symbols are named by the function and its argument types. In Numba's names a record type is a number that
counts the types of a process, so code of two types, cached by two processes, can have one name, and the
linker would take one for the other. `NamedCompiler` adds a hash of the types themselves.
"""

from __future__ import annotations

import functools
import gc
import hashlib
from typing import Any, cast

from llvmlite import binding as untyped_binding
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import Compiler

binding, Library, Pipeline = cast(Any, untyped_binding), cast(Any, JITCodeLibrary), cast(Any, Compiler)
ENVIRONMENT = "_ZN08NumbaEnv"  # how the names of the variables begin that Numba sets by address

can_link: bool = all(
    hasattr(owner, name)
    for owner, names in (
        (Library, ("_optimize_final_module", "_finalize_final_module", "_finalize_dynamic_globals")),
        (Library, ("_get_module_for_linking", "enable_object_caching")),
        (Pipeline, ("compile_extra",)),
    )
    for name in names
)
"""Whether this version of Numba has what is changed here."""


def make_internal(code: Any) -> None:
    """Make the callees of a kernel internal.

    The loader confuses an internal function with one of the same name in code that is not compiled here, such
    as a `numba.njit` function that calls kernels. LLVM may have changed its arguments, so it gets a new name.
    """
    for function in code.functions:
        if not function.is_declaration and function.linkage.name == "linkonce_odr":
            function.linkage = "internal"
            function.name += ".internal"


class KernelLibrary(Library):  # type: ignore[misc,valid-type]
    """The code of a kernel that Python may call."""

    def _optimize_final_module(self) -> None:
        make_internal(self._final_module)
        super()._optimize_final_module()


class HelperLibrary(Library):  # type: ignore[misc,valid-type]
    """The code of a function that only kernels call: bitcode, for linking, and no machine code."""

    _final_module: Any
    _shared_module: Any

    def _optimize_final_module(self) -> None:
        """Leave it to the kernels that contain it, so that it is optimized once."""

    def _finalize_final_module(self) -> None:
        self._finalize_dynamic_globals()
        code = self._final_module
        for function in code.functions:
            if not function.is_declaration and function.linkage.name == "external":
                function.linkage = "linkonce_odr"
        self._shared_module = code  # what callers link
        environments = [str(one) for one in code.global_variables if one.name.startswith(ENVIRONMENT)]
        target = [f'target triple = "{code.triple}"', f'target datalayout = "{code.data_layout}"']
        self._final_module = binding.parse_assembly("\n".join(target + environments))
        self._final_module.name = code.name
        super()._finalize_final_module()


@functools.cache
def hash_of_type(one: Any) -> str:
    """Compute a hash of what a type consists of, the same in every process."""
    return hashlib.sha256(str(one).encode()).hexdigest()


class NamedCompiler(Pipeline):  # type: ignore[misc,valid-type]
    """Compiles functions under names that say the same in every process."""

    def compile_extra(self, function: Any) -> Any:
        """Compile a function under its name and a hash of its argument types."""
        name = function.__qualname__
        types = hashlib.sha256("".join(map(hash_of_type, self.state.args)).encode()).hexdigest()[:16]
        function.__qualname__ = f"{name}_{types}"
        is_collecting = gc.isenabled()
        gc.disable()  # there is next to no garbage, and looking for it takes a tenth of the time
        try:
            return super().compile_extra(function)
        finally:
            function.__qualname__ = name
            if is_collecting:
                gc.enable()


class KernelCompiler(NamedCompiler):
    """Compiles kernels that Python may call."""

    library = KernelLibrary

    def compile_extra(self, function: Any) -> Any:
        """Compile a function into a library of this class."""
        self.state.library = self.library(self.state.targetctx.codegen(), function.__qualname__)
        self.state.library.enable_object_caching()
        return super().compile_extra(function)


class HelperCompiler(KernelCompiler):
    """Compiles functions that only kernels call."""

    library = HelperLibrary
