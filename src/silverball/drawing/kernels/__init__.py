"""The compiled half of the drawing: how far is everything, what does a ray meet, how bright is it there?

    stage.py, tones.py            records, colours
    solids.py, cells.py, march.py distances, the parts near a place, rays
    art.py, surfaces.py, shade.py the playfield's paint, surfaces, light
    bake.py                       a scene becomes pixels
    patches.py, chrome.py         what moves is laid over them

Compiled code is kept by the sources of this folder and of the physics, so a change anywhere else in the
drawing compiles nothing anew; therefore nothing in here may import from outside of the two.
"""
