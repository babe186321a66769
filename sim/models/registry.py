"""The model of every type that the simulator has a body for."""

from sim.models.appliances import APPLIANCE_MODELS
from sim.models.containers import CONTAINERS
from sim.models.dishes import DISHES
from sim.models.electronics import ELECTRONICS
from sim.models.food import FOOD
from sim.models.form import Model
from sim.models.leisure import LEISURE
from sim.models.lights import LIGHTS
from sim.models.seating import SEATING
from sim.models.tables import TABLES

MODELS: dict[str, Model] = {
    **APPLIANCE_MODELS,
    **CONTAINERS,
    **DISHES,
    **ELECTRONICS,
    **FOOD,
    **LEISURE,
    **LIGHTS,
    **SEATING,
    **TABLES,
}
