"""The node, configured and activated.

ros2 launch posevote_ros posevote.launch.py image:=/camera/image_raw
"""
import os

from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, EmitEvent, ExecuteProcess, RegisterEventHandler
from launch.conditions import IfCondition
from launch.event_handlers import OnProcessStart
from launch.events import matches_action
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import LifecycleNode, Node
from launch_ros.event_handlers import OnStateTransition
from launch_ros.events.lifecycle import ChangeState
from launch_ros.parameter_descriptions import ParameterValue
from lifecycle_msgs.msg import Transition

ARGUMENTS = {
    "image": ("/camera/image_raw", "topic of the pictures; camera_info is beside it"),
    "transport": ("raw", "raw or compressed"),
    "database": ("", "file of the objects; empty: that of the program posevote"),
    "heights": ("", "heights in metres, which give poses: mug=0.095; poster=0.6"),
    "tf": ("false", "send a tf frame for every confirmed object with a pose"),
    # Default: config/posevote.yaml.
    "params": (None, "a YAML file of parameters, which win over these arguments"),
    "autostart": ("true", "configure and activate the node"),
    "rviz": ("false", "also show the results"),
    "studio": ("false", "also serve the page for teaching in a browser"),
    "listen": ("127.0.0.1:8080", "where that page is served"),
}


def change_state(node, transition):
    return EmitEvent(event=ChangeState(lifecycle_node_matcher=matches_action(node),
                                       transition_id=transition))


def generate_launch_description():
    share = get_package_share_directory("posevote_ros")
    text = {name: ParameterValue(LaunchConfiguration(name), value_type=str)
            for name in ("transport", "database", "heights")}
    defaults = {"params": os.path.join(share, "config", "posevote.yaml")}
    node = LifecycleNode(
        package="posevote_ros", executable="posevote_node", name="posevote", namespace="",
        output="screen", remappings=[("image", LaunchConfiguration("image"))],
        parameters=[{"transport": text["transport"], "database": text["database"],
                     "object_heights": text["heights"],
                     "publish_tf": ParameterValue(LaunchConfiguration("tf"), value_type=bool)},
                    LaunchConfiguration("params")])
    autostart = IfCondition(LaunchConfiguration("autostart"))
    return LaunchDescription(
        [DeclareLaunchArgument(name, default_value=defaults.get(name, value),
                               description=description)
         for name, (value, description) in ARGUMENTS.items()] + [
            RegisterEventHandler(OnProcessStart(
                target_action=node,
                on_start=[change_state(node, Transition.TRANSITION_CONFIGURE)]),
                condition=autostart),
            RegisterEventHandler(OnStateTransition(
                target_lifecycle_node=node, start_state="configuring", goal_state="inactive",
                entities=[change_state(node, Transition.TRANSITION_ACTIVATE)]),
                condition=autostart),
            node,
            Node(package="rviz2", executable="rviz2",
                 arguments=["-d", os.path.join(share, "rviz", "ros2.rviz")],
                 condition=IfCondition(LaunchConfiguration("rviz"))),
            ExecuteProcess(cmd=[os.path.join(share, "..", "..", "lib", "posevote_ros", "studio"),
                                LaunchConfiguration("database"), LaunchConfiguration("listen")],
                           condition=IfCondition(LaunchConfiguration("studio")),
                           output="screen")])
