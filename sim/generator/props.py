"""How things are when nobody has touched them yet: on, open, dirty, cut."""

from random import Random

from wire.catalogue import PROP_FLAG, catalogue

CHANCE: dict[tuple[str, str], float] = {
    ("Book", "isOpen"): 0.2,
    ("Box", "isOpen"): 0.5,
    ("Fridge", "isOpen"): 0.1,
    ("Kettle", "isOpen"): 0.1,
    ("Laptop", "isOpen"): 0.7,
    ("LaundryHamper", "isOpen"): 0.3,
    ("Microwave", "isOpen"): 0.15,
    ("Toilet", "isOpen"): 0.4,
    ("Candle", "isToggled"): 0.3,
    ("CellPhone", "isToggled"): 0.4,
    ("CoffeeMachine", "isToggled"): 0.3,
    ("DeskLamp", "isToggled"): 0.5,
    ("FloorLamp", "isToggled"): 0.5,
    ("Laptop", "isToggled"): 0.5,
    ("Microwave", "isToggled"): 0.15,
    ("Television", "isToggled"): 0.5,
    ("Toaster", "isToggled"): 0.2,
    ("Bed", "isDirty"): 0.15,
}
DIRTY, SLICED = 0.35, 0.12


def draw_props(kind: str, rng: Random) -> dict[str, bool]:
    """Every property that the type has."""
    props = {}
    for prop, flag in PROP_FLAG.items():
        if catalogue()[kind].can(flag):
            default = {"isDirty": DIRTY, "isSliced": SLICED}.get(prop, 0.0)
            props[prop] = rng.random() < CHANCE.get((kind, prop), default)
    if kind == "Microwave" and props["isOpen"]:
        props["isToggled"] = False
    return props
