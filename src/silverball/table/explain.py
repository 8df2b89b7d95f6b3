"""Error messages of table files: from pydantic's errors to problems with a path and a remedy.

Each mistake becomes a `Problem` with its path in the file (``triangular_prism[2].vertices``) and a sentence
that says what was expected and what was given. An unknown key gets a suggestion: the key that is spelled
alike, the name used here for another pinball term, or the section to which it belongs.
"""

from __future__ import annotations

import difflib
import json
import re
from typing import Any

from pydantic import BaseModel, ValidationError

from silverball.errors import Problem
from silverball.table.model import field_of, key_of, list_sections, model_of
from silverball.table.quantity import shown

MAX_LISTED = 100  # mistakes that are listed; chosen: more than a person fixes at once

# Other words for the keys of a table file; the first key that the section has is suggested.
SYNONYMS: dict[str, tuple[str, ...]] = {
    "angle": ("rotation", "rest_angle", "slope"),
    "ball": ("board",),
    "ball_save": ("save",),
    "balls": ("max_balls",),
    "bank_name": ("bank",),
    "bat": ("paddle",),
    "boost": ("speed_factor",),
    "bounce": ("restitution", "wall_restitution"),
    "bounciness": ("restitution", "wall_restitution"),
    "bumper": ("cylinder",),
    "capture": ("capture_speed", "hole"),
    "centre": ("center",),
    "chain": ("wall",),
    "circle": ("cylinder",),
    "circumradius": ("size",),
    "colour": ("color",),
    "corners": ("vertices", "points"),
    "curve": ("wall",),
    "diameter": ("radius", "ball_radius"),
    "diverter": ("gate",),
    "drain": ("gutter", "drain", "hole"),
    "droptarget": ("drop_target",),
    "duration": ("seconds",),
    "eject": ("hole",),
    "ejecthole": ("hole",),
    "elasticity": ("restitution", "wall_restitution"),
    "elasticity_falloff": ("restitution_falloff",),
    "file": ("mesh",),
    "flipper": ("paddle",),
    "force": ("kick",),
    "from": ("start",),
    "group_name": ("group",),
    "guide": ("slant_wall",),
    "initial": ("begins",),
    "insert": ("lamp",),
    "jackpot": ("award",),
    "kicker": ("hole", "kick"),
    "lane": ("wall", "rollover"),
    "launcher": ("plunger",),
    "layer": ("level",),
    "max_speed": ("speed_cap",),
    "mission": ("mode",),
    "model": ("mesh",),
    "multiplier": ("times",),
    "nudge": ("jitter",),
    "one_way": ("passes", "gate"),
    "outhole": ("hole",),
    "peg": ("post",),
    "playfield": ("board",),
    "points": ("award",),
    "polygon": ("wall",),
    "pos": ("center", "pivot", "start", "position"),
    "position": ("center", "pivot", "start", "position"),
    "power": ("kick",),
    "prism": ("triangular_prism", "triangular_prisms"),
    "prisms": ("triangular_prisms", "triangular_prism"),
    "radius": ("ball_radius", "size"),
    "ramp": ("passage", "level"),
    "reduction": ("speed_factor",),
    "rubber": ("wall", "post"),
    "saucer": ("hole",),
    "scatter": ("spread",),
    "scoop": ("hole",),
    "score": ("points", "award"),
    "sensor": ("rollover",),
    "shooter": ("plunger",),
    "show": ("cue",),
    "sink": ("hole",),
    "sling": ("slingshot",),
    "sound": ("cue",),
    "speed_limit": ("speed_cap",),
    "spinner_gate": ("spinner",),
    "standup": ("target",),
    "standup_target": ("target",),
    "strength": ("kick",),
    "switch": ("rollover", "on_hit"),
    "table": ("board",),
    "teleporter": ("hole",),
    "text": ("message",),
    "thickness": ("wall_thickness", "base"),
    "threshold": ("hit_speed",),
    "tilt": ("slope",),
    "timer": ("mode",),
    "title": ("name",),
    "to": ("end",),
    "triangle": ("triangular_prism",),
    "trigger": ("rollover", "on_hit"),
    "trough": ("hole",),
    "upper_playfield": ("level",),
    "value": ("points",),
    "variable": ("counter",),
    "version": ("format",),
    "vuk": ("hole",),
    "width": ("base", "thickness"),
    "wireform": ("passage",),
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
    field = field_of(_model_at(location[:-1], root), str(location[-1]))
    return (field.description if field else None) or str(location[-1])


def _model_at(location: tuple[str | int, ...], root: type[BaseModel]) -> type[BaseModel]:
    """The model of a section of the file."""
    model = root
    for step in location:
        field = field_of(model, step) if isinstance(step, str) else None
        model = (model_of(field) if field else None) or model
    return model


def _unknown_key(location: tuple[str | int, ...], root: type[BaseModel]) -> str:
    """Return a suggestion for a key that the section does not have."""
    key = str(location[-1])
    here = _model_at(location[:-1], root)
    kinds = list_sections(root)
    known = [key_of(here, name) for name in here.model_fields]
    word = key.lower().replace("-", "_")
    if word in known:
        return f"unknown key: did you mean `{word}`?"
    meanings = SYNONYMS.get(word) or SYNONYMS.get(word.removesuffix("s")) or ()
    for ours in meanings:
        if ours in known:
            return f"unknown key: did you mean `{ours}`? That is its name here"
        if ours in kinds:
            return f"unknown key: did you mean a part of its own, under [[{ours}]]?"
    close = difflib.get_close_matches(word[:60], known, n=1)
    if close:
        return f"unknown key: did you mean `{close[0]}`?"
    sections = {name: model_of(field) for name, field in root.model_fields.items()}
    for section, model in sections.items():
        if model is None or section in kinds or location[0] == section:
            continue
        if word in model.model_fields:
            return f"unknown key: `{word}` belongs in [{section}]"
    for section, part in kinds.items():
        if word in part.model_fields and location[0] not in (section, "random"):
            return f"unknown key: `{word}` belongs in a part, for example [[{section}]]"
    return f"unknown key: known here are {', '.join(known)}"
