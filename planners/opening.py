"""Opens the language models of a site: that of the planner, and that which looks at pictures."""

import importlib.util
import logging

from planners.asking import Model
from planners.kept_replies import KeptReplies
from wire.site import Site, SiteError, state_dir


def model_of(site: Site) -> Model:
    """The planner's model, being loaded while the process comes up. Raises SiteError."""
    return _open(site, site.planner.model)


def vision_of(site: Site) -> Model | None:
    """The model that looks at pictures; None where the site names none. Raises SiteError."""
    return _open(site, site.planner.vision) if site.planner.vision else None


def missing_client() -> str:
    """A sentence where the client of model servers is not installed; else nothing."""
    if importlib.util.find_spec("ollama") is not None:
        return ""
    return "the client of model servers is not installed: install the extra `model`"


def _open(site: Site, name: str) -> Model:
    choice = site.planner.model_copy(update={"model": name})
    folder = state_dir(site) / "replies"
    if choice.replies == "only":
        return KeptReplies(folder, name, choice.num_ctx, None)
    if fault := missing_client():
        raise SiteError(f"planner.model: {fault}")
    from planners.model import OllamaModel  # only a process that asks a model needs the client

    logging.getLogger("httpx").setLevel(logging.WARNING)  # it would add a line for every request
    model = OllamaModel(choice)
    model.start()
    return model if choice.replies == "off" else KeptReplies(folder, name, choice.num_ctx, model)
