#pragma once
#include "components/deployer/Json.hpp"
#include "components/log/Reader.hpp"

namespace insonify::deployer {

/** What the numbers of a stream mean, from the deployment that its metadata holds, as written there: settings from
 *  outside stand in the run's properties log.
 *
 *  Pings: {stream, bins, output, model, reference, tvg, gain_db, code, noise, frequency_khz, speed_of_sound_m_s or
 *  null, range_m, bin_duration, frame, mount: {position [m], roll_deg, pitch_deg, yaw_deg}, quaternion_order, seed};
 *  what is not configured is null. Poses: {stream, position, orientation, quaternion_order}. Truth, returns and
 *  elements of pings: {stream, a text for each field; objects: the names of the truth's objects, where they are known}.
 *  Points: {stream, points, intensity}. Others: {stream, type}. */
Json meaningOf(const log::Reader& log, const log::Stream& stream);

/** A stream that holds a ping at least. Throws types::ConfigError for any other, with what is `wanted` of it. */
const log::Stream& pingsOf(const log::Reader& log, const std::string& stream, const char* wanted);

/** The frequency in the meaning of a stream of pings [kHz]; 0 where it is not known. */
double frequencyOf(const Json& meaning);

}  // namespace insonify::deployer
