"""What a person writes: a pinball table as data, read, checked, generated and saved."""

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
    Table,
    TriangularPrism,
)
from silverball.table.reach import ball_places
from silverball.table.trial import check_table

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
