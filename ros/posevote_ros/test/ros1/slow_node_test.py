#!/usr/bin/python3
"""A camera at 30 Hz and a node that is slower: results are of the newest picture."""
import sys
import unittest

import rospy
import rostest
from posevote_msgs.msg import DetectionArray
from sensor_msgs.msg import Image

import demo

RATE_HZ = 30
RESULTS = 12


class SlowNodeTest(unittest.TestCase):
    def test_latency_does_not_grow(self):
        answers, waits_ms = [], []

        def receive(message):
            age_ms = (rospy.Time.now() - message.header.stamp).to_sec() * 1e3
            waits_ms.append(age_ms - message.time_ms)
            answers.append(message)
        rospy.Subscriber("/posevote/detections", DetectionArray, receive)

        camera = rospy.Publisher("/camera/image_raw", Image, queue_size=1)
        picture = demo.image("test/kitchen.jpg")
        rate = rospy.Rate(RATE_HZ)
        while len(answers) < RESULTS and not rospy.is_shutdown():
            picture.header.stamp = rospy.Time.now()
            camera.publish(picture)
            rate.sleep()

        stamps = [m.header.stamp for m in answers]
        self.assertEqual(stamps, sorted(stamps))
        later = answers[1:]
        times = sorted(m.time_ms for m in later)
        median_ms = times[len(times) // 2]
        self.assertGreater(median_ms, 1e3 / RATE_HZ, "this node is not slow: nothing is shown")
        self.assertGreater(sum(m.dropped for m in later), 0)
        # With a queue the wait would grow by a recognition with every result.
        waits = sorted(waits_ms[1:])
        self.assertLess(waits[len(waits) // 2], max(median_ms, 4e3 / RATE_HZ))


if __name__ == "__main__":
    rospy.init_node("slow_node_test")
    rostest.rosrun("posevote_ros", "slow_node", SlowNodeTest, sys.argv)
