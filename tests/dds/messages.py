"""Messages of ROS 2 for PyPI's cyclonedds, defined independently of the C++ definitions."""
import types
import typing
from dataclasses import dataclass, field

from cyclonedds.idl import IdlStruct
from cyclonedds.idl.types import array, float32, float64, int8, int32, int64, sequence, uint8, uint16, uint32, uint64


def zero(kind):
    """Returns the factory of a field's default: 0, "", an empty list, or a message or an array of these."""
    made_of = next((each for each in getattr(kind, "__metadata__", ()) if isinstance(each, (array, sequence))), None)
    if isinstance(made_of, array):
        return lambda: [zero(made_of.subtype)() for _ in range(made_of.length)]
    return list if made_of else typing.get_args(kind)[0] if hasattr(kind, "__metadata__") else kind


def message(package, name, /, **fields):
    """Returns the type of a message, with the types of its fields; a tuple is a type and its default."""
    fields = {key: kind if isinstance(kind, tuple) else (kind, field(default_factory=zero(kind)))
              for key, kind in fields.items()}
    names = {"__module__": __name__, "__annotations__": {key: kind for key, (kind, _) in fields.items()},
             **{key: default for key, (_, default) in fields.items()}}
    return dataclass(types.new_class(name, (IdlStruct,), {"typename": f"{package}::msg::dds_::{name}_"},
                                     lambda namespace: namespace.update(names)))


Time = message("builtin_interfaces", "Time", sec=int32, nanosec=uint32)
Header = message("std_msgs", "Header", stamp=Time, frame_id=str)
Clock = message("rosgraph_msgs", "Clock", clock=Time)
Vector3 = message("geometry_msgs", "Vector3", x=float64, y=float64, z=float64)
Point = message("geometry_msgs", "Point", x=float64, y=float64, z=float64)
Quaternion = message("geometry_msgs", "Quaternion", x=float64, y=float64, z=float64, w=(float64, 1.0))
Pose = message("geometry_msgs", "Pose", position=Point, orientation=Quaternion)
PoseStamped = message("geometry_msgs", "PoseStamped", header=Header, pose=Pose)
PoseWithCovariance = message("geometry_msgs", "PoseWithCovariance", pose=Pose, covariance=array[float64, 36])
Twist = message("geometry_msgs", "Twist", linear=Vector3, angular=Vector3)
TwistWithCovariance = message("geometry_msgs", "TwistWithCovariance", twist=Twist, covariance=array[float64, 36])
Odometry = message(
    "nav_msgs", "Odometry", header=Header, child_frame_id=str, pose=PoseWithCovariance, twist=TwistWithCovariance)
Transform = message("geometry_msgs", "Transform", translation=Vector3, rotation=Quaternion)
TransformStamped = message("geometry_msgs", "TransformStamped", header=Header, child_frame_id=str, transform=Transform)
TFMessage = message("tf2_msgs", "TFMessage", transforms=sequence[TransformStamped])
Image = message(
    "sensor_msgs", "Image", header=Header, height=uint32, width=uint32, encoding=str, is_bigendian=uint8, step=uint32,
    data=sequence[uint8])
LaserScan = message(
    "sensor_msgs", "LaserScan", header=Header, angle_min=float32, angle_max=float32, angle_increment=float32,
    time_increment=float32, scan_time=float32, range_min=float32, range_max=float32, ranges=sequence[float32],
    intensities=sequence[float32])
PointField = message("sensor_msgs", "PointField", name=str, offset=uint32, datatype=uint8, count=uint32)
PointCloud2 = message(
    "sensor_msgs", "PointCloud2", header=Header, height=uint32, width=uint32, fields=sequence[PointField],
    is_bigendian=bool, point_step=uint32, row_step=uint32, data=sequence[uint8], is_dense=bool)
Range = message(
    "sensor_msgs", "Range", header=Header, radiation_type=uint8, field_of_view=float32, min_range=float32,
    max_range=float32, range=float32, variance=float32)
Imu = message(
    "sensor_msgs", "Imu", header=Header, orientation=Quaternion, orientation_covariance=array[float64, 9],
    angular_velocity=Vector3, angular_velocity_covariance=array[float64, 9], linear_acceleration=Vector3,
    linear_acceleration_covariance=array[float64, 9])
NavSatStatus = message("sensor_msgs", "NavSatStatus", status=int8, service=uint16)
NavSatFix = message(
    "sensor_msgs", "NavSatFix", header=Header, status=NavSatStatus, latitude=float64, longitude=float64,
    altitude=float64, position_covariance=array[float64, 9], position_covariance_type=uint8)
FluidPressure = message("sensor_msgs", "FluidPressure", header=Header, fluid_pressure=float64, variance=float64)
Dvl = message(
    "marine_acoustic_msgs", "Dvl", header=Header, velocity_mode=uint8, dvl_type=uint8, velocity=Vector3,
    velocity_covar=array[float64, 9], altitude=float64, course_gnd=float64, speed_gnd=float64, num_good_beams=uint8,
    sound_speed=float32, beam_ranges_valid=bool, beam_velocities_valid=bool, beam_unit_vec=array[Vector3, 4],
    range=array[float64, 4], range_covar=array[float32, 4], beam_quality=array[float32, 4],
    beam_velocity=array[float32, 4], beam_velocity_covar=array[float32, 4])
PingInfo = message(
    "marine_acoustic_msgs", "PingInfo", frequency=float32, sound_speed=float32, tx_beamwidths=sequence[float32],
    rx_beamwidths=sequence[float32])
SonarImageData = message(
    "marine_acoustic_msgs", "SonarImageData", is_bigendian=bool, dtype=uint32, beam_count=uint32, data=sequence[uint8])
ProjectedSonarImage = message(
    "marine_acoustic_msgs", "ProjectedSonarImage", header=Header, ping_info=PingInfo, beam_directions=sequence[Vector3],
    ranges=sequence[float32], image=SonarImageData)
RawSonarImage = message(
    "marine_acoustic_msgs", "RawSonarImage", header=Header, ping_info=PingInfo, sample_rate=float32,
    samples_per_beam=uint32, sample0=uint32, tx_delays=sequence[float32], tx_angles=sequence[float32],
    rx_angles=sequence[float32], image=SonarImageData)
DetectionFlag = message("marine_acoustic_msgs", "DetectionFlag", flag=uint8)
SonarRanges = message(
    "marine_acoustic_msgs", "SonarRanges", header=Header, ping_info=PingInfo, flags=sequence[DetectionFlag],
    transmit_delays=sequence[float32], intensities=sequence[float32], beam_unit_vec=sequence[Vector3],
    ranges=sequence[float32])
SonarDetections = message(
    "marine_acoustic_msgs", "SonarDetections", header=Header, ping_info=PingInfo, flags=sequence[DetectionFlag],
    two_way_travel_times=sequence[float32], tx_delays=sequence[float32], intensities=sequence[float32],
    tx_angles=sequence[float32], rx_angles=sequence[float32])
Gid = message("rmw_dds_common", "Gid", data=array[uint8, 16])
NodeEntitiesInfo = message(
    "rmw_dds_common", "NodeEntitiesInfo", node_namespace=str, node_name=str, reader_gid_seq=sequence[Gid],
    writer_gid_seq=sequence[Gid])
ParticipantEntitiesInfo = message(
    "rmw_dds_common", "ParticipantEntitiesInfo", gid=Gid, node_entities_info_seq=sequence[NodeEntitiesInfo])
ParameterValue = message(
    "rcl_interfaces", "ParameterValue", type=uint8, bool_value=bool, integer_value=int64, double_value=float64,
    string_value=str, byte_array_value=sequence[uint8], bool_array_value=sequence[bool],
    integer_array_value=sequence[int64], double_array_value=sequence[float64], string_array_value=sequence[str])
Parameter = message("rcl_interfaces", "Parameter", name=str, value=ParameterValue)
SetParametersResult = message("rcl_interfaces", "SetParametersResult", successful=bool, reason=str)
FloatingPointRange = message("rcl_interfaces", "FloatingPointRange", from_value=float64, to_value=float64, step=float64)
IntegerRange = message("rcl_interfaces", "IntegerRange", from_value=int64, to_value=int64, step=uint64)
ParameterEvent = message(
    "rcl_interfaces", "ParameterEvent", stamp=Time, node=str, new_parameters=sequence[Parameter],
    changed_parameters=sequence[Parameter], deleted_parameters=sequence[Parameter])
Log = message(
    "rcl_interfaces", "Log", stamp=Time, level=uint8, name=str, msg=str, file=str, function=str, line=uint32)
State = message("lifecycle_msgs", "State", id=uint8, label=str)
Transition = message("lifecycle_msgs", "Transition", id=uint8, label=str)
TransitionDescription = message(
    "lifecycle_msgs", "TransitionDescription", transition=Transition, start_state=State, goal_state=State)
TransitionEvent = message(
    "lifecycle_msgs", "TransitionEvent", timestamp=uint64, transition=Transition, start_state=State, goal_state=State)
KeyValue = message("diagnostic_msgs", "KeyValue", key=str, value=str)
DiagnosticStatus = message(
    "diagnostic_msgs", "DiagnosticStatus", level=uint8, name=str, message=str, hardware_id=str,
    values=sequence[KeyValue])
DiagnosticArray = message("diagnostic_msgs", "DiagnosticArray", header=Header, status=sequence[DiagnosticStatus])
ParameterDescriptor = message(
    "rcl_interfaces", "ParameterDescriptor", name=str, type=uint8, description=str, additional_constraints=str,
    read_only=bool, dynamic_typing=bool, floating_point_range=sequence[FloatingPointRange],
    integer_range=sequence[IntegerRange])
