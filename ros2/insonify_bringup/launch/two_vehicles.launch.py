"""Runs the sonars of /auv1 and /auv2: ros2 launch insonify_bringup two_vehicles.launch.py"""
from pathlib import Path

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import LaunchConfiguration

ONE = Path(__file__).resolve().parent / "one_vehicle.launch.py"


def vehicle(name, clock):
    # A relative name of the clock is in the vehicle's namespace: only one node may publish the time on /clock.
    arguments = {"namespace": name, "frame_prefix": name, "clock": clock, "deployment": LaunchConfiguration(name)}
    return IncludeLaunchDescription(PythonLaunchDescriptionSource(str(ONE)), launch_arguments=arguments.items())


def generate_launch_description():
    return LaunchDescription([
        DeclareLaunchArgument("auv1", description="deployment of the first vehicle, a YAML file of Insonify"),
        DeclareLaunchArgument("auv2", default_value=LaunchConfiguration("auv1"), description="of the second"),
        vehicle("auv1", "/clock"),
        vehicle("auv2", "clock"),
    ])
