"""One hypothesis profile for the whole tree: no timing of examples, and the same examples in every run."""

from hypothesis import settings

settings.register_profile("r2x", deadline=None, derandomize=True, print_blob=True)
settings.load_profile("r2x")
