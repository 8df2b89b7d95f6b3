"""What is beside the table in a wide window: large display, score card, rules card, lists and help."""
