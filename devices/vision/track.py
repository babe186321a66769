"""One thing, as one camera has come to know it over several pictures."""

from dataclasses import dataclass, field
from typing import Literal

import numpy as np

from devices.vision import layout
from devices.vision.detector import Detection
from devices.vision.lens import Floats
from devices.vision.projection import Sighting
from wire.catalogue import PROP_FLAG, type_row
from wire.messages.observation import Covariance, ObjectObservation
from wire.model import Vec3

Eye = Literal["embedded", "model"]
"""Who looked at a picture: the detector, often and exactly, or a vision model, rarely and late."""
CONFIRM_SIGHTINGS = 2
VOTE_MEMORY = 0.8
"""What is left of earlier votes after a new one: pictures of one camera are not independent."""
PROP_MEMORY = 0.6
PROP_LIMIT = 4.0
PROP_SILENCE = 0.4
"""Log-odds nearer to nought than this say nothing."""
POSITION_GAIN = 0.3
SECOND_WEIGHT = 0.5
"""Of what is left to full confidence, so much is gained by a second eye that is sure."""


@dataclass
class Track:
    """`known` counts pictures in which the thing was or should have been seen."""

    name: str
    first: Sighting
    stamp_s: float
    eye: Eye = "embedded"
    """The detector's from the first time on that it has seen it, whoever saw it first."""
    votes: Floats = field(init=False)
    prop_log_odds: dict[str, float] = field(default_factory=dict)
    position: Floats = field(init=False)
    covariance_m2: Covariance = field(init=False)
    confidence: float = 0.0
    sightings: int = 0
    known: int = 0
    misses: int = 0
    box_px: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        self.votes = np.zeros(len(layout.known_types()))
        self.position = np.array(self.first.position_enu_m)
        self.covariance_m2 = self.first.covariance_m2
        self.see(self.first, self.stamp_s)

    @property
    def type(self) -> str:
        return layout.known_types()[int(self.votes.argmax())]

    @property
    def type_probabilities(self) -> Floats:
        weights = np.exp(self.votes - self.votes.max())
        result: Floats = weights / weights.sum()
        return result

    @property
    def confirmed(self) -> bool:
        return self.sightings >= CONFIRM_SIGHTINGS

    @property
    def position_enu_m(self) -> Vec3:
        return (float(self.position[0]), float(self.position[1]), float(self.position[2]))

    @property
    def miss_probability(self) -> float:
        """How often a thing like this goes unseen although it is there, from this track's own record."""
        return (self.known - self.sightings - self.misses + 1.0) / (self.known - self.misses + 3.0)

    def see(self, sighting: Sighting, stamp_s: float) -> None:
        """Take in one more sighting."""
        detection = sighting.detection
        self.stamp_s = stamp_s
        self.sightings += 1
        self.known += 1
        self.misses = 0
        self.box_px = detection.box_px
        self._vote(detection)
        self.confidence += (detection.confidence - self.confidence) / min(self.sightings, 4)
        self._move(sighting)

    def adopt(self, sighting: Sighting) -> None:
        """The detector sees what a model alone has seen: from now on it is its own, and is where the detector says."""
        self.eye, self.first = "embedded", sighting
        self.position = np.array(sighting.position_enu_m)

    def second(self, sighting: Sighting) -> None:
        """Another eye has seen it, too: surer of what it is, no surer of where, for the detector knows that better."""
        self._vote(sighting.detection)
        self.confidence = 1.0 - (1.0 - self.confidence) * (1.0 - SECOND_WEIGHT * sighting.detection.confidence)

    def _vote(self, detection: Detection) -> None:
        """On its type and its properties."""
        self.votes = VOTE_MEMORY * self.votes + layout.widened(detection.log_probs)
        for prop, probability in detection.props.items():
            p = min(max(probability, 0.02), 0.98)
            log_odds = PROP_MEMORY * self.prop_log_odds.get(prop, 0.0) + float(np.log(p / (1.0 - p)))
            self.prop_log_odds[prop] = min(max(log_odds, -PROP_LIMIT), PROP_LIMIT)

    def _move(self, sighting: Sighting) -> None:
        """Errors of one camera repeat, so that averaging removes jitter and leaves the covariance as it is.

        A thing that has plainly moved is followed at once.
        """
        away = np.array(sighting.position_enu_m) - self.position
        sd_m = float(np.sqrt(max(sighting.covariance_m2[0], sighting.covariance_m2[2])))
        moved = float(np.hypot(away[0], away[1])) > max(0.25, 1.5 * sd_m)
        gain = 1.0 if moved else max(POSITION_GAIN, 1.0 / self.sightings)
        self.position = self.position + gain * away
        self.covariance_m2 = sighting.covariance_m2

    def props(self) -> dict[str, float]:
        """Probability of every property that a thing of this type has and that has been judged."""
        row = type_row(self.type)
        return {
            prop: float(1.0 / (1.0 + np.exp(-log_odds)))
            for prop, log_odds in sorted(self.prop_log_odds.items())
            if row.can(PROP_FLAG[prop]) and abs(log_odds) >= PROP_SILENCE
        }

    def observation(self) -> ObjectObservation:
        """What is said of it on the wire."""
        return ObjectObservation(
            track=self.name,
            type=self.type,
            confidence=min(1.0, max(0.0, self.confidence)),
            position_enu_m=self.position_enu_m,
            covariance_m2=self.covariance_m2,
            props=self.props(),
            box_px=self.box_px,
        )
