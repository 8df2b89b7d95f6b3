"""Move a thousand worlds at once, and look at one of them."""

import numpy as np

import silverball as sb

batch = sb.WorldBatch("random", count=1000, seed=0)
batch.create_balls()
presses = np.random.default_rng(0).random((240, 1000, 3)) < [0.3, 0.3, 0.0]
batch.step(presses, ticks=240)  # one second
scores = batch.state["score"]
best = int(scores.argmax())
print(f"{scores.mean():.0f} points on average, world {best} has {scores[best]}")
for event in batch.events(best)[:5]:
    print(event.kind, event.part)

moment = batch.save(best)  # branch: all worlds go on from this one
batch.restore(moment)
batch.step(presses, ticks=240)
print(f"its branches end with {batch.state['score'].min()} to {batch.state['score'].max()} points")
