#!/usr/bin/python3
"""A bag of the demo's scenes, made by the script and played to the nodelet."""
import os
import subprocess
import sys
import unittest

import rosbag
import rosnode
import rospy
import rosservice
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

    def test_unloads_while_it_teaches(self):  # the last one: the nodelet is gone then
        steps = []
        teach = demo.TeachClient()
        teach.send_goal(TeachGoal(object="mug", timeout_s=120),
                        feedback_cb=lambda f: steps.append(f.step))
        self.assertTrue(demo.wait_until(lambda: steps))
        self.assertIn("/posevote/detect", rosservice.get_service_list())
        rosnode.kill_nodes(["/posevote"])  # its loader, which has the manager unload it
        self.assertTrue(demo.wait_until(
            lambda: "/posevote/detect" not in rosservice.get_service_list(), 40))


if __name__ == "__main__":
    rospy.init_node("bag_test")
    rostest.rosrun("posevote_ros", "bag", BagTest, sys.argv)
