"""The compiled kernels of the drawing: distances, rays, surfaces, light, and the layers of a frame.

    stage.py, tones.py              records, colours
    solids.py, march.py             distances to parts, the grid of parts, ray marching
    art.py, surfaces.py, shade.py   the playfield's paint, surfaces, light
    bake.py                         a scene becomes pixels
    patches.py, chrome.py           paddles, light, shadows and balls are drawn over them

The cache of machine code is keyed by the sources of this folder and of the physics, so kernels may import
nothing else; changes elsewhere in the drawing then never recompile them.
"""
