"""How fast and how exact is Silverball?

By itself (`speed.py`), in the places where it could be slow (`marks.py`), and beside other engines
(`peers/`). How smooth the window is, `benchmarks/window.py` of the repository measures.
"""
