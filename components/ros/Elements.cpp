#include "components/ros/Elements.hpp"

#include <stdexcept>

#include "components/ros/Times.hpp"

namespace insonify::ros {
namespace {

/** What has the same names on both sides. */
template <class From, class To>
void copySignals(const From& from, To& to) {
    to.wavelength = from.wavelength;
    to.first_range = from.first_range;
    to.sample_spacing = from.sample_spacing;
    to.sample_count = from.sample_count;
    to.positions = from.positions;
    to.weights = from.weights;
    to.in_phase = from.in_phase;
    to.quadrature = from.quadrature;
}

void requireSound(const types::SonarElements& signals) {
    if (const char* diagnostic = signals.diagnostic()) throw std::invalid_argument(std::string("it ") + diagnostic);
}

}  // namespace

void convert(const types::SonarElements& signals, const std::string& frame_id, SonarElements& message) {
    requireSound(signals);
    message.header = {toRos(signals.time), frame_id};
    message.sound_speed = signals.speed_of_sound;
    copySignals(signals, message);
}

void convert(const SonarElements& message, types::SonarElements& signals) {
    signals.time = fromRos(message.header.stamp);
    signals.speed_of_sound = message.sound_speed;
    copySignals(message, signals);
    requireSound(signals);
}

}  // namespace insonify::ros
