"""What a hub brings back from its journal can be told to others again."""

from hub.memory import read_world, write_world
from hub.world import World
from tests.hub.scenes import flat


def test_a_searched_room_is_remembered() -> None:
    before = World(flat(), seed=0)
    before.areas.search_done("kitchen", "dog-1", 3.0)
    after = World(flat(), seed=0)
    read_world(after, write_world(before))
    kitchen = next(area for area in after.snapshot(4.0).areas if area.id == "kitchen")
    assert kitchen.searched
    delta = after.delta(4.0)
    assert delta is not None
    assert "kitchen" in [area.id for area in delta.areas]
