"""The referee: the rules of a game, compiled, and run on the events of each tick.

`compile_rules.py` turns the rules of a table into rows of integers (`game_records.py` has the records);
`judge.py` passes the events of a tick to them, and `turns.py` the balls that start and are lost;
`triggers.py` finds the rules that a trigger sets off, `acts.py` does what they say, and `at_table.py` what
moves something. `run_games.py` plays many games at once.
"""
