"""What holds for all tests: hypothesis draws the same examples every time and has no deadline (the first
call compiles)."""

from hypothesis import HealthCheck, settings

settings.register_profile(
    "silverball",
    derandomize=True,
    deadline=None,
    database=None,
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.filter_too_much],
)
settings.load_profile("silverball")
