"""How fast and how exact is Silverball, by itself (`speed.py`) and beside other engines (`peers/`)?"""
