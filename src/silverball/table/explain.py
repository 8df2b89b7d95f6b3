"""Error messages of table files: from pydantic's errors to problems with a path and a remedy.

Each mistake becomes a `Problem` with its path in the file (``triangular_prism[2].vertices``) and a sentence
that says what was expected and what was given. An unknown key gets a suggestion: the key that is spelled
alike, the name used here for another pinball term, or the section to which it belongs.
"""

from __future__ import annotations

import difflib
import json
import re
from typing import Any, get_args

from pydantic import BaseModel, ValidationError

from silverball.errors import Problem
from silverball.table.parts import PART_KINDS, Arcade, Board, RandomRecipe
from silverball.table.quantity import shown

MAX_LISTED = 100  # mistakes that are listed; chosen: more than a person fixes at once

# Other words for the keys of a table file; the first key that the section has is suggested.
SYNONYMS: dict[str, tuple[str, ...]] = {
    "angle": ("rotation", "rest_angle", "slope"),
    "ball": ("board",),
    "balls": ("max_balls",),
    "bat": ("paddle",),
    "boost": ("speed_factor",),
    "bounce": ("restitution", "wall_restitution"),
    "bounciness": ("restitution", "wall_restitution"),
    "bumper": ("cylinder",),
    "centre": ("center",),
    "circle": ("cylinder",),
    "circumradius": ("size",),
    "corners": ("vertices",),
    "diameter": ("radius", "ball_radius"),
    "drain": ("gutter",),
    "elasticity": ("restitution", "wall_restitution"),
    "file": ("mesh",),
    "flipper": ("paddle",),
    "from": ("start",),
    "guide": ("slant_wall",),
    "max_speed": ("speed_cap",),
    "model": ("mesh",),
    "nudge": ("jitter",),
    "playfield": ("board",),
    "position": ("center", "pivot", "start"),
    "post": ("cylinder",),
    "prism": ("triangular_prism", "triangular_prisms"),
    "prisms": ("triangular_prisms", "triangular_prism"),
    "pos": ("center", "pivot", "start"),
    "radius": ("ball_radius", "size"),
    "reduction": ("speed_factor",),
    "score": ("points",),
    "sling": ("triangular_prism",),
    "slingshot": ("triangular_prism",),
    "speed_limit": ("speed_cap",),
    "table": ("board",),
    "thickness": ("wall_thickness", "base"),
    "tilt": ("slope",),
    "title": ("name",),
    "to": ("end",),
    "triangle": ("triangular_prism",),
    "value": ("points",),
    "version": ("format",),
    "wall": ("slant_wall",),
    "width": ("base", "thickness"),
}

_BARE_KEY = re.compile(r"[A-Za-z0-9_-]{1,60}\Z")


def path_of(location: tuple[str | int, ...]) -> str:
    """Return the path of a place in the file: ``triangular_prism[2].vertices``."""
    path = ""
    for step in location:
        if isinstance(step, int):
            path += f"[{step}]"
        else:
            key = step if _BARE_KEY.match(step) else json.dumps(step[:60], ensure_ascii=False)
            path += f".{key}" if path else key
    return path


def explain(error: ValidationError, root: type[BaseModel]) -> list[Problem]:
    """Turn every mistake that pydantic found into a problem, in the order of the file's sections.

    Args:
        error: What validating the data of a file raised.
        root: The model of the whole file.
    """
    details = error.errors(include_url=False)
    problems = [
        Problem(path_of(detail["loc"]), _message(dict(detail), root)) for detail in details[:MAX_LISTED]
    ]
    if len(details) > MAX_LISTED:
        problems.append(Problem("", f"and {len(details) - MAX_LISTED:,} more problems of this kind"))
    return problems


def _message(detail: dict[str, Any], root: type[BaseModel]) -> str:
    """Return a sentence for one of pydantic's error details."""
    location, given, context = detail["loc"], shown(detail["input"]), detail.get("ctx", {})
    match detail["type"]:
        case "silverball":
            return str(context["message"])
        case "missing":
            return f"must be given: {_description(location, root)}"
        case "extra_forbidden":
            return _unknown_key(location, root)
        case "literal_error":
            return f"must be {context['expected']}, got {given}"
        case "string_type":
            return f"must be text in quotes, got {given}"
        case "string_too_long":
            return f"must have at most {context['max_length']} characters, got {len(detail['input'])}"
        case "string_too_short":
            return "must not be empty"
        case "bool_type":
            return f"must be true or false, got {given}"
        case "too_long":
            return f"must have at most {context['max_length']} parts, got {len(detail['input'])}"
        case "tuple_type":
            return f"must be a list of parts, each under [[{location[-1]}]] with two brackets, got {given}"
        case "model_type" | "model_attributes_type":
            return f"must be a section with keys and values, got {given}"
        case _:
            return f"{detail['msg']}, got {given}"


def _description(location: tuple[str | int, ...], root: type[BaseModel]) -> str:
    """The description of a field, from the model that holds it."""
    field = _model_at(location[:-1], root).model_fields[str(location[-1])]
    return field.description or str(location[-1])


def _model_at(location: tuple[str | int, ...], root: type[BaseModel]) -> type[BaseModel]:
    """The model of a section of the file."""
    model = root
    for step in location:
        if isinstance(step, str) and step in PART_KINDS and model is root:
            model = PART_KINDS[step]
        elif isinstance(step, str):
            model = _section(model, step)
    return model


def _section(model: type[BaseModel], key: str) -> type[BaseModel]:
    """The model of a section inside another one."""
    annotation = model.model_fields[key].annotation
    for kind in (annotation, *get_args(annotation)):  # a section that may be missing is `Model | None`
        if isinstance(kind, type) and issubclass(kind, BaseModel):
            return kind
    return model


def _unknown_key(location: tuple[str | int, ...], root: type[BaseModel]) -> str:
    """Return a suggestion for a key that the section does not have."""
    key = str(location[-1])
    known = list(_model_at(location[:-1], root).model_fields)
    word = key.lower().replace("-", "_")
    if word in known:
        return f"unknown key: did you mean `{word}`?"
    meanings = SYNONYMS.get(word) or SYNONYMS.get(word.removesuffix("s")) or ()
    for ours in meanings:
        if ours in known:
            return f"unknown key: did you mean `{ours}`? That is its name here"
        if ours in PART_KINDS:
            return f"unknown key: did you mean a part of its own, under [[{ours}]]?"
    close = difflib.get_close_matches(word[:60], known, n=1)
    if close:
        return f"unknown key: did you mean `{close[0]}`?"
    for section, model in (("board", Board), ("random", RandomRecipe), ("arcade", Arcade)):
        if word in model.model_fields and location[0] != section:
            return f"unknown key: `{word}` belongs in [{section}]"
    for section, part in PART_KINDS.items():
        if word in part.model_fields and location[0] not in (section, "random"):
            return f"unknown key: `{word}` belongs in a part, for example [[{section}]]"
    return f"unknown key: known here are {', '.join(known)}"
