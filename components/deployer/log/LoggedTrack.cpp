#include "components/deployer/log/LoggedTrack.hpp"

#include <algorithm>

#include "components/console/Console.hpp"

namespace insonify::deployer {

void dropDamaged(log::Reader& log, const std::string& stream) {
    for (const std::string& lost : log.dropDamaged(log.findIndex(stream))) console::printDiagnostic("lost: {}\n", lost);
}

LoggedAltitudes::LoggedAltitudes(log::Reader& log) {
    const auto holds = [](const log::Stream& stream) { return stream.holds<types::Range>(); };
    if (std::ranges::count_if(log.streams(), holds) != 1) return;
    const std::string name = std::ranges::find_if(log.streams(), holds)->name;
    dropDamaged(log, name);
    log.forEach<types::Range>(name, [&](const types::Range& range, const log::SampleRef&) {
        all_[range.time] = range.isKnown() ? range.range : 0;
    });
}

double LoggedAltitudes::nearestTo(types::Time time) const {
    const double known = time < all_.begin()->first ? all_.begin()->second : at(time);
    return known > 0 ? known : types::Range::none;
}

double LoggedAltitudes::at(types::Time time) const {
    const auto after = all_.upper_bound(time);
    return after == all_.begin() ? 0 : std::prev(after)->second;
}

const log::Stream* posesOfSonar(const log::Reader& log) {
    std::vector<const log::Stream*> all, of_sonars;
    for (const log::Stream& stream : log.streams()) {
        if (!stream.holds<types::Pose>()) continue;
        all.push_back(&stream);
        if (stream.metadatum("rock_task_model").starts_with("sonar::")) of_sonars.push_back(&stream);
    }
    if (of_sonars.size() == 1) return of_sonars.front();
    return all.size() == 1 ? all.front() : nullptr;
}

types::Mount findMount(const Json& meaning) {
    types::Mount mount;
    const Json& given = meaning["mount"];
    if (!given.is_object()) return mount;
    if (const Json place = given.value("position", Json()); place.is_array() && place.size() == 3)
        for (int axis = 0; axis < 3; ++axis) mount.position[axis] = place[static_cast<size_t>(axis)].get<double>();
    mount.roll_deg = given.value("roll_deg", 0.0);
    mount.pitch_deg = given.value("pitch_deg", 0.0);
    mount.yaw_deg = given.value("yaw_deg", 0.0);
    return mount;
}

LoggedTrack::LoggedTrack(log::Reader& log, const log::Stream* poses, const types::Mount& mount) {
    if (!poses) return;
    dropDamaged(log, poses->name);
    log.forEach<types::Pose>(poses->name, [&](const types::Pose& body, const log::SampleRef&) {
        types::Pose& sonar = all_.emplace_back(body);
        if (body.source_frame != "sonar" && isUsable(body)) place(body, mount, sonar);
    });
    std::ranges::stable_sort(all_, {}, &types::Pose::time);
}

types::Pose LoggedTrack::at(types::Time time) const {
    const auto after = std::ranges::upper_bound(all_, time, {}, &types::Pose::time);
    if (after != all_.begin()) return *std::prev(after);
    types::Pose none;
    none.position.x = types::Pose::unknown;
    return none;
}

}  // namespace insonify::deployer
