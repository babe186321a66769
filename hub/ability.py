"""What a robot that is there can do: what plans are checked against and nodes are given out by."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import inf

from wire.catalogue import catalogue


@dataclass(frozen=True)
class Ability:
    """`payload_kg`: the heaviest that it lifts, infinite when its card does not say. `parameters`: of its skills, each
    a JSON schema."""

    skills: tuple[str, ...]
    payload_kg: float = inf
    parameters: Mapping[str, str] = field(default_factory=dict)

    def lifts(self, type: str) -> bool:
        """Whether a typical thing of this type is light enough; one of unknown weight is tried."""
        return mass_kg(type) <= self.payload_kg


def mass_kg(type: str) -> float:
    """A typical thing of this type; nought where the catalogue does not say."""
    row = catalogue().get(type)
    return row.mass_kg or 0.0 if row is not None else 0.0
