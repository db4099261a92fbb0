#pragma once
#include "components/deployer/Json.hpp"
#include "components/framework/config/DeploymentSpec.hpp"
#include "components/log/Reader.hpp"

namespace insonify::deployer {

/** Returns the deployment that wrote the log, from the metadata of its first stream; empty where it is unknown or
 *  unreadable. */
framework::DeploymentSpec deploymentOf(const log::Reader& log);

/** Returns the world's origin on the earth in the deployment that wrote the log, or in the first of its tasks that has
 *  one; none: unknown. */
std::optional<types::Datum> recordedDatum(const log::Reader& log);

/** Returns what the numbers of a stream mean, by the deployment in its metadata as written there. Settings from outside
 *  are in the run's properties log.
 *
 *  Pings: {stream, bins, output, model, reference, tvg, gain_db, code, noise, frequency_khz, speed_of_sound_m_s or
 *  null, range_m, bin_duration, frame, mount: {position [m], roll_deg, pitch_deg, yaw_deg}, quaternion_order, seed};
 *  what is not configured is null. Poses: {stream, position, orientation, quaternion_order}. Truth, returns and
 *  elements of pings: {stream, a text for each field; objects: the names of the truth's objects, where known}. Points:
 *  {stream, points, intensity; datum: the world's origin, where known}. Others: {stream, type}. */
Json meaningOf(const log::Reader& log, const log::Stream& stream);

/** Returns the stream if it has at least one ping. Throws types::ConfigError for other streams, with the expectation
 *  `wanted`. */
const log::Stream& pingsOf(const log::Reader& log, const std::string& stream, const char* wanted);

/** Returns the frequency in the metadata of a stream of pings [kHz]; 0: unknown. */
double frequencyOf(const Json& meaning);

}  // namespace insonify::deployer
