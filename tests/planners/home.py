"""A fixed home with thirty known things, for instructions whose meaning depends on what is there."""

from tests.planners.toy import House
from wire.messages.world import WorldState

FURNITURE = (
    *(("Fridge", "kitchen"), ("CounterTop", "kitchen"), ("DiningTable", "kitchen"), ("Sink", "kitchen")),
    *(("Microwave", "kitchen"), ("Sofa", "living-room"), ("CoffeeTable", "living-room"), ("Dresser", "bathroom")),
    *(("ShelvingUnit", "living-room"), ("Desk", "bedroom-1"), ("Bed", "bedroom-1"), ("Bed", "bedroom-2")),
    *(("GarbageCan", "kitchen"), ("Box", "bedroom-2")),
)
THINGS = (
    *(("Apple", "countertop-1"), ("Bread", "countertop-1"), ("Mug", "countertop-1"), ("Mug", "desk-1")),
    *(("Plate", "diningtable-1"), ("Knife", "countertop-1"), ("Tomato", "fridge-1"), ("Book", "coffeetable-1")),
    *(("Book", "desk-1"), ("Newspaper", "sofa-1"), ("Vase", "coffeetable-1"), ("Laptop", "desk-1")),
)
SWITCHED = (
    ("Television", "living-room"),
    ("Television", "bedroom-1"),
    ("FloorLamp", "living-room"),
    ("DeskLamp", "bedroom-1"),
)
UNSEEN = (
    *(("Pillow", "bed-1"), ("Pillow", "bed-2"), ("Pillow", "sofa-1"), ("CellPhone", "bed-2"), ("TeddyBear", "bed-2")),
    *(
        ("RemoteControl", "coffeetable-1"),
        ("Potato", "sink-1"),
        ("WineBottle", "diningtable-1"),
        ("Bowl", "shelvingunit-1"),
    ),
    *(("Lettuce", "fridge-1"), ("Mug", "coffeetable-1")),
)
DIRTY, OPEN = ("mug-1", "plate-1"), ("laptop-1", "fridge-1")


def home(seed: int = 11) -> House:
    """A robot has seen the thirty; others are there and nobody knows of them yet."""
    house = House(seed, dogs=2)
    for type, room in FURNITURE:
        house.add(type, room)
    for type, holder in THINGS:
        house.add(type, house.things[holder].room, holder)
    for type, room in SWITCHED:
        house.add(type, room, isToggled=True)
    for id in DIRTY:
        house.things[id].props["isDirty"] = True
    for id in OPEN:
        house.things[id].props["isOpen"] = True
    for thing in house.things.values():
        house.see(house.dogs[0], thing)
    for type, holder in UNSEEN:
        house.add(type, house.things[holder].room, holder)
    return house


def home_world() -> WorldState:
    return home().world()
