"""The PinBall domain of Konidaris and Barto (2009): push a ball past polygons into a target.

    silverball/PinBallDomain-v1

A classic task for options and skill chaining, on the engine of the tables: gravity 0, polygons as walls, a
target as a hole. `board_file.py` reads the `.cfg` files of the domain, `board_table.py` turns a board into a
table, `impulses.py` has the step, `arena.py` the arrays, `domain_single.py` and `domain_vector.py` the
environments for Gymnasium.

Source: G. Konidaris and A. Barto, "Skill discovery in continuous reinforcement learning domains using skill
chaining", Advances in Neural Information Processing Systems 22 (2009), pages 1015-1023.
"""
