"""Evaluation of a data set."""

import pytest

import posevote


def test_the_demonstration_is_evaluated(demo):
    steps = []
    result = posevote.evaluate(
        demo, limit=2, negatives=None, progress=lambda *step: steps.append(step)
    )
    assert result.objects == 8 and result.views > 8 and result.refused == []
    assert result.summary.images == 2
    assert 0 < result.summary.right <= result.summary.asked
    assert result.summary.recall == result.summary.right / result.summary.asked
    assert {group.name for group in result.groups} <= {"tidy", "cluttered", "occluded", ""} | {
        group.name for group in result.groups
    }
    assert sum(group.asked for group in result.groups) == result.summary.asked
    assert result.to_dict()["objects"] == 8
    assert steps[-1][1] == steps[-1][2]
    assert "asked=" in repr(result) and result.summary.to_dict()["images"] == 2


def test_wrong_arguments_are_refused(demo, tmp_path):
    with pytest.raises(posevote.OptionError) as caught:
        posevote.evaluate(demo, teach_min_featurs=3)
    assert "teach_min_features" in str(caught.value)
    with pytest.raises(posevote.InvalidArgumentError):
        posevote.evaluate(demo, groups=["nothing like this"])
    with pytest.raises(posevote.Error):
        posevote.evaluate(tmp_path)


def test_options_reach_the_evaluation(demo):
    # A view that needs more features than there are cannot be taught.
    result = posevote.evaluate(demo, limit=1, teach_min_features=100000)
    assert result.objects == 0 and len(result.refused) > 8
    assert result.summary.recall in (0, None)
