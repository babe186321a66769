"""`python -m hub.view --site FILE --id view`."""

from hub.view.core import ViewCore, open_recording
from wire.process import main
from wire.site import Site


def build(site: Site, process_id: str) -> ViewCore:
    del process_id  # there is one view for a site
    return ViewCore(site, open_recording(site))


if __name__ == "__main__":
    main(build)
