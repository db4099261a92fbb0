#include "components/dataset/SampleFiles.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <memory>
#include <stdexcept>
#include <string_view>

#include "components/log/NpzFile.hpp"
#include "components/log/Stream.hpp"
#include "components/log/Writer.hpp"
#include "components/output/PictureFiles.hpp"

namespace insonify::dataset {
namespace {

template <class List>
void append(List& list, const List& more) {
    list.insert(list.end(), more.begin(), more.end());
}

}  // namespace

void Run::add(const types::SonarPtr& added, const types::SonarTruthPtr& its_truth) {
    const types::Sonar& ping = *added;
    const types::SonarTruth& truth = *its_truth;
    if (!pings_.empty() && (ping.bin_count != pings_[0]->bin_count || ping.beam_count != pings_[0]->beam_count))
        throw std::runtime_error("the pings of one sample differ in their beams or bins");
    pings_.push_back(added);
    truths_.push_back(its_truth);
    if (pings_.size() == 1) return;
    if (pings_.size() == 2) {
        ping_ = *pings_[0];
        truth_ = *truths_[0];
    }
    ping_.beam_count += ping.beam_count;
    append(ping_.bearings, ping.bearings);
    append(ping_.bins, ping.bins);
    append(ping_.timestamps, ping.timestamps);
    truth_.beam_count += truth.beam_count;
    append(truth_.bearings, truth.bearings);
    std::map<std::string_view, const void*> lists;
    types::SonarTruth::forEachArray(
        truth, [&](const char* name, const auto& list, auto) { lists[name] = std::addressof(list); });
    types::SonarTruth::forEachArray(truth_, [&]<class List>(const char* name, List& list, auto) {
        append(list, *static_cast<const List*>(lists.at(name)));
    });
}

namespace fs = std::filesystem;
namespace {

Json toJson(const types::Pose& pose) {
    const auto& [p, q] = std::tie(pose.position, pose.orientation);
    return {{"position", {p.x, p.y, p.z}}, {"orientation_wxyz", {q.w, q.x, q.y, q.z}}};
}

Json toJson(const Annotation& annotation, const Classes& classes, const output::PlainPicture& picture) {
    const Box& box = annotation.box;
    return {{"object", annotation.object},
            {"parts", annotation.parts},
            {"name", annotation.name},
            {"class", classes.names()[annotation.category - 1]},
            {"category", annotation.category},
            {"shadow", annotation.is_shadow},
            {"bbox", {box.x, box.y, box.width, box.height}},
            {"area", annotation.area},
            {"bins", annotation.bins},
            {"energy", annotation.energy},
            {"range_m", {annotation.range_min, annotation.range_max}},
            {"bearing_rad", {annotation.bearing_min, annotation.bearing_max}},
            {"segmentation", {{"size", {picture.height(), picture.width()}}, {"counts", annotation.runs}}}};
}

Json toJson(const Run& run, const types::BeamArc& arc) {
    const types::Sonar& ping = run.ping();
    return {{"lines", run.size()},
            {"beams", ping.beam_count / run.size()},
            {"bins", ping.bin_count},
            {"range_m", ping.bin_count * ping.binWidth()},
            {"bearing_rad", {arc.bearings.front(), arc.bearings.back()}},
            {"speed_of_sound_m_s", ping.speed_of_sound}};
}

/** Returns a picture whose grey levels are the numbers of annotations, or of classes. */
types::Image mask(types::Image picture, const Annotated& annotated, bool classes) {
    for (size_t i = 0; i < picture.image.size(); ++i) {
        const uint16_t number = annotated.labels[i];
        const uint32_t level = number == 0 ? 0 : classes ? annotated.annotations[number - 1u].category : number;
        if (level > std::numeric_limits<uint8_t>::max())
            throw std::runtime_error(
                "a picture shows more than 255 objects or classes, which a mask cannot distinguish; "
                "give fewer classes");
        picture.image[i] = static_cast<uint8_t>(level);
    }
    return picture;
}

/** Returns class, centre and size of each box, relative to the picture. */
std::string yolo(const Annotated& annotated, const output::PlainPicture& picture) {
    const double width = picture.width(), height = picture.height();
    std::string text;
    for (const Annotation& each : annotated.annotations)
        text += fmt::format("{} {:.6f} {:.6f} {:.6f} {:.6f}\n", each.category - 1,
                            (each.box.x + each.box.width / 2.0) / width, (each.box.y + each.box.height / 2.0) / height,
                            each.box.width / width, each.box.height / height);
    return text;
}

/** Adds the time of each line and the vehicle's pose at that time. */
void addLines(log::NpzFile& npz, const std::vector<TimedPose>& run) {
    std::vector<double> times, positions, orientations;
    for (const auto& [time, at] : run) {
        times.push_back(time);
        for (const double each : {at.position.x, at.position.y, at.position.z}) positions.push_back(each);
        for (const double each : {at.orientation.w, at.orientation.x, at.orientation.y, at.orientation.z})
            orientations.push_back(each);
    }
    npz.array("times", {run.size()}, times);
    npz.array("positions", {run.size(), 3}, positions);
    npz.array("orientations_wxyz", {run.size(), 4}, orientations);
}

template <class Number>
void addTruth(log::NpzFile& npz, const std::string& name, const auto& numbers, const std::vector<size_t>& shape) {
    npz.begin(name, log::numpyType<Number>(), shape);
    npz.append(numbers.data(), numbers.size() * sizeof(numbers[0]));
    npz.end();
}

/** Adds a range image, rows from the top, each from port to starboard, and the truth of its cells as range_object and
 *  so on. */
void addRangeImage(log::NpzFile& npz, const types::DepthMap& image, const types::SonarTruth& truth) {
    const std::vector<size_t> shape{image.vertical_size, image.horizontal_size};
    npz.array("distances", shape, image.distances);
    npz.array("remissions", shape, image.remissions);
    npz.array("vertical_interval", {image.vertical_interval.size()}, image.vertical_interval);
    npz.array("horizontal_interval", {image.horizontal_interval.size()}, image.horizontal_interval);
    types::SonarTruth::forEachArray(
        truth, [&]<class Number>(const char* name, const auto& numbers, std::type_identity<Number>) {
            addTruth<Number>(npz, std::string("range_") + name, numbers, shape);
        });
}

void writeNpz(const fs::path& file, const Recorded& recorded, const std::string& meta) {
    const types::Sonar& ping = recorded.run.ping();
    const uint32_t lines = recorded.run.size(), beams = ping.beam_count / lines;
    std::vector<size_t> shape{beams, ping.bin_count};
    if (lines > 1) shape.insert(shape.begin(), lines);
    std::vector<double> bearings, ranges;
    for (uint32_t beam = 0; beam < beams; ++beam) bearings.push_back(ping.bearings[beam].rad);
    for (uint32_t k = 0; k < ping.bin_count; ++k) ranges.push_back((k + 0.5) * ping.binWidth());
    log::NpzFile npz(file);
    npz.array("bins", shape, ping.bins);
    npz.array("bearings", {bearings.size()}, bearings);
    npz.array("range_m", {ranges.size()}, ranges);
    types::SonarTruth::forEachArray(
        recorded.run.truth(), [&]<class Number>(const char* name, const auto& numbers, std::type_identity<Number>) {
            addTruth<Number>(npz, name, numbers, shape);
        });
    if (recorded.range_image) addRangeImage(npz, *recorded.range_image, *recorded.range_truth);
    if (lines > 1) addLines(npz, recorded.sample.run);
    npz.texts("objects", recorded.run.truth().objects);
    npz.text("meta", meta);
    npz.close();
}

void writeMcap(const fs::path& file, const Recorded& recorded) {
    const fs::path bag = file.string() + ".bag", inside = bag / "sample.mcap";  // a description is written next to it
    fs::create_directory(bag);
    const auto log = log::createLog(inside);
    log::Metadata metadata;
    log::addSampleMetadata(recorded.run.pings()[0].get(), metadata);
    const size_t ping = log->addStream<types::Sonar>("sonar.ping", metadata);
    log::addSampleMetadata(recorded.run.truths()[0].get(), metadata);
    const size_t truth = log->addStream<types::SonarTruth>("sonar.truth", metadata);
    const size_t pose = log->addStream<types::Pose>("vehicle.pose");
    if (recorded.range_image) {
        const types::Time time = recorded.run.pings()[0]->time;
        log->write(log->addStream<types::DepthMap>("sonar.range_image"), time, *recorded.range_image);
        log->write(log->addStream<types::SonarTruth>("sonar.range_truth"), time, *recorded.range_truth);
    }
    for (uint32_t i = 0; i < recorded.run.size(); ++i) {
        types::Pose at = recorded.sample.run[i].at;
        at.time = recorded.run.pings()[i]->time;
        log->write(pose, at.time, at);
        log->write(ping, at.time, *recorded.run.pings()[i]);
        log->write(truth, at.time, *recorded.run.truths()[i]);
    }
    log->close();
    fs::rename(inside, file);
    fs::remove_all(bag);
}

}  // namespace

SampleFiles::SampleFiles(const Sweep& sweep, Format format, const Classes& classes, Store& store)
    : sweep_(sweep), format_(format), classes_(classes), store_(store), picture_(sweep.picture) {}

void SampleFiles::write(const Recorded& recorded) {
    const Annotated annotated = makeAnnotated(recorded);
    Json record = makeRecord(recorded, annotated);
    record["files"] = writeFiles(store_.makeStem(recorded.sample.index), recorded, annotated, record);
    store_.putRecord(recorded.sample.index, std::move(record));
}

Annotated SampleFiles::makeAnnotated(const Recorded& recorded) {
    const types::Sonar& ping = recorded.run.ping();
    if (sweep_.picture.shape == output::PlainShape::Range) {
        const types::DepthMap& image = *recorded.range_image;
        picture_.take(image, ping.bin_count * ping.binWidth());
        types::Sonar cells;
        cells.bin_count = 1;
        cells.beam_count = recorded.range_truth->beam_count;
        cells.bearings = recorded.range_truth->bearings;
        cells.bins = image.remissions;
        return annotate(cells, *recorded.range_truth, picture_, classes_, recorded.instances, sweep_.annotations,
                        output::BinScale::Linear, image.distances);
    }
    picture_.take(ping);
    return annotate(ping, recorded.run.truth(), picture_, classes_, recorded.instances, sweep_.annotations,
                    sweep_.picture.scale, {}, recorded.hiders);
}

Json SampleFiles::makeRecord(const Recorded& recorded, const Annotated& annotated) const {
    const Sample& sample = recorded.sample;
    Json record{{"index", sample.index},
                {"part", std::string(types::EnumNames<Part>::names[static_cast<size_t>(sample.part)])},
                {"scene", recorded.scene},
                {"sequence", {sample.scene, sample.setting}},
                {"frame", sample.pose},
                {"time_s", sample.run.front().time},
                {"settings", Json::object()},
                {"pose", toJson(sample.run.front().at)},
                {"objects", Json::array()},
                {"ping", toJson(recorded.run, picture_.arc())},
                {"picture",
                 {{"width", picture_.width()},
                  {"height", picture_.height()},
                  {"shape",
                   std::string(types::EnumNames<output::PlainShape>::names[static_cast<size_t>(sweep_.picture.shape)])},
                  {"reference_db", picture_.referenceDb()}}},
                {"annotations", Json::array()}};
    for (const auto& [property, value] : recorded.settings) record["settings"][property] = value;
    for (const PlacedObject& object : sample.objects) {
        Json placed{{"name", object.name}, {"present", object.present}};
        if (object.present) placed.update(toJson(object.at));
        if (object.present) placed["scale"] = object.scale;
        record["objects"].push_back(std::move(placed));
    }
    for (const Annotation& each : annotated.annotations)
        record["annotations"].push_back(toJson(each, classes_, picture_));
    return record;
}

std::string SampleFiles::putPicture(const std::string& name, const types::Image& picture) {
    return store_.put(name, [&](const fs::path& file) { output::writePng(file, picture); });
}

Json SampleFiles::writeFiles(const std::string& stem, const Recorded& recorded, const Annotated& annotated,
                             const Json& meta) {
    Json files = Json::object();
    if (hasPictures(format_)) files[stem + ".png"] = putPicture(stem + ".png", picture_.image());
    if (format_ == Format::Yolo) files[stem + ".txt"] = store_.putText(stem + ".txt", yolo(annotated, picture_));
    if (format_ == Format::Mask)
        for (const bool classes : {false, true}) {
            const std::string name = stem + (classes ? "_classes.png" : "_instances.png");
            files[name] = putPicture(name, mask(picture_.image(), annotated, classes));
        }
    if (format_ == Format::Npz)
        files[stem + ".npz"] =
            store_.put(stem + ".npz", [&](const fs::path& file) { writeNpz(file, recorded, toText(meta)); });
    if (format_ == Format::Mcap)
        files[stem + ".mcap"] = store_.put(stem + ".mcap", [&](const fs::path& file) { writeMcap(file, recorded); });
    return files;
}

}  // namespace insonify::dataset
