"""Draw a world into a NumPy array and a file, without a display."""

from PIL import Image

import silverball as sb

world = sb.World("classic", seed=7)
world.create_ball()
world.step(left=True, ticks=60)
picture = world.render(height=480)  # uint8 [height, width, 3]
Image.fromarray(picture).save("table.png")
print("table.png", picture.shape)
