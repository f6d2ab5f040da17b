"""Two halves of the objects, each with a recogniser of its own, against all in one."""

import json

import posevote
from conftest import DEMO
from posevote import split

DATASET = json.loads((DEMO / "dataset.json").read_text(encoding="utf-8"))
# The first of each group of twins stands for all of them.
TWIN = {name: group[0] for group in DATASET["twins"] for name in group}


def taught():
    objects = {}
    for entry in DATASET["objects"]:
        objects[entry["name"]] = [
            posevote.teach_view(
                DEMO / view["image"],
                background=DEMO / view["background"] if "background" in view else None,
                yaw_deg=view.get("yaw"),
            )
            for view in entry["views"]
        ]
    return objects


def test_two_halves_answer_as_the_whole():
    objects = taught()
    names = sorted(objects)
    halves = [
        posevote.Recognizer({name: objects[name] for name in names[i::2]}) for i in range(2)
    ]
    whole = posevote.Recognizer(objects)
    same = different = 0
    for test in DATASET["tests"]:
        image = posevote.read_image(DEMO / test["image"])
        together = [detection.object for detection in whole.recognize(image)]
        joined = [d.object for d in split.join(half.recognize(image) for half in halves)]
        same += sorted(together) == sorted(joined)
        different += sorted(together) != sorted(joined)
        # What the whole finds and what is there, the halves find, too. Only a half that knows both
        # of two twins can tell them apart.
        asked = {truth["name"] for truth in test["objects"]}
        found = {TWIN.get(name, name) for name in set(together) & asked}
        assert found <= {TWIN.get(name, name) for name in joined}, test["image"]
        # Of what is not there, the halves name nothing that the whole does not, but a twin of it.
        allowed = {TWIN.get(name, name) for name in asked | set(together)}
        assert {TWIN.get(name, name) for name in joined} <= allowed, test["image"]
        print(test["image"], sorted(together), sorted(joined))
    assert same > different


def test_the_more_significant_claim_of_a_place_is_kept(poster, cover, scene):
    small = posevote.teach_view(cover[: cover.shape[0] * 2 // 3])
    results = [
        posevote.Recognizer({"part": [small]}).recognize(scene),
        posevote.Recognizer({"whole": [poster]}).recognize(scene),
    ]
    assert [len(result) for result in results] == [1, 1]
    best = min((result[0] for result in results), key=lambda d: d.log10_false_alarms)
    assert [d.object for d in split.join(results)] == [best.object]
    assert split.join([]) == []
