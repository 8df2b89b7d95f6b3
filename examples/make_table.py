"""Make a table in Python: change one, add parts, check it, save it."""

import silverball as sb

table = sb.load_table("classic")
posts = tuple(sb.parts.Cylinder(center=(1.0, z), radius=0.3, points=50) for z in (-3.5, 0.0, 3.5))
mine = table.replace(name="Mine", board={"gravity": 9.0}, cylinder=posts, triangular_prism=())
for problem in sb.check_table(mine):
    print(problem)
sb.save_table(mine, "mine.toml")
print(f"mine.toml: {len(mine.cylinder)} cylinders, gravity {mine.board.gravity} u/s²")

try:
    table.replace(cylindre=posts)
except sb.TableError as error:
    print(error)
