#include "components/log/Reader.hpp"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <exception>
#include <iterator>

#include "components/log/Stream.hpp"
#include "components/log/TypeNames.hpp"
#include "components/log/db3/Reader.hpp"
#include "components/log/mcap/Reader.hpp"
#include "components/log/pocolog/Reader.hpp"
#include "types/Check.hpp"
#include "types/Time.hpp"
#include "types/text/DidYouMean.hpp"

namespace insonify::log {

std::string Reader::diagnostic() const {
    return gaps_.empty() ? "" : gaps_.front().what + " at byte " + std::to_string(gaps_.front().from);
}

const Stream* Reader::find(const std::string& name) const {
    const auto found = std::ranges::find(streams_, name, &Stream::name);
    if (found != streams_.end()) return &*found;
    if (!name.starts_with('/')) return nullptr;
    const auto on_topic = std::ranges::find(streams_, name, &Stream::topic);
    if (on_topic != streams_.end()) return &*on_topic;
    std::string by_topic = name.substr(1);  // "/auv/sonar" is stream auv.sonar
    std::ranges::replace(by_topic, '/', '.');
    return find(by_topic);
}

size_t Reader::findIndex(const std::string& name) const {
    if (const Stream* stream = find(name)) return static_cast<size_t>(stream - streams_.data());
    std::string names;
    for (const Stream& stream : streams_) names += (names.empty() ? "" : ", ") + stream.name;
    throw types::ConfigError(path_, name, "there is no such stream; there are: " + (names.empty() ? "none" : names));
}

std::string Reader::metadatum(const std::string& key) const {
    const auto has = [&](const Stream& stream) { return stream.metadata.contains(key); };
    const auto found = std::ranges::find_if(streams_, has);
    return found == streams_.end() ? "" : found->metadatum(key);
}

void Reader::addPoses(Stream stream, MadePoses made) {
    const auto& poses = made.poses;
    const size_t own = streams_.size();
    stream.sample = types::sampleIndex<types::Pose>();
    stream.type = typelibName<types::Pose>();
    for (const MadePose& pose : poses) stream.note(pose.time);
    std::vector<SampleRef> all;
    all.reserve(samples_.size() + poses.size());
    auto next = poses.begin();
    for (const SampleRef& at : samples_) {
        all.push_back(at);
        for (; next != poses.end() && next->after == at.number; ++next)
            all.push_back({own, at.received, next->time, at.position, at.number});
    }
    samples_ = std::move(all);
    streams_.push_back(std::move(stream));
    made_[own] = std::move(made);
}

void Reader::keepSamples(size_t stream, const std::function<bool(SampleRef&)>& keep) {
    Stream& changed = streams_[stream];
    std::vector<SampleRef> all = std::move(samples_);
    samples_.clear();
    changed.count = changed.set_backs = 0;
    changed.set_back = changed.first = changed.last = {};
    for (SampleRef& at : all)
        if (at.stream != stream)
            samples_.push_back(at);
        else if (keep(at))
            changed.note(at.time), samples_.push_back(at);
}

std::vector<std::string> Reader::dropDamaged(size_t stream) {
    std::vector<std::string> lost;
    std::exception_ptr first;
    keepSamples(stream, [&](SampleRef& at) {
        try {
            verify(at);
        } catch (const types::ConfigError& error) {
            if (!first) first = std::current_exception();
            lost.emplace_back(error.what());
            return false;
        }
        return true;
    });
    if (first && streams_[stream].count == 0) std::rethrow_exception(first);
    return lost;
}

void Reader::readMade(const SampleRef& at, const MadePoses& made, types::Pose& pose) {
    const MadePose& found = *std::ranges::lower_bound(made.poses, at.number, {}, &MadePose::after);
    pose = {};
    pose.time = found.time;
    pose.source_frame = made.child;
    pose.target_frame = made.parent;
    pose.position = found.position;
    pose.orientation = found.orientation;
    if (!std::isnan(found.variances.x)) pose.cov_position = glm::dmat3(0);
    for (int axis = 0; axis < 3; ++axis) pose.cov_position[axis][axis] = found.variances[axis];
}

void Reader::readInto(const SampleRef& at, types::SampleRoom room) try {
    if (const auto made = made_.find(at.stream); made != made_.end())
        return readMade(at, made->second, *std::get<types::Pose*>(room));
    decode(at, room);
    restoreBins(streams_[at.stream].metadata, room);
} catch (const types::ConfigError&) {
    throw;
} catch (const types::CheckFailure&) {
    throw;
} catch (const std::runtime_error& error) {
    failSample(at, std::string("cannot be decoded: ") + error.what());
} catch (const std::logic_error& error) {
    failSample(at, std::string("cannot be decoded: ") + error.what());
}

types::SampleView Reader::sampleAt(const SampleRef& at) {
    const std::optional<size_t> sample = streams_[at.stream].sample;
    if (!sample) failSample(at, "is of a type that is not read");
    if (!room_) room_ = std::make_unique<types::SampleTypes>();
    const types::SampleRoom room = roomFor(*sample, *room_);
    readInto(at, room);
    return std::visit([](auto* held) { return types::SampleView(held); }, room);
}

void Reader::verify(const SampleRef& at) {
    if (!streams_[at.stream].sample) return;
    if (const char* diagnostic = findDiagnostic(sampleAt(at))) failSample(at, diagnostic);
}

void Reader::addSample(size_t number, types::Time received, types::Time time, uint64_t position) {
    streams_[number].note(time);
    samples_.push_back({number, received, time, position, samples_.size()});
}

void Reader::failSample(const SampleRef& at, const std::string& what) const {
    throw types::ConfigError(path_, streams_[at.stream].name, "the sample " + getPlace(at) + " " + what);
}

void Reader::failType(const SampleRef& at, size_t wanted) const {
    const Stream& stream = streams_[at.stream];
    std::string name;
    types::forEachSampleType([&]<class T>(std::type_identity<T>) {
        if (types::sampleIndex<T>() == wanted) name = typelibName<T>();
    });
    throw types::ConfigError(path_, stream.name, "holds " + stream.type + ", not " + name);
}

types::SampleRoom roomFor(size_t sample, types::SampleTypes& samples) {
    types::SampleRoom room;
    types::forEachSampleType([&]<class T>(std::type_identity<T>) {
        if (types::sampleIndex<T>() == sample) room = &std::get<T>(samples);
    });
    return room;
}

const char* findDiagnostic(types::SampleView sample) {
    return std::visit([](const auto* held) { return types::findDiagnostic(*held); }, sample);
}

namespace {

constexpr LogFormat all_formats[] = {{".log", Storage::Pocolog}, {".mcap", Storage::Mcap}, {".db3", Storage::Db3}};

const LogFormat* getFormat(const std::filesystem::path& path) { return types::findFormat(all_formats, path); }

/** Returns the files of the bag in a folder: those of its metadata.yaml, else the only one. Throws ConfigError for a
 *  folder with none, or with several and no metadata. */
std::vector<std::filesystem::path> filesOfBag(const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> files;
    try {
        for (const YAML::Node& name :
             YAML::LoadFile(folder / "metadata.yaml")["rosbag2_bagfile_information"]["relative_file_paths"])
            files.push_back(folder / name.as<std::string>());
    } catch (const YAML::Exception&) {  // the files are looked for
    }
    for (const auto& file : files)
        if (const auto below = file.lexically_normal().lexically_relative(folder.lexically_normal());
            below.empty() || *below.begin() == "..")
            throw types::ConfigError(folder / "metadata.yaml", "relative_file_paths",
                                     "names " + file.string() + ", which is outside of the bag, and is not read");
    std::error_code none;
    std::string names;
    if (files.empty())
        for (const auto& entry : std::filesystem::directory_iterator(folder, none))
            if (const LogFormat* const format = getFormat(entry.path());
                format && format->storage != Storage::Pocolog) {
                files.push_back(entry.path());
                names += (names.empty() ? "" : ", ") + entry.path().filename().string();
            }
    const auto packed = std::ranges::find(files, ".zstd", [](const auto& file) { return file.extension().string(); });
    if (packed != files.end())
        throw types::ConfigError(folder, "", "is a bag that is compressed; unpack it: zstd -d " + packed->string());
    if (names.empty() ? files.empty() : files.size() > 1)
        throw types::ConfigError(
            folder, "",
            names.empty() ? "is a folder; give a log in it: a " + types::alternativeEndings(all_formats) + " file"
                          : "is a folder without metadata.yaml; give one of its files: " + names);
    return files;
}

using Parts = std::vector<std::unique_ptr<Reader>>;

void sortByTime(Parts& parts) {
    std::ranges::stable_sort(parts, {}, [](const auto& part) {
        return part->samples().empty() ? types::Time{} : part->samples().front().received;
    });
}

/** Several files as one log, in their order. Streams of one name are one stream. */
class JoinedLog final : public Reader {
public:
    JoinedLog(const std::filesystem::path& path, Parts parts) : Reader(path), parts_(std::move(parts)) {
        for (const auto& part : parts_) add(*part);
    }

    uint64_t bytes() const override {
        uint64_t sum = 0;
        for (const auto& part : parts_) sum += part->bytes();
        return sum;
    }
    const std::string& layout(size_t stream) const override { return layouts_[stream]; }
    std::span<const char> toBytes(const SampleRef& at) override {
        const auto& [part, place] = places_[at.number];
        return part->toBytes(place);
    }

private:
    void add(Reader& part) {
        std::vector<size_t> numbers;
        for (size_t i = 0; i < part.streams().size(); ++i) numbers.push_back(getNumber(part, i));
        for (const SampleRef& at : part.samples()) {
            places_.emplace_back(&part, at);
            addSample(numbers[at.stream], at.received, at.time, at.position);
        }
        for (Gap gap : part.gaps()) {
            gap.what = part.path().filename().string() + ": " + gap.what;
            gaps_.push_back(std::move(gap));
        }
    }
    size_t getNumber(const Reader& part, size_t index) {
        const Stream& stream = part.streams()[index];
        const auto same = std::ranges::find(streams_, stream.name, &Stream::name);
        if (same != streams_.end() && same->type != stream.type)
            throw types::ConfigError(part.path(), stream.name,
                                     "is " + stream.type + "; in another file of the log it is " + same->type);
        if (same != streams_.end()) {
            for (const char* of_samples : {bin_width_key, speed_of_sound_key})
                if (same->metadatum(of_samples) != stream.metadatum(of_samples)) same->metadata.erase(of_samples);
            return static_cast<size_t>(same - streams_.begin());
        }
        Stream empty = stream;
        empty.count = empty.set_backs = 0;
        empty.first = empty.last = empty.set_back = {};
        streams_.push_back(std::move(empty));
        layouts_.push_back(part.layout(index));
        return streams_.size() - 1;
    }
    void decode(const SampleRef& at, types::SampleRoom room) override {
        const auto& [part, place] = places_[at.number];
        std::visit([&, part = part, place = place](auto* sample) { part->read(place, *sample); }, room);
    }

    Parts parts_;
    std::vector<std::pair<Reader*, SampleRef>> places_;  ///< Of each sample, by its number.
    std::vector<std::string> layouts_;                   ///< Of each stream.
};

std::unique_ptr<Reader> openFile(const std::filesystem::path& path, AtDamage at_damage, types::WorldFrame foreign) {
    const Storage storage = getStorage(path);
    if (storage == Storage::Mcap) return std::make_unique<mcap::Reader>(path, at_damage, foreign);
    if (storage == Storage::Db3)
#ifdef INSONIFY_SQLITE
        return std::make_unique<db3::Reader>(path, foreign);
#else
        throw types::ConfigError(path, "",
                                 "cannot be read: this build has no SQLite; install libsqlite3-dev and build again, or "
                                 "convert it to MCAP with `ros2 bag convert`");
#endif
    return std::make_unique<pocolog::Reader>(path, at_damage);
}

}  // namespace

const LogFormat* findLogFormat(const std::filesystem::path& path) {
    const LogFormat* const format = getFormat(path);
    return format && format->isWritten() ? format : nullptr;
}

std::string logEndings() {
    return types::alternativeEndings(all_formats, [](const LogFormat& format) { return format.isWritten(); });
}

Storage getStorage(const std::filesystem::path& path) {
    const LogFormat* const format = getFormat(path);
    return format ? format->storage : Storage::Pocolog;
}

std::unique_ptr<Reader> openLog(const std::filesystem::path& path, AtDamage at_damage, types::WorldFrame foreign) {
    std::error_code none;
    if (!std::filesystem::is_directory(path, none)) return openFile(path, at_damage, foreign);
    Parts parts;
    for (const std::filesystem::path& file : filesOfBag(path)) parts.push_back(openFile(file, at_damage, foreign));
    sortByTime(parts);
    return parts.size() == 1 ? std::move(parts.front()) : std::make_unique<JoinedLog>(path, std::move(parts));
}

std::optional<unsigned> sequenceNumber(const std::filesystem::path& log) {
    const std::string digits = log.stem().extension().string();
    unsigned number = 0;
    const auto [end, error] = std::from_chars(digits.data() + !digits.empty(), digits.data() + digits.size(), number);
    if (error != std::errc() || end != digits.data() + digits.size()) return std::nullopt;
    return number;
}

std::map<unsigned, std::filesystem::path> findSequence(const std::filesystem::path& log) {
    std::map<unsigned, std::filesystem::path> files;
    if (!sequenceNumber(log)) return files;
    std::error_code failed;
    const auto getName = [](const std::filesystem::path& file) { return file.stem().stem().string(); };
    const auto folder = log.parent_path();
    for (const auto& entry : std::filesystem::directory_iterator(folder.empty() ? "." : folder, failed)) {
        const std::filesystem::path file = folder / entry.path().filename();
        if (const auto number = sequenceNumber(file); number && file.extension() == log.extension() &&
                                                      getName(file) == getName(log) && entry.is_regular_file(failed))
            files[*number] = file;
    }
    return files;
}

WholeLog openWholeLog(const std::filesystem::path& path, AtDamage at_damage, types::WorldFrame foreign) {
    Parts parts;
    parts.push_back(openLog(path, at_damage, foreign));
    WholeLog whole{nullptr, {path}, {}};
    const auto files = findSequence(path);
    const auto isOfThisRun = [&](const Reader& part) {
        const auto same = [&](const char* key) { return part.metadatum(key) == parts.front()->metadatum(key); };
        return same("insonify_deployment") && same("insonify_seed");
    };
    if (!files.empty() && files.begin()->first == *sequenceNumber(path))
        for (auto next = std::next(files.begin()); next != files.end(); ++next) {
            auto part = openLog(next->second, at_damage, foreign);
            if (!isOfThisRun(*part)) {
                whole.notice = next->second.string() + " is of another run, and is not taken with " + path.string();
                break;
            }
            parts.push_back(std::move(part));
            whole.files.push_back(next->second);
        }
    if (parts.size() > 1)
        whole.notice = path.string() + " is continued in " + std::to_string(parts.size() - 1) + " files up to " +
                       whole.files.back().filename().string() + ", which are taken with it" +
                       (whole.notice.empty() ? "" : "; " + whole.notice);
    whole.log = parts.size() == 1 ? std::move(parts.front()) : std::make_unique<JoinedLog>(path, std::move(parts));
    return whole;
}

std::optional<std::filesystem::path> propertyLog(const Reader& log) {
    const std::filesystem::path path = log.path().parent_path() / "properties.0.log";
    if (path == log.path() || !std::filesystem::is_regular_file(path)) return {};
    const auto properties = openLog(path);
    const auto same = [&](const char* key) { return log.metadatum(key) == properties->metadatum(key); };
    if (!same("insonify_deployment") || !same("insonify_seed")) return {};
    return path;
}

namespace {

template <class T>
types::Sonar converted(Reader& log, const SampleRef& at) {
    T sample;
    log.read(at, sample);
    try {
        return toSonar(sample);
    } catch (const std::logic_error& error) {
        throw types::ConfigError(log.path(), log.streams()[at.stream].name, std::string("a sample ") + error.what());
    }
}

}  // namespace

bool holdsPings(const Stream& stream) {
    return stream.holds<types::Sonar>() || stream.holds<types::SonarBeam>() || stream.holds<types::SonarScan>();
}

void readPing(Reader& log, const SampleRef& at, types::Sonar& ping) {
    const Stream& stream = log.streams()[at.stream];
    if (stream.holds<types::SonarBeam>())
        ping = converted<types::SonarBeam>(log, at);
    else if (stream.holds<types::SonarScan>())
        ping = converted<types::SonarScan>(log, at);
    else
        log.read(at, ping);
    if (!ping.wellShaped())
        throw types::ConfigError(log.path(), stream.name, "a ping has other numbers of bins or bearings than it says");
    ping.time = sampleTime(ping, at.time);
}

LoggerClock::LoggerClock(const std::vector<SampleRef>& samples) {
    for (size_t i = 1; i < samples.size(); ++i) {
        const types::Time back = samples[i - 1].received - samples[i].received;
        if (back <= types::max_lateness) continue;
        const types::Time before = i > 1 ? samples[i - 1].received - samples[i - 2].received : types::Time{};
        const types::Time interval = std::clamp(before, types::Time{}, types::max_lateness);
        steps_.push_back({samples[i].number, steps_.back().shift + back + interval});
    }
}

types::Time LoggerClock::evenTime(const SampleRef& at) const {
    auto step = std::prev(std::ranges::upper_bound(steps_, at.number, {}, &Step::number));
    const bool is_stamped_before = at.time - at.received > types::max_lateness;
    if (is_stamped_before && step != steps_.begin()) --step;
    return at.time + step->shift;
}

types::Time LoggerClock::sinceFirst(const std::vector<SampleRef>& samples, const SampleRef& at) const {
    return evenTime(at) - evenTime(samples.front());
}

types::Time LoggerClock::span(const std::vector<SampleRef>& samples) const {
    types::Time latest;
    for (const SampleRef& at : samples) latest = std::max(latest, sinceFirst(samples, at));
    return latest;
}

size_t LoggerClock::indexAt(const std::vector<SampleRef>& samples, double seconds) const {
    const types::Time from = types::Time::fromSeconds(seconds);
    const auto late_enough = [&](const SampleRef& at) { return sinceFirst(samples, at) >= from; };
    return static_cast<size_t>(std::ranges::find_if(samples, late_enough) - samples.begin());
}

}  // namespace insonify::log
