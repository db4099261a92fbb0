#pragma once
// A small sonar in the harbour, whose pings data sets are made of.
#include <string>

#include "tests/support/Paths.hpp"

namespace insonify::dataset {

inline const std::string deployment = R"(schedule: lockstep
tasks:
  vehicle:
    type: pose::TrajectoryTask
    activity: {period: 0.1}
    properties: {waypoints: [{time: 0, position: [0, 0, -5.5]}]}
  scene:
    type: scene::SceneTask
    properties:
      file: )" + test::sourceFile("deploy/scenes/harbour.glb") +
                                      R"(
      mount: {position: [0.4, 0, -0.2], roll_deg: 0, pitch_deg: 12, yaw_deg: 0}
  sonar:
    type: sonar::SonarTask
    properties:
      range: 30
      beam_count: 128
      bin_count: 200
      field_of_view_deg: 120
      beam_height_deg: 20
      quality: {rows: 128, columns_per_beam: 1}
  noise: {type: noise::NoiseTask, properties: {speckle: {law: rayleigh}}}
  receiver: {type: receiver::ReceiverTask, properties: {tvg: {log_coefficient: 40}}}
connections:
  - {from: vehicle.pose, to: scene.pose}
  - {from: scene.snapshot, to: sonar.snapshot}
  - {from: sonar.ping, to: noise.clean}
  - {from: noise.noisy, to: receiver.intensity}
)";

}  // namespace insonify::dataset
