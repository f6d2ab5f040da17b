"""A bag (see make_demo_bag.py) played round and round, the node, RViz.

ros2 launch posevote_ros demo.launch.py bag:=/tmp/demo database:=/tmp/demo.db
"""
import os

from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess, IncludeLaunchDescription
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import SetParameter


def generate_launch_description():
    share = get_package_share_directory("posevote_ros")
    names = ("database", "heights", "rviz")
    return LaunchDescription([
        DeclareLaunchArgument("bag", description="the bag's folder"),
        DeclareLaunchArgument("database", default_value=""),
        DeclareLaunchArgument("heights", default_value=""),
        DeclareLaunchArgument("rviz", default_value="true"),
        SetParameter("use_sim_time", True),
        ExecuteProcess(cmd=["ros2", "bag", "play", "--loop", "--clock", "40",
                            "--disable-keyboard-controls", LaunchConfiguration("bag")]),
        IncludeLaunchDescription(
            PythonLaunchDescriptionSource(os.path.join(share, "launch", "posevote.launch.py")),
            launch_arguments={"transport": "compressed", "tf": "true",
                              **{name: LaunchConfiguration(name) for name in names}}.items())])
