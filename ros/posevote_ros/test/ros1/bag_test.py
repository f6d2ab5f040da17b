#!/usr/bin/python3
"""A bag of the demo's scenes, made by the script and played to the nodelet."""
import os
import subprocess
import sys
import unittest

import rosbag
import rospy
import rostest
from posevote_msgs.msg import DetectionArray, TeachGoal

import demo


class BagTest(unittest.TestCase):
    def test_recognises_in_a_played_bag(self):
        bag = os.path.join(rospy.get_param("/folder"), "demo.bag")
        script = os.path.join(os.path.dirname(os.path.dirname(os.path.dirname(
            os.path.abspath(demo.__file__)))), "scripts", "make_demo_bag.py")
        subprocess.run([sys.executable, script, rospy.get_param("/demo"), bag, "--seconds", "1",
                        "--rate", "2"], check=True)
        with rosbag.Bag(bag) as file:
            stamps = {m.header.stamp for topic, m, _ in
                      file.read_messages("/camera/image_raw/compressed")}
        self.assertEqual(len(stamps), 16)

        teach = demo.TeachClient()
        poster = demo.image("train/poster/cover.jpg", rospy.Time(1))
        teach.send_goal(TeachGoal(object="poster", method="whole", images=[poster]))
        result = teach.wait_for_result()
        self.assertTrue(result and result.success, result)

        detections = demo.Collector("/posevote/detections", DetectionArray)
        subprocess.run(["rosbag", "play", "--delay", "2", bag], check=True,
                       stdout=subprocess.DEVNULL)
        self.assertIsNotNone(detections.wait_for(lambda m: m.detections, 20))
        found = [m.header.stamp for m in detections.messages if m.detections]
        self.assertGreaterEqual(len(found), 2)  # the poster stands in two scenes
        self.assertTrue(set(m.header.stamp for m in detections.messages) <= stamps)
        names = {d.object for m in detections.messages for d in m.detections}
        self.assertEqual(names, {"poster"})


if __name__ == "__main__":
    rospy.init_node("bag_test")
    rostest.rosrun("posevote_ros", "bag", BagTest, sys.argv)
