"""Every test of the environments finds their ids registered, whichever file is run alone."""

import silverball.envs  # noqa: F401
