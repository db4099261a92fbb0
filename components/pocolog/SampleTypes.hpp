#pragma once
// Every type that a log can hold, in one place: the logger, the replay and the exports read this list.
#include <concepts>
#include <memory>
#include <tuple>

#include "components/pocolog/Typelib.hpp"
#include "types/Angle.hpp"
#include "types/Image.hpp"
#include "types/Pose.hpp"
#include "types/Sonar.hpp"
#include "types/SonarScan.hpp"

namespace insonify::pocolog {

using SampleTypes = std::tuple<types::Sonar, types::SonarBeam, types::SonarScan, types::Pose, types::Image, types::Time,
                               types::Angle, double, float, int32_t, int64_t, bool, std::string>;

template <class T, class... Listed>
concept OneOf = (std::is_same_v<T, Listed> || ...);

/** What travels on a port for a logged T: large samples by reference. */
template <class T>
using Carried = std::conditional_t<OneOf<T, types::Sonar, types::SonarBeam, types::SonarScan, types::Image>,
                                   std::shared_ptr<const T>, T>;

/** The sample itself, whichever way it travels. */
template <class T>
const T& carriedSample(const T& sample) {
    return sample;
}
template <class T>
const T& carriedSample(const std::shared_ptr<const T>& sample) {
    return *sample;
}

/** Calls `use(std::type_identity<T>{})` for each type of the list. */
template <class Use>
void forEachSampleType(Use&& use) {
    [&]<class... T>(std::type_identity<std::tuple<T...>>) {
        (use(std::type_identity<T>{}), ...);
    }(std::type_identity<SampleTypes>{});
}

/** A sample of one number: numbers, truth values, times [s] and angles [rad]. */
template <class T>
concept Scalar = Numeric<T> || OneOf<T, types::Time, types::Angle>;

/** Its number, a truth value as 0 or 1. */
template <Scalar T>
auto numberOf(const T& value) {
    if constexpr (std::is_same_v<T, types::Time>)
        return value.seconds();
    else if constexpr (std::is_same_v<T, types::Angle>)
        return value.rad;
    else if constexpr (std::is_same_v<T, bool>)
        return static_cast<uint8_t>(value);
    else
        return value;
}

template <class T>
concept Stamped = requires(const T& sample) {
    { sample.time } -> std::convertible_to<types::Time>;
};

/** When the sample was true in the world; `otherwise` for one without a stamp or with a null one. */
template <class T>
types::Time sampleTime(const T& sample, types::Time otherwise) {
    if constexpr (Stamped<T>)
        return sample.time.isNull() ? otherwise : sample.time;
    else
        return otherwise;
}

}  // namespace insonify::pocolog
