"""Pinball tables as data: parts, files, checks, and random boards made of recipes."""

from silverball.table.file import dump_table, load_table, parse_table, save_table, table_digest, table_names
from silverball.table.generate import generate_table
from silverball.table.parts import (
    Arcade,
    Board,
    Cylinder,
    CylinderSurface,
    Paddle,
    PrismSurface,
    RandomRecipe,
    SlantWall,
    TriangularPrism,
)
from silverball.table.reach import ball_places
from silverball.table.table import Table, check_table

__all__ = [
    "Arcade",
    "Board",
    "Cylinder",
    "CylinderSurface",
    "Paddle",
    "PrismSurface",
    "RandomRecipe",
    "SlantWall",
    "Table",
    "TriangularPrism",
    "ball_places",
    "check_table",
    "dump_table",
    "generate_table",
    "load_table",
    "parse_table",
    "save_table",
    "table_digest",
    "table_names",
]
