#include "components/ros/Truths.hpp"

#include <stdexcept>
#include <vector>

#include "components/ros/Times.hpp"

namespace insonify::ros {
namespace {

void copyBearings(const std::vector<types::Angle>& from, std::vector<double>& to) {
    to.clear();
    for (const types::Angle& bearing : from) to.push_back(bearing.rad);
}

void copyBearings(const std::vector<double>& from, std::vector<types::Angle>& to) {
    to.clear();
    for (const double bearing : from) to.push_back({bearing});
}

/** The lists that have the same names on both sides. */
template <class From, class To>
void copyReturns(const From& from, To& to) {
    copyBearings(from.bearings, to.bearings);
    to.first_range = from.first_range;
    to.first_level = from.first_level;
    to.first_elevation = from.first_elevation;
    to.strongest_range = from.strongest_range;
    to.strongest_level = from.strongest_level;
    to.strongest_elevation = from.strongest_elevation;
}

template <class From, class To>
void copyTruth(const From& from, To& to) {
    copyBearings(from.bearings, to.bearings);
    to.bin_count = from.bin_count;
    to.objects = from.objects;
    to.elevation = from.elevation;
    to.object = from.object;
    to.share = from.share;
    to.hits = from.hits;
    to.grazing = from.grazing;
    to.path = from.path;
    to.shadow = from.shadow;
}

template <class Sample>
void requireSound(const Sample& sample) {
    if (const char* diagnostic = sample.diagnostic()) throw std::invalid_argument(std::string("it ") + diagnostic);
}

}  // namespace

void convert(const types::SonarTruth& truth, const std::string& frame_id, SonarTruth& message) {
    requireSound(truth);
    message.header = {toRos(truth.time), frame_id};
    message.bin_duration_us = truth.bin_duration.microseconds;
    message.sound_speed = truth.speed_of_sound;
    copyTruth(truth, message);
}

void convert(const types::SonarReturns& returns, const std::string& frame_id, SonarReturns& message) {
    requireSound(returns);
    message.header = {toRos(returns.time), frame_id};
    copyReturns(returns, message);
}

void convert(const SonarTruth& message, types::SonarTruth& truth) {
    truth.time = fromRos(message.header.stamp);
    truth.bin_duration = {message.bin_duration_us};
    truth.speed_of_sound = message.sound_speed;
    truth.beam_count = static_cast<uint32_t>(message.bearings.size());
    copyTruth(message, truth);
    requireSound(truth);
}

void convert(const SonarReturns& message, types::SonarReturns& returns) {
    returns.time = fromRos(message.header.stamp);
    copyReturns(message, returns);
    requireSound(returns);
}

}  // namespace insonify::ros
