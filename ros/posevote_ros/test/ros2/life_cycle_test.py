"""The component in a container, without copying pictures, through its life cycle."""
import os
import tempfile
import unittest

import launch
import launch_ros.actions
import launch_testing.actions
import launch_testing.asserts
import pytest
from composition_interfaces.srv import ListNodes, LoadNode, UnloadNode
from diagnostic_msgs.msg import DiagnosticArray
from posevote_msgs.msg import DatabaseInfo, DetectionArray
from rclpy.parameter import Parameter

import demo

CONTAINER = "/container"
FOLDER = tempfile.mkdtemp()


@pytest.mark.launch_test
def generate_test_description():
    container = launch_ros.actions.Node(
        package="rclcpp_components", executable="component_container_mt", name="container",
        output="screen")
    return launch.LaunchDescription([container, launch_testing.actions.ReadyToTest()])


class LifeCycleTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.robot = demo.Robot()

    @classmethod
    def tearDownClass(cls):
        cls.robot.close()

    def load(self, **parameters):
        answer = self.robot.call(
            "_container/load_node", LoadNode, CONTAINER, package_name="posevote_ros",
            plugin_name="posevote::ros2::Node", remap_rules=["image:=" + demo.CAMERA],
            parameters=[Parameter(name, value=value).to_parameter_msg()
                        for name, value in parameters.items()],
            extra_arguments=[Parameter("use_intra_process_comms", value=True).to_parameter_msg()])
        self.assertTrue(answer.success, answer.error_message)
        self.assertEqual(answer.full_node_name, demo.NODE)
        self.addCleanup(self.unload, answer.unique_id)

    def unload(self, number):
        answer = self.robot.call("_container/unload_node", UnloadNode, CONTAINER, unique_id=number)
        self.assertTrue(answer.success, answer.error_message)
        self.assertEqual(self.robot.call("_container/list_nodes", ListNodes,
                                         CONTAINER).full_node_names, [])

    def change_state(self, transition, state):
        self.assertTrue(self.robot.change_state(transition))
        self.assertEqual(self.robot.state(), state)

    def topics(self):
        return {name for name, _ in self.robot.node.get_topic_names_and_types()}

    def subscribers(self):
        return self.robot.node.count_subscribers(demo.CAMERA)

    def test_every_step_and_back(self):
        self.load(database=os.path.join(FOLDER, "life_cycle.db"))
        self.assertEqual(self.robot.state(), demo.UNCONFIGURED)
        detections_topic = demo.NODE + "/detections"
        for _ in range(2):
            self.assertNotIn(detections_topic, self.topics())
            self.change_state(demo.CONFIGURE, demo.INACTIVE)
            self.robot.forget_objects()
            self.robot.teach_poster()  # also while it does not look at the camera
            detections = self.robot.collect(detections_topic, DetectionArray)
            self.assertEqual(self.subscribers(), 0)
            self.change_state(demo.ACTIVATE, demo.ACTIVE)
            infos = self.robot.collect(demo.NODE + "/database", DatabaseInfo, demo.LATCHED)
            self.assertTrue(self.robot.wait_until(lambda: infos))
            self.assertEqual([o.object for o in infos[0].objects], ["poster"])
            answer = self.robot.ask(detections, demo.image(demo.SCENE, "mono8"))
            self.assertEqual([d.object for d in answer.detections], ["poster"])
            self.change_state(demo.DEACTIVATE, demo.INACTIVE)
            self.assertTrue(self.robot.wait_until(lambda: self.subscribers() == 0))
            self.change_state(demo.ACTIVATE, demo.ACTIVE)
            self.robot.ask(detections, demo.image(demo.SCENE, "mono8"))
            self.change_state(demo.DEACTIVATE, demo.INACTIVE)
            self.robot.forget(detections)
            self.robot.forget(infos)
            self.change_state(demo.CLEANUP, demo.UNCONFIGURED)
            self.assertTrue(self.robot.wait_until(lambda: detections_topic not in self.topics()))

    def test_unloading_an_active_node(self):
        self.load(database=os.path.join(FOLDER, "active.db"))
        self.change_state(demo.CONFIGURE, demo.INACTIVE)
        self.change_state(demo.ACTIVATE, demo.ACTIVE)
        self.robot.publish(demo.image(demo.SCENE, "mono8"))

    def test_what_cannot_be_configured_is_told_and_can_be_mended(self):
        self.load(database="/dev/null/objects.db")
        self.assertFalse(self.robot.change_state(demo.CONFIGURE))
        self.assertEqual(self.robot.state(), demo.UNCONFIGURED)
        self.assertEqual(
            self.robot.set_parameters(database=os.path.join(FOLDER, "mended.db")), [""])
        self.change_state(demo.CONFIGURE, demo.INACTIVE)
        diagnostics = self.robot.collect("/diagnostics", DiagnosticArray)

        def said():
            return {s.name: s.message for m in diagnostics for s in m.status}
        expected = {"posevote: recognition": "not active",
                    "posevote: database": "no objects are taught yet"}
        self.assertTrue(self.robot.wait_until(lambda: said() == expected), said())
        self.robot.forget(diagnostics)


@launch_testing.post_shutdown_test()
class AfterwardsTest(unittest.TestCase):
    def test_all_ended_well(self, proc_info):
        launch_testing.asserts.assertExitCodes(proc_info)
