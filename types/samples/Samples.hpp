#pragma once
// The list of all types of samples that are passed on ports, logged, exported, replayed, sent and shown. A new type
// needs a line in SampleTypes; components/log/README.md has the recipe.
#include <algorithm>
#include <array>
#include <concepts>
#include <memory>
#include <stdexcept>
#include <string>
#include <tuple>
#include <type_traits>
#include <variant>

#include "types/geometry/Angle.hpp"
#include "types/samples/DepthMap.hpp"
#include "types/samples/Dvl.hpp"
#include "types/samples/Fix.hpp"
#include "types/samples/Image.hpp"
#include "types/samples/Imu.hpp"
#include "types/samples/PointCloud.hpp"
#include "types/samples/Pose.hpp"
#include "types/samples/Pressure.hpp"
#include "types/samples/Range.hpp"
#include "types/samples/Sonar.hpp"
#include "types/samples/SonarDetections.hpp"
#include "types/samples/SonarElements.hpp"
#include "types/samples/SonarReturns.hpp"
#include "types/samples/SonarScan.hpp"
#include "types/samples/SonarSettings.hpp"
#include "types/samples/SonarTruth.hpp"

namespace insonify::types {

using SampleTypes = std::tuple<Sonar, SonarBeam, SonarScan, SonarTruth, SonarReturns, SonarElements, SonarDetections,
                               SonarSettings, Pose, Image, PointCloud, DepthMap, Range, ImuSensors, Imu, Dvl, Pressure,
                               Fix, Time, Angle, double, float, int32_t, int64_t, bool, std::string>;

/** The type that a port passes for a T: a shared pointer for samples with `shared`, otherwise T itself. */
template <class T>
concept Shared = requires {
    requires T::shared;
};
template <class T>
using Carried = std::conditional_t<Shared<T>, std::shared_ptr<const T>, T>;

/** Returns the sample of a Carried; null when there is none. */
template <class T>
const T* carriedSample(const T& sample) {
    return &sample;
}
template <class T>
const T* carriedSample(const std::shared_ptr<const T>& sample) {
    return sample.get();
}

template <class Types>
struct Variants;
template <class... T>
struct Variants<std::tuple<T...>> {
    using Carried = std::variant<types::Carried<T>...>;
    using View = std::variant<const T*...>;
    using Room = std::variant<T*...>;
};
/** Any sample: as a port passes it, to read, to fill. The alternatives have the order of SampleTypes. */
using AnySample = Variants<SampleTypes>::Carried;
using SampleView = Variants<SampleTypes>::View;
using SampleRoom = Variants<SampleTypes>::Room;

/** Returns the index of T in SampleTypes. */
template <class T>
constexpr size_t sampleIndex() {
    return SampleView(std::in_place_type<const T*>, nullptr).index();
}

/** Calls `use(std::type_identity<T>{})` for each type of the list. */
void forEachSampleType(auto&& use) {
    [&]<class... T>(std::type_identity<std::tuple<T...>>) {
        (use(std::type_identity<T>{}), ...);
    }(std::type_identity<SampleTypes>{});
}

/** A sample of one number: numbers, truth values, times [s] and angles [rad]. */
template <class T>
concept Scalar = std::is_arithmetic_v<T> || std::is_same_v<T, Time> || std::is_same_v<T, Angle>;

/** Returns the number of a sample, a truth value as 0 or 1. */
template <Scalar T>
auto getNumber(const T& value) {
    if constexpr (std::is_same_v<T, Time>)
        return value.seconds();
    else if constexpr (std::is_same_v<T, Angle>)
        return value.rad;
    else if constexpr (std::is_same_v<T, bool>)
        return static_cast<uint8_t>(value);
    else
        return value;
}

template <class T>
concept Stamped = requires(const T& sample) {
    { sample.time } -> std::convertible_to<Time>;
};

/** Returns the time at which the sample was true in the world; `otherwise` without a stamp or with a null stamp. */
template <class T>
Time sampleTime(const T& sample, Time otherwise) {
    if constexpr (Stamped<T>)
        return sample.time.isNull() ? otherwise : sample.time;
    else
        return otherwise;
}

/** Shifts the stamps of a sample that are not null: `time`, and the stamps from its `forEachStamp`. */
template <class T>
void moveStamps(T& sample, Time shift) {
    const auto move = [shift](Time& time) {
        if (!time.isNull()) time = time + shift;
    };
    if constexpr (Stamped<T>) move(sample.time);
    if constexpr (requires { sample.forEachStamp(move); }) sample.forEachStamp(move);
}

/** The columns of a T in tables, in addition to its time: specialise with `forEach(sample, visit)`, which calls
 *  `visit(array, columns, numbers)` for each array. */
template <class T>
struct Columns;
template <>
struct Columns<Pose> {
    template <class Visit>
    static void forEach(const Pose& pose, Visit&& visit) {
        const auto& [p, q] = std::tie(pose.position, pose.orientation);
        visit("position", std::array{"x", "y", "z"}, std::array{p.x, p.y, p.z});
        visit("orientation", std::array{"qw", "qx", "qy", "qz"}, std::array{q.w, q.x, q.y, q.z});
    }
};
template <>
struct Columns<Range> {
    template <class Visit>
    static void forEach(const Range& sample, Visit&& visit) {
        visit("range", std::array{"range"}, std::array{sample.range});
    }
};
template <>
struct Columns<SonarSettings> {
    template <class Visit>
    static void forEach(const SonarSettings& sample, Visit&& visit) {
        visit("range", std::array{"range"}, std::array{sample.range});
        visit("frequency_khz", std::array{"frequency_khz"}, std::array{sample.frequency_khz});
        visit("speed_of_sound", std::array{"speed_of_sound"}, std::array{sample.speed_of_sound});
        visit("gain_db", std::array{"gain_db"}, std::array{sample.gain_db});
        visit("bearing", std::array{"bearing"}, std::array{sample.bearing.rad});
        visit("field_of_view", std::array{"field_of_view"}, std::array{sample.field_of_view.rad});
        visit("beam_height", std::array{"beam_height"}, std::array{sample.beam_height.rad});
        visit("counts", std::array{"bin_count", "beam_count"}, std::array{sample.bin_count, sample.beam_count});
    }
};
template <>
struct Columns<ImuSensors> {
    template <class Visit>
    static void forEach(const ImuSensors& sample, Visit&& visit) {
        const auto& [a, g, m] = std::tie(sample.acc, sample.gyro, sample.mag);
        visit("acc", std::array{"acc_x", "acc_y", "acc_z"}, std::array{a.x, a.y, a.z});
        visit("gyro", std::array{"gyro_x", "gyro_y", "gyro_z"}, std::array{g.x, g.y, g.z});
        visit("mag", std::array{"mag_x", "mag_y", "mag_z"}, std::array{m.x, m.y, m.z});
    }
};
template <>
struct Columns<Imu> {
    template <class Visit>
    static void forEach(const Imu& sample, Visit&& visit) {
        const auto& [q, w, a] = std::tie(sample.orientation, sample.angular_velocity, sample.linear_acceleration);
        visit("orientation", std::array{"qw", "qx", "qy", "qz"}, std::array{q.w, q.x, q.y, q.z});
        visit("angular_velocity", std::array{"wx", "wy", "wz"}, std::array{w.x, w.y, w.z});
        visit("linear_acceleration", std::array{"ax", "ay", "az"}, std::array{a.x, a.y, a.z});
    }
};
template <>
struct Columns<Dvl> {
    /** Returns a list of up to four numbers as four numbers, unknown beyond its end. */
    static std::array<double, Dvl::max_beams> four(const std::vector<double>& list) {
        std::array<double, Dvl::max_beams> all;
        all.fill(Pose::unknown);
        std::copy_n(list.begin(), std::min(list.size(), all.size()), all.begin());
        return all;
    }
    template <class Visit>
    static void forEach(const Dvl& sample, Visit&& visit) {
        const auto& v = sample.velocity;
        visit("velocity", std::array{"vx", "vy", "vz"}, std::array{v.x, v.y, v.z});
        visit("altitude", std::array{"altitude"}, std::array{sample.altitude});
        visit("speed_of_sound", std::array{"speed_of_sound"}, std::array{sample.speed_of_sound});
        visit("beam_ranges", std::array{"range_1", "range_2", "range_3", "range_4"}, four(sample.beam_ranges));
        visit("beam_velocities", std::array{"velocity_1", "velocity_2", "velocity_3", "velocity_4"},
              four(sample.beam_velocities));
    }
};
template <>
struct Columns<Pressure> {
    template <class Visit>
    static void forEach(const Pressure& sample, Visit&& visit) {
        visit("pascal", std::array{"pascal"}, std::array{sample.pascal});
    }
};
template <>
struct Columns<Fix> {
    template <class Visit>
    static void forEach(const Fix& sample, Visit&& visit) {
        visit("position", std::array{"latitude", "longitude", "altitude"},
              std::array{sample.latitude, sample.longitude, sample.altitude});
        visit("deviation", std::array{"deviation_latitude", "deviation_longitude", "deviation_altitude"},
              std::array{sample.deviation_latitude, sample.deviation_longitude, sample.deviation_altitude});
        visit("kind", std::array{"kind"}, std::array{static_cast<int32_t>(sample.kind)});
    }
};
struct AnyColumns {
    void operator()(const char*, const auto&, const auto&) const {}
};
template <class T>
concept Tabular = requires(const T& sample) {
    Columns<T>::forEach(sample, AnyColumns{});
};

/** A sample of arrays of one shape. It has `shape()`, and `forEachArray`, which calls `visit(name, numbers,
 *  std::type_identity<Number>{})` for each array; Number is the type of its numbers in files. */
struct AnyArray {
    void operator()(const char*, const auto&, auto) const {}
};
template <class T>
concept Arrayed = requires(const T& sample) {
    sample.shape();
    T::forEachArray(sample, AnyArray{});
};

/** A sample that refers to objects by number. The metadata of its stream contain their names as well. */
template <class T>
concept NamesObjects = requires(const T& sample) {
    { sample.objects } -> std::convertible_to<const std::vector<std::string>&>;
};

/** Returns the contradiction in a sample, as the rest of a sentence after "a sample"; null when there is none. Types
 *  report it by `diagnostic()`. */
template <class T>
const char* findDiagnostic(const T& sample) {
    if constexpr (requires { sample.diagnostic(); })
        return sample.diagnostic();
    else
        return nullptr;
}

/** Throws an Error such as "<what> has other numbers of bins than it says" for a sample that contradicts itself.
 *  `where` are the arguments of the Error before its text. */
template <class Error = std::invalid_argument, class Sample, class... Where>
void requireSound(const Sample& sample, const std::string& what, const Where&... where) {
    if (const char* const diagnostic = findDiagnostic(sample)) throw Error(where..., what + " " + diagnostic);
}

}  // namespace insonify::types
