"""Benchmarks behind `silverball bench`: speed, latency and accuracy, each measured in one run.

`speed` and `marks` measure the step; `drawing`, `window_smoothness`, `decision_cost` and `replays` what their
names say. `envs` compares the environments for agents with those of other packages, `peers` the solver with
other engines on the same tables, and `thresholds` measures the returns above which an environment is solved.
"""
