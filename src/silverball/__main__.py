"""`python -m silverball` is the same as `silverball`."""

from silverball.cli import main

if __name__ == "__main__":
    main()
