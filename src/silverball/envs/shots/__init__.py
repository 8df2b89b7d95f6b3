"""Goal-conditioned shots: hit the named part next, with the conventions of goal environments.

    silverball/PinballShots-v1

A ball drops onto a paddle, and the goal names a part of the table. The first of the named parts that the ball
hits after a paddle has met it ends the episode. `targets.py` says which parts they are, `one_shot.py` judges
a step, `shot_engine.py` has the arrays, `shot_single.py` and `shot_vector.py` the environments.

The conventions are those of `GoalEnv` in Gymnasium-Robotics: observations with the keys "observation",
"achieved_goal" and "desired_goal", and `compute_reward`, `compute_terminated` and `compute_truncated`, which
take one goal or many, so that episodes can be relabelled with goals that they have reached.
"""
