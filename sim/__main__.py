"""The simulator's process: python -m sim --site FILE --id sim"""

from sim.core import build
from wire.process import main

if __name__ == "__main__":
    main(build)
