#include "components/python/Samples.hpp"

#include <fmt/format.h>

#include <map>
#include <optional>
#include <stdexcept>
#include <type_traits>
#include <utility>
#include <variant>

#include "components/output/pictures/FanImage.hpp"
#include "types/samples/Image.hpp"
#include "types/samples/Pose.hpp"
#include "types/samples/Samples.hpp"

namespace insonify::python {
namespace {

using console::Json;

template <class Number>
constexpr const char* getType() {
    if constexpr (std::is_floating_point_v<Number>) return sizeof(Number) == 8 ? "f8" : "f4";
    if constexpr (sizeof(Number) == 1) return "u1";
    return std::is_signed_v<Number> ? "i4" : "u4";
}

Array makeGrid(const char* name, const auto& numbers, const auto& sample) {
    using Number = typename std::remove_cvref_t<decltype(numbers)>::value_type;
    return {name, getType<Number>(), numbers.data(), {sample.beam_count, sample.bin_count}, 2};
}

Array list(const char* name, const void* numbers, uint64_t size) { return {name, "f8", numbers, {size}, 1}; }

/** Reports numbers outside the ranges of their properties. */
struct RangeCheck {
    types::Diagnostics& diagnostics;

    template <class T>
    void operator()(const types::Field& field, const T& value) {
        if constexpr (std::is_arithmetic_v<T>) {
            if (!(value >= field.min && value <= field.max))
                diagnostics.push_back(
                    {field.name, fmt::format("is {}; may be {:g} to {:g}", value, field.min, field.max)});
        }
    }
    template <class T>
    void operator()(const types::Field& field, const std::optional<T>& value) {
        if (value) (*this)(field, *value);
    }
};

class PingHandle final : public Handle {
public:
    PingHandle(types::SonarPtr ping, types::SonarTruthPtr truth) : ping_(std::move(ping)), truth_(std::move(truth)) {
        static_assert(sizeof(types::Angle) == sizeof(double));
        for (uint32_t k = 0; k < ping_->bin_count; ++k) ranges_.push_back(ping_->binStart(k + 0.5));
    }
    Json facts() const override {
        Json facts{{"kind", "ping"},
                   {"time", ping_->time.seconds()},
                   {"speed_of_sound", ping_->speed_of_sound},
                   {"beam_width", ping_->beam_width.rad},
                   {"beam_height", ping_->beam_height.rad},
                   {"bin_length", ping_->binStart(1)}};
        if (truth_) facts["objects"] = truth_->objects;
        return facts;
    }
    std::vector<Array> arrays() const override {
        std::vector<Array> arrays{makeGrid("bins", ping_->bins, *ping_),
                                  list("bearings", ping_->bearings.data(), ping_->bearings.size()),
                                  list("ranges", ranges_.data(), ranges_.size())};
        if (truth_) addTruth(arrays, *truth_);
        return arrays;
    }
    static void addTruth(std::vector<Array>& arrays, const types::SonarTruth& truth) {
        types::SonarTruth::forEachArray(truth, [&](const char* name, const auto& numbers, auto) {
            arrays.push_back(makeGrid(name, numbers, truth));
        });
    }

    const types::Sonar& ping() const { return *ping_; }

private:
    types::SonarPtr ping_;
    types::SonarTruthPtr truth_;
    std::vector<double> ranges_;
};

/** Pings of one shape, copied into one array. */
class PingsHandle final : public Handle {
public:
    PingsHandle(const std::vector<types::SonarPtr>& pings, const std::vector<types::SonarTruthPtr>& truths)
        : first_(pings.front()), count_(pings.size()) {
        for (uint32_t k = 0; k < first_->bin_count; ++k) ranges_.push_back(first_->binStart(k + 0.5));
        bins_.reserve(count_ * first_->bins.size());
        for (const types::SonarPtr& ping : pings) {
            if (ping->bins.size() != first_->bins.size())
                throw std::runtime_error("the pings of a batch differ in beams or bins");
            times_.push_back(ping->time.seconds());
            bins_.insert(bins_.end(), ping->bins.begin(), ping->bins.end());
        }
        if (!truths.empty()) objects_ = truths.front()->objects;
        for (const types::SonarTruthPtr& truth : truths)
            types::SonarTruth::forEachArray(*truth, [&](const char* name, const auto& numbers, auto) {
                const auto* const bytes = reinterpret_cast<const char*>(numbers.data());
                std::vector<char>& all = truth_[name];
                all.insert(all.end(), bytes, bytes + numbers.size() * sizeof(numbers[0]));
            });
    }
    Json facts() const override {
        Json facts{{"kind", "pings"}, {"speed_of_sound", first_->speed_of_sound}, {"bin_length", first_->binStart(1)}};
        if (!truth_.empty()) facts["objects"] = objects_;
        return facts;
    }
    std::vector<Array> arrays() const override {
        const auto cube = [&](const char* name, const char* type, const void* numbers) {
            return Array{name, type, numbers, {count_, first_->beam_count, first_->bin_count}, 3};
        };
        std::vector<Array> arrays{cube("bins", "f4", bins_.data()), list("times", times_.data(), count_),
                                  list("bearings", first_->bearings.data(), first_->bearings.size()),
                                  list("ranges", ranges_.data(), ranges_.size())};
        const types::SonarTruth shape;
        types::SonarTruth::forEachArray(shape, [&](const char* name, const auto& numbers, auto) {
            using Number = typename std::remove_cvref_t<decltype(numbers)>::value_type;
            if (const auto found = truth_.find(name); found != truth_.end())
                arrays.push_back(cube(found->first.c_str(), getType<Number>(), found->second.data()));
        });
        return arrays;
    }

private:
    types::SonarPtr first_;
    size_t count_;
    std::vector<float> bins_;
    std::vector<double> ranges_, times_;
    std::vector<std::string> objects_;
    std::map<std::string, std::vector<char>> truth_;
};

struct TruthHandle final : Handle {
    types::SonarTruth truth;
    Json facts() const override { return {{"kind", "truth"}, {"objects", truth.objects}}; }
    std::vector<Array> arrays() const override {
        std::vector<Array> arrays;
        PingHandle::addTruth(arrays, truth);
        return arrays;
    }
};

struct PictureHandle final : Handle {
    std::vector<uint8_t> pixels;  ///< Red first.
    types::ImageSize size;
    Json facts() const override { return {{"kind", "picture"}}; }
    std::vector<Array> arrays() const override {
        return {{"pixels", "u1", pixels.data(), {size.height, size.width, 3}, 3}};
    }
};

struct PoseHandle final : Handle {
    double numbers[8];  ///< Time [s], place [m], quaternion w, x, y, z.
    Json facts() const override { return {{"kind", "pose"}}; }
    std::vector<Array> arrays() const override { return {list("numbers", numbers, std::size(numbers))}; }
};

struct NumberHandle final : Handle {
    double number = 0;
    Json facts() const override { return {{"kind", "number"}}; }
    std::vector<Array> arrays() const override { return {list("number", &number, 1)}; }
};

/** A text, or a number without a fraction. */
struct ValueHandle final : Handle {
    Json all;
    Json facts() const override { return all; }
};

std::unique_ptr<Handle> valueHandle(const char* kind, Json value) {
    auto handle = std::make_unique<ValueHandle>();
    handle->all = {{"kind", kind}, {"value", std::move(value)}};
    return handle;
}

std::unique_ptr<Handle> pictureHandle(const types::Image& picture) {
    const size_t channels = picture.pixel_size;
    if (!picture.holdsPixels() || (channels != 1 && channels != 3))
        throw std::invalid_argument("the picture is compressed, or has no bytes for pixels");
    auto handle = std::make_unique<PictureHandle>();
    handle->size = picture.size;
    handle->pixels.reserve(size_t{3} * picture.size.height * picture.size.width);
    const bool blue_first = picture.frame_mode == types::ImageMode::Bgr;
    for (size_t row = 0; row < picture.size.height; ++row)
        for (size_t column = 0; column < picture.size.width; ++column)
            for (size_t colour = 0; colour < 3; ++colour) {
                const size_t from = channels == 1 ? 0 : blue_first ? 2 - colour : colour;
                handle->pixels.push_back(picture.image[row * picture.row_size + column * channels + from]);
            }
    return handle;
}

/** Makes handles of the samples in a variant of pointers. */
struct MakeHandle {
    std::unique_ptr<Handle> operator()(const types::Pose* pose) const {
        auto handle = std::make_unique<PoseHandle>();
        const glm::dvec3& p = pose->position;
        const glm::dquat& q = pose->orientation;
        const double numbers[] = {pose->time.seconds(), p.x, p.y, p.z, q.w, q.x, q.y, q.z};
        std::copy(std::begin(numbers), std::end(numbers), handle->numbers);
        return handle;
    }
    std::unique_ptr<Handle> operator()(const types::Image* picture) const { return pictureHandle(*picture); }
    std::unique_ptr<Handle> operator()(const std::string* text) const { return valueHandle("text", *text); }
    template <class Sample>
    std::unique_ptr<Handle> operator()(const Sample* sample) const {
        if constexpr (types::Scalar<Sample>) {
            const auto number = types::getNumber(*sample);
            if constexpr (std::is_integral_v<decltype(number)>) return valueHandle("integer", number);
            auto handle = std::make_unique<NumberHandle>();
            handle->number = static_cast<double>(number);
            return handle;
        } else {
            throw UnreadableType("samples of this type are not read from Python; insonify log export writes them");
        }
    }
};

}  // namespace

std::unique_ptr<Handle> pingsHandle(const std::vector<types::SonarPtr>& pings,
                                    const std::vector<types::SonarTruthPtr>& truths) {
    return std::make_unique<PingsHandle>(pings, truths);
}

std::unique_ptr<Handle> pingHandle(types::SonarPtr ping, types::SonarTruthPtr truth) {
    return std::make_unique<PingHandle>(std::move(ping), std::move(truth));
}

std::unique_ptr<Handle> fanHandle(const Handle& ping, const output::DisplayConfig& display) {
    types::Diagnostics diagnostics;
    RangeCheck ranges{diagnostics};
    output::DisplayConfig::describe(display, ranges);
    display.check(diagnostics);
    if (!diagnostics.empty()) throw types::ConfigError(diagnostics);
    types::Image picture;
    output::FanImage(display).paint(dynamic_cast<const PingHandle&>(ping).ping(), picture);
    return pictureHandle(picture);
}

std::unique_ptr<Handle> sampleHandle(log::Reader& log, const log::SampleRef& at) {
    const log::Stream& stream = log.streams()[at.stream];
    if (log::holdsPings(stream)) {
        auto ping = std::make_shared<types::Sonar>();
        log::readPing(log, at, *ping);
        types::requireSound<types::ConfigError>(*ping, "a sample of the log", "", "");
        return pingHandle(std::move(ping), nullptr);
    }
    if (stream.holds<types::SonarTruth>()) {
        auto handle = std::make_unique<TruthHandle>();
        log.read(at, handle->truth);
        types::requireSound<types::ConfigError>(handle->truth, "a sample of the log", "", "");
        return handle;
    }
    return std::visit(MakeHandle{}, log.sampleAt(at));
}

}  // namespace insonify::python
