"""Rectangles of floor."""

from dataclasses import dataclass

from sim.scene import Vec2


@dataclass(frozen=True)
class Area:
    """A rectangle along the axes of the site."""

    x0: float
    y0: float
    x1: float
    y1: float

    @classmethod
    def around(cls, centre_m: Vec2, depth_m: float, width_m: float, sideways: bool) -> "Area":
        """The footprint of a thing; `sideways` when its front faces along y."""
        dx, dy = (width_m / 2.0, depth_m / 2.0) if sideways else (depth_m / 2.0, width_m / 2.0)
        return cls(centre_m[0] - dx, centre_m[1] - dy, centre_m[0] + dx, centre_m[1] + dy)

    @property
    def width_m(self) -> float:
        return self.x1 - self.x0

    @property
    def depth_m(self) -> float:
        return self.y1 - self.y0

    @property
    def floor_m2(self) -> float:
        return self.width_m * self.depth_m

    @property
    def centre_m(self) -> Vec2:
        return ((self.x0 + self.x1) / 2.0, (self.y0 + self.y1) / 2.0)

    @property
    def corners_m(self) -> tuple[Vec2, ...]:
        """Counter-clockwise."""
        return ((self.x0, self.y0), (self.x1, self.y0), (self.x1, self.y1), (self.x0, self.y1))

    def grown(self, margin_m: float) -> "Area":
        return Area(self.x0 - margin_m, self.y0 - margin_m, self.x1 + margin_m, self.y1 + margin_m)

    def overlaps(self, other: "Area") -> bool:
        """Whether they share more than an edge."""
        gap_x = min(self.x1, other.x1) - max(self.x0, other.x0)
        return gap_x > 1e-6 and min(self.y1, other.y1) - max(self.y0, other.y0) > 1e-6

    def holds(self, other: "Area") -> bool:
        return (
            other.x0 >= self.x0 - 1e-6
            and other.y0 >= self.y0 - 1e-6
            and other.x1 <= self.x1 + 1e-6
            and other.y1 <= self.y1 + 1e-6
        )
