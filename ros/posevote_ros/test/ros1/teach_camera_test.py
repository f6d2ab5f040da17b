#!/usr/bin/python3
"""The Teach action end to end: a camera that shows what the feedback asks for."""
import sys
import threading
import unittest

import rospy
import rostest
from actionlib_msgs.msg import GoalStatus
from posevote_msgs import srv
from posevote_msgs.msg import DetectionArray, TeachGoal
from sensor_msgs.msg import Image

import demo

NODE = "/posevote/"


class Camera:
    """Sends its picture ten times a second."""

    def __init__(self):
        self._publisher = rospy.Publisher("/camera/image_raw", Image, queue_size=1)
        self._lock = threading.Lock()
        self._picture = None
        self._timer = rospy.Timer(rospy.Duration(0.1), self._send)

    def show(self, name):
        picture = demo.image(name)
        with self._lock:
            self._picture = picture

    def _send(self, _):
        with self._lock:
            if self._picture:
                self._picture.header.stamp = rospy.Time.now()
                self._publisher.publish(self._picture)


class TeachCameraTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.camera = Camera()
        cls.client = demo.TeachClient()

    def setUp(self):
        listing = rospy.ServiceProxy(NODE + "list_objects", srv.ListObjects)
        listing.wait_for_service(30)
        remove = rospy.ServiceProxy(NODE + "remove_object", srv.RemoveObject)
        for known in listing().database.objects:
            self.assertTrue(remove(object=known.object).success)

    def test_teaches_two_views_and_recognises(self):
        pictures = {0: "train/muesli/y000.jpg", 1: "train/muesli/y036.jpg"}
        feedback = []

        def follow(news):
            feedback.append(news)
            if news.step in ("object", "turn"):
                self.camera.show(pictures[news.views_taken])

        self.camera.show("train/muesli/background.jpg")
        self.client.send_goal(TeachGoal(object="muesli", views=2, turn_deg=36, timeout_s=60),
                              feedback_cb=follow)
        result = self.client.wait_for_result(120)
        self.assertTrue(result and result.success, result)
        self.assertEqual(result.views_added, 2)
        # The last one, "done", may come after the result.
        self.assertEqual([f.step for f in feedback[:3]], ["background", "object", "turn"])
        turn = feedback[2]
        self.assertEqual(list(turn.yaws_deg), [0])
        self.assertGreater(turn.features, 50)
        self.assertEqual((turn.preview.width, turn.preview.height), (640, 480))

        self.camera.show("test/breakfast.jpg")
        detections = demo.Collector(NODE + "detections", DetectionArray)
        found = detections.wait_for(lambda m: [d.object for d in m.detections] == ["muesli"])
        detections.close()
        self.assertIsNotNone(found)

    def test_manual_pictures_are_taken_when_asked_for(self):
        capture = rospy.ServiceProxy(NODE + "capture", srv.Capture)
        capture.wait_for_service(30)
        self.assertFalse(capture().success)
        steps = []
        self.camera.show("train/poster/cover.jpg")
        self.client.send_goal(TeachGoal(object="poster", method="whole", manual=True),
                              feedback_cb=lambda f: steps.append(f.step))
        demo.wait_until(lambda: steps)
        self.assertEqual(steps, ["object"])
        self.assertTrue(capture().success)
        result = self.client.wait_for_result()
        self.assertTrue(result and result.success, result)

    def test_can_be_cancelled(self):
        self.camera.show("train/mug/background.jpg")
        for _ in range(20):  # at once, when the goal may not even have come
            self.client.send_goal(TeachGoal(object="mug"))
            self.client.cancel_goal()
            self.assertIsNotNone(self.client.wait_for_result())
            self.assertIn(self.client.get_status(), (GoalStatus.PREEMPTED, GoalStatus.RECALLED))

    def test_gives_up_when_nothing_is_shown(self):
        self.camera.show("train/mug/background.jpg")
        self.client.send_goal(TeachGoal(object="mug", timeout_s=3))
        result = self.client.wait_for_result()
        self.assertEqual(self.client.get_status(), GoalStatus.ABORTED)
        self.assertIn("'object'", result.message)


if __name__ == "__main__":
    rospy.init_node("teach_camera_test")
    rostest.rosrun("posevote_ros", "teach_camera", TeachCameraTest, sys.argv)
