"""From everybody's claims of a property to one value: a sum of log-odds, first-hand sight above hearsay."""

from math import exp

from hub.records import Claim, Fact
from hub.trust import Trust

_HANDLED_ODDS = 4.6
_FADE_S = 600.0
_OUTDATED_FADE_S = 20.0
"""A first-hand claim fades this fast once somebody who had agreed, or had said nothing, says otherwise."""
_SMOOTH = 0.4
_WEIGH_S = 1.0
"""What sources say all the time is weighed anew this often."""
_FLIP_ODDS = 0.3
"""A settled value changes only when the other side leads by this much."""


def claim(fact: Fact, source: str, probability: float, stamp_s: float) -> None:
    """Take one look of one source into its running claim."""
    said = fact.claims.get(source)
    if said is None:
        fact.claims[source] = Claim(probability, stamp_s)
        return
    before = said.probability
    said.probability = after = before + _SMOOTH * (probability - before)
    said.stamp_s = stamp_s
    if (before > 0.5) != (after > 0.5):
        said.changed_s = stamp_s
        said.handled = False


def handle(fact: Fact, source: str, value: bool, stamp_s: float) -> None:
    """A robot has made it so."""
    fact.claims[source] = Claim(1.0 if value else 0.0, stamp_s, handled=True)
    fact.weighed = 0


def settle(fact: Fact, now_s: float, trust: Trust, robots: frozenset[str]) -> bool:
    """Weigh the claims; True when value, source or contradictions changed."""
    if now_s - fact.weighed_s < _WEIGH_S and _unanimous(fact):
        return False
    fact.weighed_s, fact.weighed = now_s, len(fact.claims)
    weights = {source: _weight(source, said, fact, now_s, trust, robots) for source, said in fact.claims.items()}
    total = sum(weights.values())
    value = total > 0.0
    if fact.value is not None and value != fact.value and abs(total) < _FLIP_ODDS:
        value = fact.value
    sign = 1.0 if value else -1.0
    source = max(weights, key=lambda s: (weights[s] * sign, s))
    against = tuple(sorted(s for s, said in fact.claims.items() if (said.probability > 0.5) != value))
    confidence = 1.0 / (1.0 + exp(-max(sign * total, 0.0)))
    changed = (
        value != fact.value
        or source != fact.source
        or against != fact.contradicted_by
        or abs(confidence - fact.confidence) > 0.1
    )
    if changed:
        fact.value, fact.source, fact.contradicted_by, fact.confidence = value, source, against, confidence
    fact.stamp_s = fact.claims[source].stamp_s
    return changed


def _unanimous(fact: Fact) -> bool:
    """Whether all who have spoken go on saying what is believed, and nobody has joined them."""
    claims, value = fact.claims, fact.value
    if len(claims) != fact.weighed or fact.contradicted_by or fact.source not in claims:
        return False
    for said in claims.values():
        if (said.probability > 0.5) != value:
            return False
    fact.stamp_s = claims[fact.source].stamp_s
    return True


def _weight(source: str, said: Claim, fact: Fact, now_s: float, trust: Trust, robots: frozenset[str]) -> float:
    robot = source in robots
    odds = _HANDLED_ODDS if said.handled else trust.odds(source, robot)
    fade_s = _OUTDATED_FADE_S if robot and _outdated(source, said, fact) else _FADE_S
    age_s = now_s - said.stamp_s
    if age_s > 1.0:
        odds *= exp(-age_s / fade_s)
    return odds * (2.0 * said.probability - 1.0)


def _outdated(source: str, said: Claim, fact: Fact) -> bool:
    """Whether somebody has changed to the contrary since this claim was made."""
    value = said.probability > 0.5
    return any(
        other.changed_s > said.stamp_s + 1.0 and (other.probability > 0.5) != value
        for name, other in fact.claims.items()
        if name != source
    )
