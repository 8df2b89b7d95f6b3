"""The table in a browser: the same kernels, the same bits, one file."""
