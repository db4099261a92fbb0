"""Plays a log to the topics of a deployment: ros2 launch insonify_bringup replay.launch.py log:=L deployment:=D"""
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    return LaunchDescription([
        DeclareLaunchArgument("log", description="a log of Insonify, pocolog or MCAP"),
        DeclareLaunchArgument("deployment", description="a YAML file whose tasks the streams of the log replace"),
        DeclareLaunchArgument("namespace", default_value="auv", description="of topics and nodes"),
        DeclareLaunchArgument("pace", default_value="1", description="seconds of the log per second"),
        Node(
            executable="insonify",
            arguments=["replay", LaunchConfiguration("log"), LaunchConfiguration("deployment"), "--outside",
                       "--pace", LaunchConfiguration("pace")],
            namespace=LaunchConfiguration("namespace"),
            output="screen",
        ),
    ])
