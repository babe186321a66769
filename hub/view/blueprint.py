"""Where everything is on the screen."""

from collections.abc import Sequence

import rerun.blueprint as rrb

TIMELINE = "time"
_TWO_COLUMNS = 8
"""More pictures than these would be too small on a common screen."""


def blueprint(
    cameras: Sequence[str],
    carried: Sequence[str],
    centre_m: tuple[float, float],
    span_m: float,
    *,
    flight: bool = False,
) -> rrb.Blueprint:
    """World and task timeline on the left, pictures in the middle, plan, metrics and log on the right.

    `carried`: the cameras that move; they look into the world. `flight`: whether somebody flies.
    """
    x, y = centre_m
    world = rrb.Spatial3DView(
        origin="world",
        name="Fused world",
        contents=["$origin/**", *(f"- $origin/cameras/{c}/picture/**" for c in cameras)],
        eye_controls=rrb.EyeControls3D(
            position=[x, y - 0.55 * span_m, 0.85 * span_m], look_target=[x, y, 0.0], eye_up=[0, 0, 1]
        ),
    )
    pictures = [rrb.Spatial2DView(origin=f"world/cameras/{c}/picture", name=c) for c in (*cameras, *carried)]
    # each with a scale of its own: fractions beside metres would be a flat line
    metrics = rrb.Tabs(
        rrb.TimeSeriesView(origin="metrics/seen", name="Seen of each room"),
        rrb.TimeSeriesView(origin="metrics/travelled_m", name="Metres walked"),
        rrb.TimeSeriesView(origin="metrics/counts", name="Objects, replans"),
        *([rrb.TimeSeriesView(origin="flight", name="Battery and height")] if flight else []),
        name="Metrics",
    )
    return rrb.Blueprint(
        rrb.Horizontal(
            rrb.Vertical(world, rrb.StateTimelineView(origin="tasks", name="What each robot does"), row_shares=[4, 1]),
            rrb.Grid(*pictures, grid_columns=2 if len(pictures) <= _TWO_COLUMNS else 3),
            rrb.Vertical(
                rrb.GraphView(origin="plan", name="Plan"),
                rrb.TextDocumentView(origin="task", name="Task"),
                metrics,
                rrb.TextLogView(origin="log", name="Events"),
            ),
            column_shares=[5, 4, 3],
        ),
        rrb.TimePanel(state="collapsed", timeline=TIMELINE),
        rrb.BlueprintPanel(state="hidden"),
        rrb.SelectionPanel(state="hidden"),
        auto_views=False,
        auto_layout=False,
    )
