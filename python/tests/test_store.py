"""Databases of objects."""

import json
import os
import subprocess
import threading

import numpy as np
import pytest

import posevote


def test_objects_are_taught_kept_and_found_again(tmp_path, demo, scene):
    path = tmp_path / "objects.db"
    with posevote.ObjectStore(path) as store:
        assert store.objects() == [] and store.signature is None
        result = store.teach("poster", demo / "train/poster/cover.jpg", yaw_deg=0)
        assert result.added and result.id == "1"
        assert not store.teach("poster", demo / "train/poster/cover.jpg", yaw_deg=0).added
    with posevote.ObjectStore(path, "read_only") as store:
        assert store.read_only
        recognizer = posevote.Recognizer(store)
        found = recognizer.recognize(scene)
        assert [(d.object, d.view) for d in found] == [("poster", "1")]
        assert repr(store) == f"ObjectStore('{path}')"
    with pytest.raises(posevote.IoError):
        store.objects()
    assert repr(store) == "ObjectStore(closed)"


def test_views_come_back_as_they_were_added(store, poster):
    store.add_view("poster", poster)
    view = store.view("poster", "1")
    assert np.array_equal(view.features.keypoints, poster.features.keypoints)
    assert np.array_equal(view.outline, poster.outline)
    assert view.hash == store.views("poster")[0].hash != ""
    assert view.taught_at.endswith("Z") and view.signature == store.signature
    pictures = store.load(pictures=True).views("poster")[0]
    assert np.array_equal(pictures.picture, poster.picture)
    assert np.array_equal(pictures.mask, poster.mask)
    assert store.load().views("poster")[0].picture is None


def test_summaries_are_typed_and_plain(store, poster):
    store.add_view("der große Becher 🍵", poster)
    summary = store.objects()[0]
    assert summary.name == "der große Becher 🍵" and summary.views == 1
    assert summary.to_dict()["features"] == len(poster.features)
    view = store.views(summary.name)[0]
    assert view.image_size == poster.image_size and view.yaw_deg is None
    assert view.to_dict()["method"] == "whole"
    for shown in (summary, view):
        assert type(shown).__name__ in repr(shown)


def test_changes_and_their_errors(store, poster):
    version = store.version
    store.add_view("a", poster)
    store.add_view("b", poster)
    assert store.version > version
    with pytest.raises(posevote.AlreadyExistsError):
        store.rename_object("a", "b")
    with pytest.raises(posevote.NotFoundError):
        store.remove_object("c")
    with pytest.raises(posevote.InvalidArgumentError):
        store.add_view("bad\nname", poster)
    store.rename_object("a", "c")
    store.remove_view("c", "1")
    store.remove_object("b")
    assert store.objects() == []


def test_a_transaction_is_all_or_nothing(store, poster):
    class Enough(Exception):
        pass

    def work():
        store.add_view("a", poster)
        raise Enough

    with pytest.raises(Enough):
        store.transact(work)
    assert store.objects() == []
    store.transact(lambda: store.add_view("a", poster))
    assert [o.name for o in store.objects()] == ["a"]


def test_features_of_another_kind_are_refused_and_the_own_are_used(store, cover, poster):
    store.add_view("sift", posevote.teach_view(cover, feature_kind="sift"))
    with pytest.raises(posevote.FeatureMismatchError):
        store.add_view("surf", poster)
    store.teach("same kind", cover)
    assert store.view("same kind", "1").features.descriptors.shape[1] == 128


def test_objects_are_copied_and_exported(store, poster, tmp_path):
    store.add_view("poster", poster)
    assert store.export(tmp_path / "file.posevote").views_added == 1
    with pytest.raises(posevote.AlreadyExistsError):
        store.export(tmp_path / "file.posevote")
    with posevote.ObjectStore(tmp_path / "other.db") as other:
        with posevote.ObjectStore(tmp_path / "file.posevote", "read_only") as file:
            assert other.copy_from(file).objects == 1
            with pytest.raises(posevote.AlreadyExistsError):
                other.copy_from(file)
            merged = other.copy_from(file, ["poster"], on_conflict="merge")
            assert merged.to_dict() == {"objects": 1, "views_added": 0, "views_known": 1}
            with pytest.raises(posevote.InvalidArgumentError):
                other.copy_from(file, on_conflict="perhaps")


def test_changes_of_others_can_be_waited_for(store, poster, tmp_path):
    version = store.version
    assert not store.wait_for_change(version, 0.01)

    def teach():
        with posevote.ObjectStore(store.location) as other:
            other.add_view("poster", poster)

    thread = threading.Thread(target=teach)
    thread.start()
    assert store.wait_for_change(version, 60)
    thread.join()
    recognizer = posevote.Recognizer({})
    recognizer.set_models(store)
    assert recognizer.models.names == ["poster"]


def test_what_is_no_database_is_said(tmp_path):
    path = tmp_path / "text.db"
    path.write_text("This is no database, whatever its name may say. " * 50)
    with pytest.raises(posevote.DatabaseError) as caught:
        posevote.ObjectStore(path)
    assert "text.db" in str(caught.value)


@pytest.mark.skipif("POSEVOTE_PROGRAM" not in os.environ, reason="there is no program")
def test_program_and_package_give_the_same(tmp_path, demo):
    """Taught and recognised by either, the other says the same of it."""
    scenes = [str(demo / "test" / name) for name in ("reading.jpg", "kitchen.jpg")]
    views = [demo / "train/muesli" / name for name in ("y000.jpg", "y036.jpg")]
    background = demo / "train/muesli/background.jpg"
    program = os.environ["POSEVOTE_PROGRAM"]

    def run(database, *arguments):
        done = subprocess.run(
            [program, *arguments, "--db", database], check=True, capture_output=True, text=True
        )
        return [json.loads(line) for line in done.stdout.splitlines() if line.startswith("{")]

    def without_times(result):
        return {key: value for key, value in result.items() if key != "time_ms"}

    by_program, by_package = str(tmp_path / "program.db"), str(tmp_path / "package.db")
    run(by_program, "teach", "muesli", *map(str, views), "--background", str(background), "--yaw", "0", "36")
    run(by_program, "teach", "poster", str(demo / "train/poster/cover.jpg"))
    with posevote.ObjectStore(by_package) as store:
        for view, yaw in zip(views, (0, 36)):
            store.teach("muesli", view, background=background, yaw_deg=yaw)
        store.teach("poster", demo / "train/poster/cover.jpg")
        hashes = [view.hash for view in store.views("muesli")]
        recognizer = posevote.Recognizer(store)
    assert hashes == [line["hash"] for line in run(by_program, "objects", "show", "muesli", "--json")]
    here = [recognizer.recognize(posevote.read_image(s)).to_dict(s) for s in scenes]
    there = run(by_program, "recognize", *scenes, "--json")
    assert [without_times(line) for line in here] == [without_times(line) for line in there]
    assert sum(len(line["detections"]) for line in here) >= 2
