"""Benchmarks behind `silverball bench`: speed, latency and accuracy, each measured in one run.

`speed` and `marks` measure the step; `drawing`, `window_smoothness`, `decision_cost` and `replays` what their
names say. `envs` measures the environments for agents beside those of other packages, `peers` other engines
on the same tables, and `thresholds` the returns above which an environment counts as solved.
"""
