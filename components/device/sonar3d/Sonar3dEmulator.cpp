#include "components/device/sonar3d/Sonar3dEmulator.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <utility>

#include "components/console/Json.hpp"
#include "types/geometry/Angle.hpp"

namespace insonify::device {

using Json = nlohmann::json;

namespace {

constexpr double millimetre = 1e-3;  // unit of a pixel, within the limit of 16 bits
constexpr double strongest_pixel = 255;
constexpr double slowest = 1000, fastest = 2000;  // [m/s]
constexpr const char* prefix = "/api/v1/integration/";

/** A request that the device refuses, and why. */
struct Refused {
    int status;
    std::string why;
};

Refused bad(std::string why) { return {400, std::move(why)}; }

double numberIn(const Json& json, const char* what) {
    if (!json.is_number() || !std::isfinite(json.get<double>())) throw bad(fmt::format("{} must be a number", what));
    return json.get<double>();
}

const Json& member(const Json& json, const char* name) {
    if (!json.is_object() || !json.contains(name)) throw bad(fmt::format("the body must be an object with {}", name));
    return json[name];
}

std::string textIn(const Json& json, const char* what) {
    if (!json.is_string()) throw bad(fmt::format("{} must be a string", what));
    return json.get<std::string>();
}

bool truthIn(const Json& json) {
    if (!json.is_boolean()) throw bad("the body must be true or false");
    return json.get<bool>();
}

/** Returns whether a text is the first of two; throws unless it is one of them. */
bool isFirst(const Json& json, const char* first, const char* second) {
    const std::string text = textIn(json, "the body");
    if (text != first && text != second)
        throw bad(fmt::format("\"{}\" is neither \"{}\" nor \"{}\"", text, first, second));
    return text == first;
}

bool isAddress(const std::string& text) {
    static const std::regex four(R"((25[0-5]|2[0-4]\d|1\d\d|[1-9]?\d)(\.(25[0-5]|2[0-4]\d|1\d\d|[1-9]?\d)){3})");
    return text.size() < 16 && std::regex_match(text, four);
}

Json statusEntry(const char* id, const char* message) {
    return {{"id", id}, {"message", message}, {"operational", true}, {"status", "ok"}};
}

/** Medwin 1975 at the surface, -2 to 40 degrees and 0 to 45 psu [m/s]. */
double automaticSpeed(double celsius, double salinity) {
    const double t = celsius;
    return 1449.2 + 4.6 * t - 0.055 * t * t + 0.00029 * t * t * t + (1.34 - 0.010 * t) * (salinity - 35);
}

double degreesBetween(const std::vector<double>& angles) {
    return angles.empty() ? 0 : types::degrees(std::abs(angles.back() - angles.front()));
}

/** Returns a range, moved into the limits that a client has set; 0: none, it is outside them [m]. A bin that a limit
 *  divides counts, because its echo may come from the part within.
 *  @param bin_width of the sonar; 0: unknown, and ranges count as exact [m] */
double rangeWithin(const Sonar3dState& state, double range, double bin_width) {
    const double rounding = bin_width > 0 ? -1e-6 : 1e-6;  // of ranges in float: a bin that ends at a limit is outside
    const bool is_within = range + bin_width / 2 >= state.range_min * (1 - rounding) &&
                           range - bin_width / 2 <= state.range_max * (1 + rounding);
    return is_within ? std::clamp(range, state.range_min, state.range_max) : 0;
}

}  // namespace

/** One path of the API: the answer of GET and the action of POST, if it has them. */
struct Sonar3dEmulator::Api {
    struct Path {
        std::function<Json()> get;
        std::function<std::optional<Json>(const Json&)> post;
    };

    Api(Sonar3dEmulator& emulator, types::Time now) : device(emulator), state(emulator.state_), time(now) {
        describeDevice();
        describeAcoustics();
        describeOutput();
        describeTime();
    }

    /** A path with an action and without an answer. */
    static std::function<std::optional<Json>(const Json&)> taking(std::function<void(const Json&)> take) {
        return [take = std::move(take)](const Json& json) {
            take(json);
            return std::optional<Json>();
        };
    }

    void describeDevice() {
        paths["about"].get = [] {
            return Json{{"chipid", "0x00000000"},
                        {"hardware_revision", 6},
                        {"is_ready", true},
                        {"product_id", 21045},
                        {"variant", ""},
                        {"version_short", "1.8.0"},
                        {"product_name", "Sonar 3D-15"},
                        {"version", "1.8.0 (Insonify)"}};
        };
        paths["status"].get = [] {
            return Json{{"api", statusEntry("api-normal", "Integration API is operational.")},
                        {"calibration", statusEntry("calibration-normal", "Calibrated.")},
                        {"systems_check", statusEntry("systems-check-normal", "All systems are operational.")},
                        {"temperature", statusEntry("temperature-normal", "Temperature is normal.")},
                        {"time", statusEntry("time-normal", "Time is set.")}};
        };
        paths["temperature"].get = [this] { return Json(device.device_.temperature_celsius); };
    }

    void describeAcoustics() {
        paths["acoustics/enabled"] = {[this] { return Json(state.acoustics); },
                                      taking([this](const Json& json) { state.acoustics = truthIn(json); })};
        paths["acoustics/range"] = {[this] {
                                        return Json{{"min", state.range_min}, {"max", state.range_max}};
                                    },
                                    taking([this](const Json& json) { setRange(json); })};
        paths["acoustics/speed_of_sound"] = {[this] { return Json(state.speed_of_sound); },
                                             taking([this](const Json& json) { setSpeed(json); })};
        paths["acoustics/mode"] = {[this] { return Json(state.high_frequency ? "high-frequency" : "low-frequency"); },
                                   taking([this](const Json& json) {
                                       state.high_frequency = isFirst(json, "high-frequency", "low-frequency");
                                   })};
        paths["acoustics/salinity"] = {
            [this] { return Json(state.fresh_water ? "fresh" : "salt"); },
            taking([this](const Json& json) { state.fresh_water = isFirst(json, "fresh", "salt"); })};
    }

    void setRange(const Json& json) {
        const double min = numberIn(member(json, "min"), "min"), max = numberIn(member(json, "max"), "max");
        const double longest = device.device_.longest_range;
        if (min < 0 || min >= max || max > longest)
            throw bad(fmt::format("a range of {:g} to {:g} m; must be 0 <= min < max <= {:g}", min, max, longest));
        state.range_min = min;
        state.range_max = max;
    }

    void setSpeed(const Json& json) {
        const double speed = numberIn(json, "the speed of sound");
        if (speed != 0 && (speed < slowest || speed > fastest))
            throw bad(fmt::format("a speed of sound of {:g} m/s; must be {:g} to {:g}, or 0: automatic", speed, slowest,
                                  fastest));
        state.speed_of_sound = speed;
    }

    void describeOutput() {
        paths["udp"] = {[this] {
                            return Json{{"mode", state.udp_mode},
                                        {"unicast_destination_ip", state.unicast_ip},
                                        {"unicast_destination_port", state.unicast_port}};
                        },
                        taking([this](const Json& json) { setUdp(json); })};
        paths["output/imu-batch/enabled"] = {[this] { return Json(state.imu); },
                                             taking([this](const Json& json) { state.imu = truthIn(json); })};
    }

    void setUdp(const Json& json) {
        const std::string mode = textIn(member(json, "mode"), "mode");
        const std::string ip = textIn(json.value("unicast_destination_ip", Json("")), "unicast_destination_ip");
        const double port = numberIn(json.value("unicast_destination_port", Json(0)), "unicast_destination_port");
        const bool unicast = mode == "unicast";
        if (!unicast && mode != "multicast" && mode != "disabled")
            throw bad(fmt::format("mode is \"{}\"; must be \"multicast\", \"unicast\" or \"disabled\"", mode));
        if (!isAddress(ip) && (unicast || !ip.empty()))
            throw bad(fmt::format("unicast_destination_ip is \"{}\"; must be like 192.168.2.1", ip));
        if (port != std::floor(port) || port < (unicast ? 1 : 0) || port > UINT16_MAX)
            throw bad(fmt::format("unicast_destination_port is {:g}; must be 1 to {}", port, UINT16_MAX));
        state.udp_mode = mode;
        state.unicast_ip = ip;
        state.unicast_port = static_cast<uint16_t>(port);
    }

    Json timeStatus() const {
        const Json since = state.ntp_synced
                               ? Json(static_cast<int64_t>((device.steady_.steady(time) - state.synced_at).seconds()))
                               : Json(nullptr);
        return {{"system_time", isoText(device.deviceTime(time))},
                {"ntp_synced", state.ntp_synced},
                {"ntp_synced_to", state.ntp_synced ? state.ntp_address : ""},
                {"ntp_seconds_since_last_sync", since}};
    }

    void describeTime() {
        paths["time/status"].get = [this] { return timeStatus(); };
        paths["time/manual"].post = taking([this](const Json& json) {
            const std::string text = textIn(member(json, "now"), "now");
            const auto set = isoTime(text);
            if (!set) throw bad(fmt::format("now is \"{}\"; must be like 2026-11-23T03:10:05Z", text));
            if (state.ntp_synced) throw Refused{409, "the time is synchronised already"};
            device.shift_ = *set - device.steady_.steady(time);
        });
        paths["time/ntp"] = {[this] {
                                 return Json{{"ntp_address", state.ntp_address}};
                             },
                             taking([this](const Json& json) {
                                 const std::string address = textIn(member(json, "ntp_address"), "ntp_address");
                                 if (address.empty() || address.find_first_of(" /") != std::string::npos)
                                     throw bad("ntp_address must be a host, or \"auto\"");
                                 state.ntp_address = address;
                             })};
        paths["time/ntp/force-sync"].post = [this](const Json& json) {
            if (numberIn(member(json, "timeout_seconds"), "timeout_seconds") < 0)
                throw bad("timeout_seconds must not be negative");
            device.shift_.reset();
            state.ntp_synced = true;
            state.synced_at = device.steady_.steady(time);
            return std::optional<Json>(Json{{"success", true}, {"message", "Synchronised."}, {"status", timeStatus()}});
        };
    }

    HttpReply reply(const HttpRequest& request) {
        const std::string path = request.path == "/api/v1/about"    ? "about"  // where the maker's finders ask
                                 : request.path.starts_with(prefix) ? request.path.substr(std::string(prefix).size())
                                                                    : "";
        const auto found = paths.find(path);
        if (found == paths.end()) throw Refused{404, "there is no " + request.path};
        const Path& known = found->second;
        if (request.method == "GET" && known.get) return {200, known.get().dump()};
        if (request.method != "POST" || !known.post)
            throw Refused{405, fmt::format("{} does not know {}", request.path, request.method)};
        const Json body = console::readJson<Json>(request.body);
        if (body.is_discarded()) throw bad("the body is no JSON");
        const auto answer = known.post(body);
        return answer ? HttpReply{200, answer->dump()} : HttpReply{};
    }

    Sonar3dEmulator& device;
    Sonar3dState& state;
    types::Time time;
    std::map<std::string, Path> paths;
};

void Sonar3dDevice::check(types::Diagnostics& diagnostics) const {
    if (!isAddress(multicast_address))
        diagnostics.push_back({"multicast_address", "is \"" + multicast_address + "\"; must be like 224.0.0.96"});
}

types::Time Sonar3dEmulator::deviceTime(types::Time stamp) const {
    return shift_ ? steady_.steady(stamp) + *shift_ : stamp;
}

HttpReply Sonar3dEmulator::answer(const HttpRequest& request, types::Time clock) {
    follow(clock);
    try {
        return Api(*this, clock).reply(request);
    } catch (const Refused& refused) {
        return httpError(refused.status, refused.why);
    }
}

double Sonar3dEmulator::speedOfSound() const {
    return state_.speed_of_sound > 0 ? state_.speed_of_sound
                                     : automaticSpeed(device_.temperature_celsius, state_.fresh_water ? 0 : 35);
}

void Sonar3dEmulator::ask(types::Time now) {
    types::SonarSettings settings;
    settings.time = steady_.clock(now);
    settings.range = state_.range_max;
    settings.frequency_khz = frequencyKhz(state_);
    settings.speed_of_sound = speedOfSound();
    const sonars::SonarMode& mode = Sonar3dDevice::mode(state_.high_frequency);
    const double columns = mode.beam_count;  // the opening is between the outermost, field_of_view to the edges
    settings.field_of_view = types::Angle::fromDeg(mode.field_of_view_deg * columns / (columns - 1));
    Sonar3dState request = state_;
    request.speed_of_sound = settings.speed_of_sound;
    requests_.add(now, now + types::Time::fromSeconds(2 * settings.range / settings.speed_of_sound),
                  std::move(request));
    last_ = now;
    outlet_.ask(settings);
}

types::Time Sonar3dEmulator::follow(types::Time clock) {
    const types::Time now = steady_.read(clock);
    if (steady_.jumpedBack() && state_.acoustics && !requests_.empty()) ask(now);
    return now;
}

std::optional<types::Time> Sonar3dEmulator::tick(types::Time clock) {
    const types::Time now = follow(clock);
    if (!state_.acoustics) return std::nullopt;
    return steady_.clock(workAt(now));
}

types::Time Sonar3dEmulator::workAt(types::Time now) {
    types::Time due = last_ ? *last_ + types::Time::fromSeconds(period()) : now;
    if (!requests_.empty()) due = std::max(due, requests_.deadline());
    if (now < due) return due;
    if (!requests_.empty() && !std::exchange(warned_, true))
        outlet_.warn("a requested ping gave no range image; another is requested");
    ask(now);
    return now + types::Time::fromSeconds(period());
}

RipImage Sonar3dEmulator::getFrame(const types::DepthMap& map, const Sonar3dState& request) const {
    RipImage image;
    image.time = deviceTime(map.time);
    image.sequence = sequence_;
    image.speed_of_sound = static_cast<float>(request.speed_of_sound);
    image.range = static_cast<float>(request.range_max);
    image.frequency_hz = static_cast<uint32_t>(std::lround(1e3 * frequencyKhz(request)));
    image.width = map.horizontal_size;
    image.height = map.vertical_size;
    image.field_of_view_deg = static_cast<float>(degreesBetween(map.horizontal_interval));
    image.vertical_opening_deg = static_cast<float>(degreesBetween(map.vertical_interval));
    return image;
}

void Sonar3dEmulator::send(const Bytes& packet) {
    if (state_.udp_mode == "unicast") outlet_.send(state_.unicast_ip, state_.unicast_port, packet);
    if (state_.udp_mode == "multicast")
        outlet_.send(device_.multicast_address, static_cast<uint16_t>(device_.multicast_port), packet);
}

void Sonar3dEmulator::setPing(const types::DepthMap& map) {
    const auto request = requests_.take(steady_.steady(map.time));
    if (!request) return;
    warned_ = false;
    ++sequence_;
    if (state_.acoustics && state_.udp_mode != "disabled") sendImages(map, *request);
}

void Sonar3dEmulator::sendImages(const types::DepthMap& map, const Sonar3dState& request) {
    RangePixels ranges;
    StrengthPixels strengths;
    static_cast<RipImage&>(ranges) = static_cast<RipImage&>(strengths) = getFrame(map, request);
    ranges.pixel_scale = static_cast<float>(std::max(millimetre, request.range_max / UINT16_MAX));
    const auto loudest = map.remissions.empty() ? map.remissions.end() : std::ranges::max_element(map.remissions);
    for (size_t row = map.vertical_size; row-- > 0;)  // the lowest first
        for (size_t column = 0; column < map.horizontal_size; ++column) {
            const size_t cell = row * map.horizontal_size + column;
            const double range = rangeWithin(request, map.distances[cell], map.bin_width);
            const bool seen = range > 0;
            const double pixel = std::round(range / static_cast<double>(ranges.pixel_scale));
            ranges.pixels.push_back(static_cast<uint32_t>(std::min<double>(pixel, UINT16_MAX)));
            const double share =
                seen && loudest != map.remissions.end() && *loudest > 0 ? map.remissions[cell] / *loudest : 0;
            const double level = strongest_pixel + 50 * std::log10(share);  // 100 log10 of an amplitude
            strengths.pixels.push_back(
                pixel > 0 ? static_cast<uint8_t>(std::lround(std::clamp(level, 1.0, strongest_pixel))) : 0);
        }
    const RipVersion version = device_.compressed ? RipVersion::Rip2 : RipVersion::Rip1;
    send(ripPacket(ranges, version));
    send(ripPacket(strengths, version));
}

}  // namespace insonify::device
