"""Listen to a world: count hits by part for ten seconds of play."""

from collections import Counter

import silverball as sb

world = sb.World("classic", seed=7)
hits: Counter[str] = Counter()
while world.time < 10:
    if not world.balls:
        world.create_ball()
    world.step(left=world.tick % 120 < 20, right=world.tick % 120 < 20)
    for event in world.events:
        if event.kind == "created":
            x, _, z = event.position
            print(f"{world.time:5.2f} s  ball {event.ball} at x {x:.2f}, z {z:.2f}")
        elif event.kind == "hit":
            hits[event.part] += 1
for part, count in hits.most_common(5):
    print(f"{count:4} hits  {part}")
