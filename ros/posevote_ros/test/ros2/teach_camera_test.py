"""The Teach action end to end: a camera that shows what the feedback asks for."""
import os
import tempfile
import unittest

import launch
import launch_ros.actions
import launch_testing.actions
import pytest
from action_msgs.msg import GoalStatus
from posevote_msgs import srv
from posevote_msgs.msg import DetectionArray
from sensor_msgs.msg import CompressedImage

import demo


@pytest.mark.launch_test
def generate_test_description():
    database = os.path.join(tempfile.mkdtemp(), "teach_camera.db")
    node = launch_ros.actions.LifecycleNode(
        package="posevote_ros", executable="posevote_node", name="posevote", namespace="",
        parameters=[{"database": database, "transport": "compressed", "watch.rest_s": 0.3}],
        remappings=[("image", demo.CAMERA)], output="screen")
    return launch.LaunchDescription([node, launch_testing.actions.ReadyToTest()])


class TeachCameraTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.robot = demo.Robot()
        assert cls.robot.change_state(demo.CONFIGURE) and cls.robot.change_state(demo.ACTIVATE)
        cls.picture = None
        cls.camera = cls.robot.camera(CompressedImage, demo.CAMERA + "/compressed")
        cls.timer = cls.robot.node.create_timer(0.1, cls.send)

    @classmethod
    def tearDownClass(cls):
        cls.robot.close()

    @classmethod
    def send(cls):
        if cls.picture:
            cls.picture.header.stamp = cls.robot.node.get_clock().now().to_msg()
            cls.camera.publish(cls.picture)

    def show(self, name):
        type(self).picture = demo.compressed(name)

    def setUp(self):
        self.robot.forget_objects()

    def test_teaches_two_views_and_recognises(self):
        pictures = {0: "train/muesli/y000.jpg", 1: "train/muesli/y036.jpg"}
        feedback = []

        def follow(news):
            feedback.append(news)
            if news.step in ("object", "turn"):
                self.show(pictures[news.views_taken])

        self.show("train/muesli/background.jpg")
        result, succeeded = self.robot.teach(follow, object="muesli", views=2, turn_deg=36.0,
                                             timeout_s=60.0)
        self.assertTrue(result.success and succeeded, result.message)
        self.assertEqual(result.views_added, 2)
        # The last one, "done", may come after the result.
        self.assertEqual([f.step for f in feedback[:3]], ["background", "object", "turn"])
        turn = feedback[2]
        self.assertEqual(list(turn.yaws_deg), [0])
        self.assertGreater(turn.features, 50)
        self.assertEqual((turn.preview.width, turn.preview.height), (640, 480))

        self.show("test/breakfast.jpg")
        detections = self.robot.collect(demo.NODE + "/detections", DetectionArray)
        found = self.robot.wait_until(
            lambda: [m for m in detections if [d.object for d in m.detections] == ["muesli"]])
        self.robot.forget(detections)
        self.assertTrue(found)

    def test_manual_pictures_are_taken_when_asked_for(self):
        self.assertFalse(self.robot.call("capture", srv.Capture).success)
        steps = []
        self.show("train/poster/cover.jpg")
        goal = self.robot.start_teaching(lambda news: steps.append(news.step), object="poster",
                                         method="whole", manual=True)
        self.assertTrue(goal.accepted)
        self.assertTrue(self.robot.wait_until(lambda: steps == ["object"]))
        self.assertFalse(self.robot.start_teaching(object="another").accepted)
        self.assertTrue(self.robot.call("capture", srv.Capture).success)
        self.assertTrue(self.robot.wait_for(goal.get_result_async()).result.success)

    def test_can_be_cancelled(self):
        self.show("train/mug/background.jpg")
        goal = self.robot.start_teaching(object="mug")
        self.robot.wait_for(goal.cancel_goal_async())
        self.assertEqual(self.robot.wait_for(goal.get_result_async()).status,
                         GoalStatus.STATUS_CANCELED)

    def test_gives_up_when_nothing_is_shown(self):
        self.show("train/mug/background.jpg")
        result, succeeded = self.robot.teach(object="mug", timeout_s=3.0)
        self.assertFalse(result.success or succeeded)
        self.assertIn("'object'", result.message)

    def test_ends_when_the_node_is_cleaned_up(self):
        self.show("train/mug/background.jpg")
        goal = self.robot.start_teaching(object="mug")
        answer = goal.get_result_async()
        self.robot.wait_until(answer.done, 1)  # the node must have this request before it ends
        self.assertTrue(self.robot.change_state(demo.DEACTIVATE))
        self.assertTrue(self.robot.change_state(demo.CLEANUP))
        self.assertEqual(self.robot.wait_for(answer).status, GoalStatus.STATUS_ABORTED)
        self.assertTrue(self.robot.change_state(demo.CONFIGURE))
        self.assertTrue(self.robot.change_state(demo.ACTIVATE))
