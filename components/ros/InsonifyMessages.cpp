#include "components/ros/InsonifyMessages.hpp"

#include <string_view>

#include "components/ros/Stamps.hpp"
#include "types/Check.hpp"
#include "types/samples/Samples.hpp"

namespace insonify::ros {
namespace {

template <class T>
void assign(const T& from, T& to) {
    to = from;
}
void assign(types::Angle from, double& to) { to = from.rad; }
void assign(double from, types::Angle& to) { to = {from}; }
template <class From, class To>
requires(!std::is_same_v<From, To> && requires(const From& from, To& to) {
    assign(from, to);
}) void assign(const std::vector<From>& from, std::vector<To>& to) {
    to.resize(from.size());
    for (size_t i = 0; i < from.size(); ++i) assign(from[i], to[i]);
}

/** Copies every field that both sides describe by the same name. */
template <class From, class To>
void copyFieldsByName(const From& from, To& to) {
    auto take = [&](const types::Field& wanted, auto& target) {
        auto give = [&](const types::Field& given, const auto& value) {
            if (std::string_view(given.name) != wanted.name) return;
            if constexpr (requires { assign(value, target); })
                assign(value, target);
            else
                INSONIFY_CHECK(false && "fields of the same name have types that match", wanted.name);
        };
        From::describe(from, give);
    };
    To::describe(to, take);
}

void fill(const auto& sample, const std::string& frame_id, auto& message) {
    types::requireSound(sample, "it");
    message.header = {toRos(sample.time), frame_id};
    copyFieldsByName(sample, message);
}

template <class Message, class Sample>
void read(const Message& message, Sample& sample) {
    sample.time = fromRos(message.header.stamp);
    copyFieldsByName(message, sample);
}

}  // namespace

void convert(const types::SonarTruth& truth, const std::string& frame_id, SonarTruth& message) {
    fill(truth, frame_id, message);
    message.bin_duration_us = truth.bin_duration.microseconds;
    message.sound_speed = truth.writtenSpeed();
}

void convert(const types::SonarReturns& returns, const std::string& frame_id, SonarReturns& message) {
    fill(returns, frame_id, message);
}

void convert(const types::SonarElements& signals, const std::string& frame_id, SonarElements& message) {
    fill(signals, frame_id, message);
    message.sound_speed = signals.speed_of_sound;
}

void convert(const types::SonarSettings& settings, const std::string& frame_id, SonarSettings& message) {
    fill(settings, frame_id, message);
}

void convert(const SonarTruth& message, types::SonarTruth& truth) {
    read(message, truth);
    truth.bin_duration = {message.bin_duration_us};
    truth.speed_of_sound = message.sound_speed;
    truth.beam_count = static_cast<uint32_t>(message.bearings.size());
    types::requireSound(truth, "it");
}

void convert(const SonarReturns& message, types::SonarReturns& returns) {
    read(message, returns);
    types::requireSound(returns, "it");
}

void convert(const SonarElements& message, types::SonarElements& signals) {
    read(message, signals);
    signals.speed_of_sound = message.sound_speed;
    types::requireSound(signals, "it");
}

void convert(const SonarSettings& message, types::SonarSettings& settings) { read(message, settings); }

}  // namespace insonify::ros
