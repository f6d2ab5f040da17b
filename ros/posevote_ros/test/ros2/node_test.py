"""The component in its life cycle: teach a picture, be asked about another."""
import os
import tempfile
import unittest

import launch
import launch_ros.actions
import launch_testing.actions
import pytest
import rclpy
from lifecycle_msgs.msg import Transition
from lifecycle_msgs.srv import ChangeState
from posevote_msgs.action import Teach
from posevote_msgs.msg import DetectionArray
from posevote_msgs.srv import ListObjects
from rclpy.action import ActionClient
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import CompressedImage, Image

TIMEOUT_S = 60


@pytest.mark.launch_test
def generate_test_description():
    database = os.path.join(tempfile.mkdtemp(), "objects.db")
    node = launch_ros.actions.LifecycleNode(
        package="posevote_ros", executable="posevote_node", name="posevote", namespace="",
        parameters=[{"database": database, "transport": "compressed"}],
        remappings=[("image", "/camera/image_raw")], output="screen")
    return launch.LaunchDescription([launch.actions.DeclareLaunchArgument("demo"), node,
                                     launch_testing.actions.ReadyToTest()])


class NodeTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rclpy.init()
        cls.node = rclpy.create_node("node_test")

    @classmethod
    def tearDownClass(cls):
        cls.node.destroy_node()
        rclpy.shutdown()

    def wait(self, future):
        rclpy.spin_until_future_complete(self.node, future, timeout_sec=TIMEOUT_S)
        self.assertTrue(future.done())
        return future.result()

    def call(self, kind, name, request):
        client = self.node.create_client(kind, name)
        self.assertTrue(client.wait_for_service(TIMEOUT_S))
        return self.wait(client.call_async(request))

    def change_state(self, transition):
        request = ChangeState.Request(transition=Transition(id=transition))
        self.assertTrue(self.call(ChangeState, "/posevote/change_state", request).success)

    def test_life_cycle_teaching_and_detections(self, test_args):
        self.change_state(Transition.TRANSITION_CONFIGURE)
        self.change_state(Transition.TRANSITION_ACTIVATE)

        camera = self.node.create_publisher(CompressedImage, "/camera/image_raw/compressed",
                                            qos_profile_sensor_data)
        with open(os.path.join(test_args["demo"], "train/poster/cover.jpg"), "rb") as file:
            cover = CompressedImage(format="jpeg", data=file.read())
        with open(os.path.join(test_args["demo"], "test/reading.jpg"), "rb") as file:
            scene = CompressedImage(format="jpeg", data=file.read())

        def send(picture):
            picture.header.stamp = self.node.get_clock().now().to_msg()
            camera.publish(picture)

        teach = ActionClient(self.node, Teach, "/posevote/teach")
        self.assertTrue(teach.wait_for_server(TIMEOUT_S))
        goal = self.wait(teach.send_goal_async(Teach.Goal(object="poster", method="whole")))
        self.assertTrue(goal.accepted)
        timer = self.node.create_timer(0.1, lambda: send(cover))
        result = self.wait(goal.get_result_async()).result
        self.node.destroy_timer(timer)
        self.assertTrue(result.success, result.message)
        listed = self.call(ListObjects, "/posevote/list_objects", ListObjects.Request())
        self.assertEqual([o.object for o in listed.database.objects], ["poster"])

        answers, drawn = [], []
        self.node.create_subscription(DetectionArray, "/posevote/detections", answers.append, 1)
        self.node.create_subscription(Image, "/posevote/annotated", drawn.append, 1)
        timer = self.node.create_timer(0.2, lambda: send(scene))
        end = self.node.get_clock().now().nanoseconds + TIMEOUT_S * 10**9
        while not (any(a.detections for a in answers) and drawn):
            self.assertLess(self.node.get_clock().now().nanoseconds, end)
            rclpy.spin_once(self.node, timeout_sec=0.5)
        self.node.destroy_timer(timer)
        found = next(a for a in answers if a.detections)
        self.assertEqual([d.object for d in found.detections], ["poster"])
        self.assertEqual((found.image_width, drawn[0].width), (1280, 1280))

        self.change_state(Transition.TRANSITION_DEACTIVATE)
        self.change_state(Transition.TRANSITION_CLEANUP)
        self.change_state(Transition.TRANSITION_CONFIGURE)
