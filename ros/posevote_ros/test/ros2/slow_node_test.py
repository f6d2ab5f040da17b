"""A camera at 30 Hz and a node that is slower: results are of the newest picture."""
import os
import tempfile
import unittest

import launch
import launch_ros.actions
import launch_testing.actions
import pytest
from posevote_msgs.msg import DetectionArray
from rclpy.time import Time
from sensor_msgs.msg import CompressedImage

import demo

RATE_HZ = 30
RESULTS = 12


@pytest.mark.launch_test
def generate_test_description():
    database = os.path.join(tempfile.mkdtemp(), "slow_node.db")
    node = launch_ros.actions.LifecycleNode(
        package="posevote_ros", executable="posevote_node", name="posevote", namespace="",
        # Large pictures of many features: far slower than the camera.
        parameters=[{"database": database, "transport": "compressed", "feature.max_features": 0,
                     "feature.surf.hessian_threshold": 1.0, "feature.surf.double_size": True}],
        remappings=[("image", demo.CAMERA)], output="screen")
    return launch.LaunchDescription([node, launch_testing.actions.ReadyToTest()])


class SlowNodeTest(unittest.TestCase):
    def test_latency_does_not_grow(self):
        robot = demo.Robot()
        self.addCleanup(robot.close)
        self.assertTrue(robot.change_state(demo.CONFIGURE) and robot.change_state(demo.ACTIVATE))
        answers, waits_ms = [], []

        def now():
            return robot.node.get_clock().now()

        def receive(message):
            age_ms = (now() - Time.from_msg(message.header.stamp)).nanoseconds / 1e6
            waits_ms.append(age_ms - message.time_ms)
            answers.append(message)
        robot.node.create_subscription(DetectionArray, demo.NODE + "/detections", receive, 10)

        picture = demo.compressed("test/kitchen.jpg")
        camera = robot.camera(CompressedImage, demo.CAMERA + "/compressed")

        def send():
            picture.header.stamp = now().to_msg()
            camera.publish(picture)
        robot.node.create_timer(1 / RATE_HZ, send)
        self.assertTrue(robot.wait_until(lambda: len(answers) >= RESULTS))

        stamps = [(m.header.stamp.sec, m.header.stamp.nanosec) for m in answers]
        self.assertEqual(stamps, sorted(stamps))
        later = answers[1:]
        times = sorted(m.time_ms for m in later)
        median_ms = times[len(times) // 2]
        self.assertGreater(median_ms, 1e3 / RATE_HZ, "this node is not slow: nothing is shown")
        self.assertGreater(sum(m.dropped for m in later), 0)
        # With a queue the wait would grow by a recognition with every result.
        waits = sorted(waits_ms[1:])
        self.assertLess(waits[len(waits) // 2], max(median_ms, 4e3 / RATE_HZ))
