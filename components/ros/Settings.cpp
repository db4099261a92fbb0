#include "components/ros/Settings.hpp"

#include "components/ros/Times.hpp"

namespace insonify::ros {
namespace {

/** What has the same names on both sides. */
template <class From, class To>
void copyNumbers(const From& from, To& to) {
    to.range = from.range;
    to.frequency_khz = from.frequency_khz;
    to.speed_of_sound = from.speed_of_sound;
    to.gain_db = from.gain_db;
    to.bin_count = from.bin_count;
    to.beam_count = from.beam_count;
}

}  // namespace

void convert(const types::SonarSettings& settings, const std::string& frame_id, SonarSettings& message) {
    copyNumbers(settings, message);
    message.header = {toRos(settings.time), frame_id};
    message.bearing = settings.bearing.rad;
    message.field_of_view = settings.field_of_view.rad;
    message.beam_height = settings.beam_height.rad;
}

void convert(const SonarSettings& message, types::SonarSettings& settings) {
    copyNumbers(message, settings);
    settings.time = fromRos(message.header.stamp);
    settings.bearing = {message.bearing};
    settings.field_of_view = {message.field_of_view};
    settings.beam_height = {message.beam_height};
}

}  // namespace insonify::ros
