"""Pinball tables as data: parts, files, checks, and random boards made of recipes."""

from silverball.table import parts as parts
from silverball.table.arcade import Arcade
from silverball.table.expand import Expansion, expand
from silverball.table.file import dump_table, load_table, parse_table, save_table, table_digest, table_names
from silverball.table.generate import generate_table
from silverball.table.kinds import (
    Board,
    Cylinder,
    CylinderSurface,
    Paddle,
    PrismSurface,
    SlantWall,
    TriangularPrism,
)
from silverball.table.reach import ball_places
from silverball.table.recipe import RandomRecipe
from silverball.table.table import Table, check_table

__all__ = [
    "Arcade",
    "Board",
    "Cylinder",
    "CylinderSurface",
    "Expansion",
    "Paddle",
    "PrismSurface",
    "RandomRecipe",
    "SlantWall",
    "Table",
    "TriangularPrism",
    "ball_places",
    "check_table",
    "dump_table",
    "expand",
    "generate_table",
    "load_table",
    "parse_table",
    "save_table",
    "table_digest",
    "table_names",
]
