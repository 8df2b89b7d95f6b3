"""PPO of RLlib on the vector environment, through its registered entry point.

pip install 'ray[rllib]' torch  # asks for an older Gymnasium than Silverball,
pip install '.[rl]'               # but works with this one; pip warns
python examples/train_rllib.py --rounds 5
"""

from __future__ import annotations

import argparse

from ray.rllib.algorithms.ppo import PPOConfig

parser = argparse.ArgumentParser()
parser.add_argument("--rounds", type=int, default=5)
chosen = parser.parse_args()

config = (
    PPOConfig()
    # The name of the module makes every worker register the environments.
    .environment("silverball.envs:silverball/PinballClassic-v1")
    .env_runners(num_env_runners=0, num_envs_per_env_runner=32, gym_env_vectorize_mode="vector_entry_point")
    .training(train_batch_size_per_learner=16_384, minibatch_size=512, num_epochs=4)
)
algorithm = config.build_algo()
for number in range(chosen.rounds):
    result = algorithm.train()
    mean = result["env_runners"].get("episode_return_mean")
    told = "no ball has drained yet" if mean is None else f"{100 * mean:.0f} points a ball"
    print(f"round {number + 1}: {told}", flush=True)
algorithm.stop()
