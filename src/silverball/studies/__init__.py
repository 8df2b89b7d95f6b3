"""Studies: how a table plays, from a plan of thousands of games that can be stopped, resumed and spread."""
