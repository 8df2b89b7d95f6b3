"""The kinds of parts that a table may have: one file a kind, each part a model that knows its primitives.

A new kind is one file here, with its model, its docstring for the reference and its `primitives`, its name
below and one field of `Table`. Whatever reads a table reads the primitives (see `expand.py`).
"""

from silverball.table.kinds.board import Board
from silverball.table.kinds.cylinder import Cylinder, CylinderSurface
from silverball.table.kinds.gate import Gate
from silverball.table.kinds.hole import Hole
from silverball.table.kinds.level import Level, Passage
from silverball.table.kinds.paddle import Paddle
from silverball.table.kinds.plunger import Plunger
from silverball.table.kinds.post import Post
from silverball.table.kinds.rollover import Rollover
from silverball.table.kinds.slant_wall import SlantWall
from silverball.table.kinds.slingshot import Slingshot
from silverball.table.kinds.spinner import Spinner
from silverball.table.kinds.target import DropTarget, Target
from silverball.table.kinds.triangular_prism import PrismSurface, TriangularPrism
from silverball.table.kinds.wall import Wall

__all__ = [
    "Board",
    "Cylinder",
    "CylinderSurface",
    "DropTarget",
    "Gate",
    "Hole",
    "Level",
    "Paddle",
    "Passage",
    "Plunger",
    "Post",
    "PrismSurface",
    "Rollover",
    "SlantWall",
    "Slingshot",
    "Spinner",
    "Target",
    "TriangularPrism",
    "Wall",
]
