"""A bag of the demo's scenes, made by the script and played to the node by the launch file."""
import os
import subprocess
import sys
import tempfile
import unittest

import launch
import launch_testing.actions
import pytest
from ament_index_python.packages import get_package_share_directory
from launch.launch_description_sources import PythonLaunchDescriptionSource
from posevote_msgs.msg import DetectionArray

import demo

SCRIPT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "scripts",
                      "make_demo_bag.py")


@pytest.mark.launch_test
def generate_test_description():
    folder = tempfile.mkdtemp()
    bag = os.path.join(folder, "demo")
    subprocess.run([sys.executable, SCRIPT, demo.path(""), bag, "--seconds", "1", "--rate", "2"],
                   check=True)
    file = os.path.join(get_package_share_directory("posevote_ros"), "launch", "demo.launch.py")
    arguments = {"bag": bag, "database": os.path.join(folder, "bag.db"), "heights": "poster=0.6",
                 "rviz": "false"}
    return launch.LaunchDescription([
        launch.actions.IncludeLaunchDescription(PythonLaunchDescriptionSource(file),
                                                launch_arguments=arguments.items()),
        launch_testing.actions.ReadyToTest()])


class BagTest(unittest.TestCase):
    def test_recognises_in_a_played_bag(self):
        robot = demo.Robot()
        self.addCleanup(robot.close)
        self.assertTrue(robot.wait_until(lambda: robot.state() == demo.ACTIVE))
        robot.teach_poster()
        answers = robot.collect(demo.NODE + "/detections", DetectionArray)

        def found():
            return [m for m in answers if m.detections]
        self.assertTrue(robot.wait_until(lambda: len(found()) >= 6))
        self.assertEqual({d.object for m in found() for d in m.detections}, {"poster"})
        self.assertTrue(all(d.has_pose for m in found() for d in m.detections))
        # Two pictures of each scene, and the poster stands in two scenes.
        stamps = {(m.header.stamp.sec, m.header.stamp.nanosec) for m in answers}
        self.assertLessEqual(stamps, {(1 + i // 2, i % 2 * 500000000) for i in range(16)})
        self.assertGreater(len(answers), len(found()))
