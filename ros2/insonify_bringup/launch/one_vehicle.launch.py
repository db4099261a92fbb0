"""Runs the sonar of one vehicle: ros2 launch insonify_bringup one_vehicle.launch.py namespace:=auv rviz:=true"""
import shutil
from pathlib import Path

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.conditions import IfCondition
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue

CONFIG = Path(__file__).resolve().parent.parent / "config"
TOPICS = ("odometry", "sonar", "sonar/scan", "sonar/image")  # topics of config/insonify.rviz, below /auv


def default_deployment():
    """Returns the example that is installed with the command `insonify`."""
    command = shutil.which("insonify")
    return str(Path(command).resolve().parent.parent / "share/insonify/deploy/ros2_fls.yml") if command else ""


def generate_launch_description():
    namespace = LaunchConfiguration("namespace")
    prefix = {"frame_prefix": ParameterValue(LaunchConfiguration("frame_prefix"), value_type=str)}
    return LaunchDescription([
        DeclareLaunchArgument("deployment", default_value=default_deployment(), description="a YAML file of Insonify"),
        DeclareLaunchArgument("namespace", default_value="auv", description="of topics and nodes"),
        DeclareLaunchArgument("frame_prefix", default_value="", description="before all frames but the world's"),
        DeclareLaunchArgument("clock", default_value="/clock", description="topic of the time of the poses"),
        DeclareLaunchArgument("parameters", default_value=str(CONFIG / "parameters.yaml"), description="a YAML file"),
        DeclareLaunchArgument("rviz", default_value="false", description="whether RViz runs as well"),
        Node(
            executable="insonify",
            arguments=["run", LaunchConfiguration("deployment")],
            namespace=namespace,
            remappings=[("/clock", LaunchConfiguration("clock"))],
            parameters=[LaunchConfiguration("parameters"), prefix],
            output="screen",
        ),
        Node(
            package="rviz2",
            executable="rviz2",
            arguments=["-d", str(CONFIG / "insonify.rviz")],
            namespace=namespace,
            remappings=[(f"/auv/{topic}", topic) for topic in TOPICS],
            condition=IfCondition(LaunchConfiguration("rviz")),
        ),
    ])
