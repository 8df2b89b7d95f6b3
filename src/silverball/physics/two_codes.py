"""Functions that are compiled from one of two codes, chosen by the types of their arguments.

A kernel that calls such a function has the code of one of them only; nothing is chosen while it runs.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable
from functools import wraps
from typing import Any, TypeVar, cast

from silverball.physics.kernel import SETTINGS

F = TypeVar("F", bound=Callable[..., Any])


def two_codes(
    otherwise: Callable[..., Any],
    ending: str,
    is_otherwise: Callable[[tuple[Any, ...]], bool],
    is_otherwise_interpreted: Callable[[tuple[Any, ...]], bool],
) -> Callable[[F], F]:
    """Decorate a compiled function that has another code for some types of arguments.

    Args:
        otherwise: The other code. It has the same parameters and is not compiled itself; a kernel is
            compiled with its code.
        ending: Of its name. Symbols have names that no two functions may share (see linkage.py), and
            `otherwise` may be a <lambda>.
        is_otherwise: Whether arguments of these Numba types get the other code.
        is_otherwise_interpreted: The same of the arguments themselves, when nothing is compiled.

    Raises:
        TypeError: The parameters differ.
    """

    def decorate(function: F) -> F:
        names, others = list(inspect.signature(function).parameters), inspect.signature(otherwise).parameters
        if names != list(others):
            raise TypeError(f"{function.__name__}: `otherwise` must have the parameters {names}")
        if SETTINGS.DISABLE_JIT:

            @wraps(function)
            def choose(*arguments: Any) -> Any:
                return (otherwise if is_otherwise_interpreted(arguments) else function)(*arguments)

            return cast(F, choose)
        compiled = cast(Any, function)
        otherwise.__name__ = otherwise.__qualname__ = f"{function.__name__}_{ending}"

        def implementation(argument_types: tuple[Any, ...], _: Any) -> Callable[..., Any]:
            return otherwise if is_otherwise(argument_types) else cast(Callable[..., Any], compiled.py_func)

        # Numba asks here which Python function to compile; see `numba.core.dispatcher._FunctionCompiler`.
        compiled._compiler._get_implementation = implementation
        return function

    return decorate
