"""What code objects to in a model's reply: one sentence for each fault, and nothing where there is none."""

import json
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from planners.goals.dialogue import Dialogue
from planners.goals.mending import mended
from planners.goals.offered import EVERYTHING, Offered, offer
from planners.goals.reply import Misshapen, Reply, read_reply
from planners.goals.words import Instruction
from planners.prompt import Names
from tests.planners.home import home_world
from tests.planners.instructions import written
from tests.planners.scripted_model import WrittenModel
from wire.messages.plan import PlanRequest

WORLD = home_world()


def offered(say: str) -> Offered:
    return offer(PlanRequest(task="t", epoch=1, instruction=say, world=WORLD, now_s=1.0), Names())


def judge(say: str, given: dict[str, Any]) -> tuple[str, tuple[str, ...]]:
    """Goals in notation, and the objections."""
    dialogue = Dialogue(WrittenModel(["{}"]), offered(say), Instruction(say, WORLD), WORLD)
    judged = dialogue.judge(read_reply(json.dumps(given)))
    return written(judged.goals), judged.faults


def wish(line: str) -> dict[str, Any]:
    """`words | p | a | field=value ...` as a goal of a reply."""
    of, p, a, *more = (part.strip() for part in line.split("|"))
    fields = dict(part.split("=") for part in more)
    return {
        "of": of,
        "p": p,
        "a": a,
        **{name: value if name in ("b", "a_in", "b_in") else json.loads(value) for name, value in fields.items()},
    }


def reply(*goals: str, keep: tuple[str, ...] = (), **more: list[str]) -> dict[str, Any]:
    return {"goals": [wish(line) for line in goals], "keep": [wish(line) for line in keep], **more}


STASH = "stash the mug in the sink"
KILL = "kill the telly, then douse the floor lamp"
ALONE = "stash the mug in the sink without touching the vase"
GOLDFISH = "kill the telly and feed the goldfish"
BUT_ONE = "kill all lamps except the floor lamp"
STASH_IT = "stash it in the box"
EMPTIED = f"{STASH} after you emptied it"
MUG_IN_SINK = f"{STASH} | in | Mug | b=Sink"
TELLY_OFF = "kill the telly | off | Television"


@pytest.mark.parametrize(
    ("say", "given", "wanted"),
    [
        (STASH, reply(MUG_IN_SINK), "in(Mug,Sink)"),
        (STASH, reply(f"{STASH} | at | Mug | b=Sink"), "in(Mug,Sink)"),
        (STASH, reply(f"{STASH} | in | mug2 | b=Sink"), "in(Mug[id=mug-2],Sink)"),
        (
            ALONE,
            reply(MUG_IN_SINK, keep=("without touching the vase | touched | Vase",)),
            "in(Mug,Sink) ; FORBID touched(Vase*)",
        ),
        (
            KILL,
            reply(f"{TELLY_OFF} | step=1", "douse the floor lamp | off | FloorLamp | step=2"),
            "off(Television) ; off(FloorLamp)<0",
        ),
        (
            "whoa, the telly is blaring, kill it",
            reply("the telly kill it | off | Television", talk=["whoa", "is blaring"]),
            "off(Television)",
        ),
        (
            "I am off to bed, see that no telly stays on",
            reply("see that no telly stays on | off | Television | all=true", talk=["I am off to bed"]),
            "off(Television*)",
        ),
    ],
)
def test_what_is_right_may_stand(say: str, given: dict[str, Any], wanted: str) -> None:
    assert judge(say, given) == (wanted, ())


@pytest.mark.parametrize(
    ("say", "given", "objection"),
    [
        (STASH, reply(f"{STASH} | in | widget7 | b=Sink"), "'widget7' is not offered"),
        (STASH, reply(f"{STASH} | in | Mug | b=Vase"), "'Vase' holds nothing"),
        (STASH, reply(f"{STASH} | fly | Mug"), "p cannot be 'fly'"),
        (STASH, reply(f"{STASH} | touched | Mug"), "put it into keep"),
        ("stash the mug", reply("stash the mug | in | Mug"), "in needs a b"),
        (STASH, reply("hide the mug | in | Mug | b=Sink"), "is not in the instruction"),
        (STASH, reply(f"{STASH} | in | Apple | b=Sink"), "no word of"),
        (STASH, reply(f"{STASH} | in | Mug | b=bathroom"), "names bathroom"),
        (STASH, reply(f"{STASH} | clean | Mug"), "does not ask for clean"),
        (STASH, reply(f"{STASH} | in | Mug | b=Sink | all=true"), "'mug' is one"),
        (STASH, reply(f"{STASH} | in | {EVERYTHING} | b=Sink"), "does not say everything"),
        (STASH, reply(), "'stash' is in no goal"),
        (STASH, reply(unknown=["dragon"]), "unknown 'dragon' is not in the instruction"),
        ("stash every mug in the sink", reply("stash every mug in the sink | in | Mug | b=Sink"), "all must be true"),
        ("stash two mugs in the sink", reply("stash two mugs in the sink | in | Mug | b=Sink | n=3"), "n must be 2"),
        (
            "stash the sofa in the box",
            reply("stash the sofa in the box | in | Sofa | b=Box"),
            "a sofa cannot be carried",
        ),
        ("stash the mug on the fridge", reply("stash the mug on the fridge | in | Mug | b=Fridge"), "not on top of it"),
        (ALONE, reply(MUG_IN_SINK), "'touching' is in no goal that does it"),
        ("kill the telly but not the floor lamp", reply(TELLY_OFF), "'floor lamp' is in no goal"),
        ("hands off the vase, kill the telly", reply(TELLY_OFF, talk=["hands off the vase"]), "names a thing"),
        (
            "no telly stays on",
            reply(keep=("no telly stays on | touched | Television",)),
            "'no' is not heeded",
        ),
        (
            "put a vase in bed, kill the telly",
            reply(TELLY_OFF, talk=["put a vase in bed"]),
            "'bed' in talk names a thing",
        ),
        (
            "I am off to bed, clean the bed, kill the telly",
            reply(TELLY_OFF, talk=["I am off to bed, clean the bed"]),
            "'bed'",
        ),
        (
            "I want it in the bed, kill the telly",
            reply(TELLY_OFF, talk=["I want it in the bed"]),
            "'bed' in talk names a thing",
        ),
        ("don't kill the telly", reply("don't kill the telly | off | Television"), "not heeded"),
        (BUT_ONE, reply(f"{BUT_ONE} | off | DeskLamp | all=true"), "'floor lamp' is in no goal"),
        ("kill every lamp", reply("kill every lamp | off | FloorLamp | all=true"), "DeskLamp too"),
        (KILL, reply(TELLY_OFF, "douse the floor lamp | off | FloorLamp"), "asks for an order"),
        (KILL, reply(TELLY_OFF, "douse the floor lamp | off | FloorLamp | step=2"), "needs a step"),
        (KILL, reply(f"{TELLY_OFF} | step=2", "douse the floor lamp | off | FloorLamp | step=1"), "another order"),
        (GOLDFISH, reply(TELLY_OFF), "'feed' is in no goal"),
        (GOLDFISH, reply(f"{GOLDFISH} | off | Television"), "has no part in"),
        ("kill the telly, open the microwave", reply(TELLY_OFF, talk=["open the microwave"]), "asks for something"),
        (
            "kill the telly, then boot the telly",
            reply(f"{TELLY_OFF} | step=1", "boot the telly | on | Television | step=2"),
            "cannot be both",
        ),
        (
            "stash one of the mugs in the sink",
            reply("stash one of the mugs in the sink | in | Mug | b=Sink | all=true"),
            "'mugs' is one",
        ),
        ("stash the mug in the sink, don't spill it", reply(MUG_IN_SINK, talk=["don't spill it"]), "denies something"),
        (
            EMPTIED,
            reply(MUG_IN_SINK, talk=["after you emptied it"]),
            "tells when",
        ),
        (
            "stash the laptop in the box, closed",
            reply("stash the laptop in the box, closed | in | Laptop | b=Box"),
            "'closed' is in no goal",
        ),
        (
            f"polish the mug, {STASH_IT}, polish the plate",
            reply(
                "polish the mug | clean | Mug", f"{STASH_IT} | in | Plate | b=Box", "polish the plate | clean | Plate"
            ),
            "not for Plate",
        ),
        (f"{STASH}, smash it", reply(MUG_IN_SINK, talk=["smash it"]), "may ask for something"),
        (f"{STASH}, smash mug", reply(MUG_IN_SINK, talk=["smash mug"]), "may ask for something"),
        (f"{STASH}, feed the goldfish", reply(MUG_IN_SINK, talk=["feed the goldfish"]), "may ask for something"),
        (EMPTIED, reply(MUG_IN_SINK, talk=["you emptied it"]), "are not two"),
        ("switch off the TV, sweetie", reply("switch off the TV | on | Television", talk=["sweetie"]), "asks for off"),
    ],
)
def test_every_fault_has_its_sentence(say: str, given: dict[str, Any], objection: str) -> None:
    goals, faults = judge(say, given)
    assert goals == ""
    assert any(objection in fault for fault in faults), faults
    assert all(len(fault) < 250 and "\n" not in fault for fault in faults)


@pytest.mark.parametrize(
    "text",
    [
        "",
        "no",
        "[]",
        '{"goals": ',
        '{"goals": 3}',
        '{"goals": [{"p": "in"}]}',
        '{"plan": []}',
        "{" * 2000,
        '{"goals": [{"of": "x", "p": "in", "a": "Mug", "not": true}]}',
    ],
)
def test_what_has_not_the_shape_is_refused_in_a_sentence(text: str) -> None:
    with pytest.raises(Misshapen) as fault:
        read_reply(text)
    assert 10 < len(str(fault.value)) < 200


def test_prose_around_the_object_does_no_harm() -> None:
    text = 'Sure {that} is it:\n```json\n{"goals": [], "talk": ["hello"]}\n```\nBye.'
    assert read_reply(text) == Reply(goals=(), talk=("hello",))


@pytest.mark.parametrize("cut", range(60, 190, 9))
def test_of_a_reply_that_broke_off_what_is_whole_counts_if_it_is_all(cut: int) -> None:
    say = "kill the telly and latch the box"
    text = json.dumps(reply(TELLY_OFF, "latch the box | closed | Box"))
    whole = text.index("}]") + 2 <= cut
    dialogue = Dialogue(WrittenModel(["{}"]), offered(say), Instruction(say, WORLD), WORLD)
    try:
        judged = dialogue.judge(read_reply(text[:cut]))
    except Misshapen:
        assert not whole
    else:
        assert whole
        assert written(judged.goals) == "off(Television) ; closed(Box)"


@pytest.mark.parametrize(
    ("say", "line", "p"),
    [
        ("kill the telly", "kill the telly | on | Television", "off"),
        ("close the macbook", "close the macbook | found | Laptop", "closed"),
        ("turn off the tube", "turn off the tube | on | Television", "off"),
        (STASH, f"{STASH} | found | Mug | b=Sink", "in"),
        (STASH, f"{STASH} | open | Sink", "open"),
        ("stash the mug on the sofa", "stash the mug on the sofa | open | Sofa", "open"),
        ("never kill the telly", "never kill the telly | on | Television", "on"),
        ("flip the laptop", "flip the laptop | clean | Laptop", "clean"),
        (BUT_ONE, f"{BUT_ONE} | on | DeskLamp | all=true", "on"),
    ],
)
def test_a_predicate_is_put_right_where_the_words_allow_one_only(say: str, line: str, p: str) -> None:
    given = read_reply(json.dumps(reply(line)))
    assert [wish.p for wish in mended(given, Instruction(say, WORLD)).goals] == [p]


SAY = "kill the telly"
NAMES = (*offered(SAY).types, *offered(SAY).rooms, EVERYTHING)
any_wish = st.fixed_dictionaries(
    {
        "of": st.sampled_from((SAY, "kill", "the telly", "kill the", "telly")),
        "p": st.sampled_from((*offered(SAY).predicates, "touched")),
        "a": st.sampled_from(NAMES) | st.just("Television"),
    },
    optional={
        "b": st.sampled_from(NAMES),
        "a_in": st.sampled_from(NAMES),
        "all": st.booleans(),
        "n": st.integers(1, 3),
        "except": st.lists(st.sampled_from(NAMES), max_size=2),
        "step": st.integers(1, 3),
    },
)


@settings(max_examples=300, deadline=None)
@given(
    goals=st.lists(any_wish, max_size=3),
    keep=st.lists(any_wish, max_size=1),
    talk=st.lists(st.sampled_from(("kill", "the telly")), max_size=1),
)
def test_no_reply_makes_more_of_an_instruction_than_it_says(goals: list[Any], keep: list[Any], talk: list[str]) -> None:
    """Whatever a model replies, and whoever has talked it into that."""
    accepted, _ = judge(SAY, {"goals": goals, "keep": keep, "talk": talk})
    assert accepted in ("", "off(Television)")
