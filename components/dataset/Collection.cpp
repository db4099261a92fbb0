#include "components/dataset/Collection.hpp"

#include <fmt/format.h>

#include <fstream>
#include <map>
#include <stdexcept>

#include "components/console/Sha256.hpp"
#include "components/dataset/SampleFiles.hpp"
#include "components/dataset/StatisticsPage.hpp"

namespace insonify::dataset {
namespace {

constexpr Part parts[] = {Part::Train, Part::Val, Part::Test};

std::string nameOf(Part part) { return std::string(types::EnumNames<Part>::names[static_cast<size_t>(part)]); }

/** Returns the picture file of a sample. */
std::string pictureOf(const Json& record) {
    for (const auto& [name, sum] : record["files"].items())
        if (name.ends_with(".png") && !name.ends_with("_instances.png") && !name.ends_with("_classes.png")) return name;
    throw std::runtime_error("a sample has no picture");
}

Json cocoImage(const Json& record) {
    return {{"id", record["index"]},
            {"file_name", pictureOf(record)},
            {"width", record["picture"]["width"]},
            {"height", record["picture"]["height"]}};
}

Json cocoAnnotation(const Json& each, const Json& image, uint64_t id) {
    return {{"id", id},
            {"image_id", image},
            {"category_id", each["category"]},
            {"bbox", each["bbox"]},
            {"area", each["area"]},
            {"iscrowd", 0},
            {"segmentation", each["segmentation"]},
            {"object", each["name"]}};
}

}  // namespace

bool Collection::isWhole(bool closely) const {
    for (uint64_t index = 0; index < count_; ++index) {
        const bool there =
            closely ? store_.has(index) : std::filesystem::exists(store_.folder() / (store_.stemOf(index) + ".json"));
        if (!there) return false;
    }
    return true;
}

void Collection::forEach(const std::function<void(const Json&)>& visit) const {
    for (uint64_t index = 0; index < count_; ++index) {
        const std::optional<Json> record = store_.record(index);
        if (!record) throw std::runtime_error(fmt::format("sample {} is gone; run again", index));
        visit(*record);
    }
}

void Collection::forEachOf(Part part, const std::function<void(const Json&)>& visit) const {
    forEach([&](const Json& record) {
        if (record["part"] == nameOf(part)) visit(record);
    });
}

uint64_t Collection::countOf(Part part) const {
    uint64_t count = 0;
    forEachOf(part, [&](const Json&) { ++count; });
    return count;
}

void Collection::add(const std::string& name, const std::function<void(std::ostream&)>& writer) {
    files_[name] = store_.put(name, [&](const std::filesystem::path& file) {
        std::ofstream out(file, std::ios::binary);
        writer(out);
        out.close();
        if (!out) throw std::runtime_error("cannot write " + file.string());
    });
}

void Collection::write() {
    files_ = Json::object();
    if (title_.format == Format::Coco)
        for (const Part part : parts) writeCoco(part);
    if (title_.format == Format::Yolo) writeYolo();
    if (title_.tracks && hasPictures(title_.format)) writeTracks();
    StatisticsPage page(title_.sweep, classes_);
    forEach([&](const Json& record) { page.add(record, hasPictures(title_.format) ? pictureOf(record) : ""); });
    add("statistics.html", [&](std::ostream& out) { out << page.text(); });
    writeManifest();
    store_.removeLeftovers();
}

void Collection::writeCoco(Part part) {
    if (countOf(part) == 0) return;
    add("instances_" + nameOf(part) + ".json", [&](std::ostream& out) {
        out << R"({"info":{"description":)" << textOf(Json(title_.sweep)) << R"(},"licenses":[],"categories":[)";
        for (size_t i = 0; i < classes_.names().size(); ++i)
            out << (i ? ",\n" : "\n")
                << textOf(Json{{"id", i + 1}, {"name", classes_.names()[i]}, {"supercategory", ""}});
        out << "],\n\"images\":[";
        const char* between = "\n";
        forEachOf(part, [&](const Json& record) {
            out << between << textOf(cocoImage(record));
            between = ",\n";
        });
        out << "],\n\"annotations\":[";
        writeCocoAnnotations(part, out);
        out << "]}\n";
    });
}

void Collection::writeCocoAnnotations(Part part, std::ostream& out) const {
    uint64_t id = 0;
    forEachOf(part, [&](const Json& record) {
        for (const Json& each : record["annotations"]) {
            out << (id ? ",\n" : "\n") << textOf(cocoAnnotation(each, record["index"], id + 1));
            ++id;
        }
    });
}

void Collection::writeYolo() {
    std::string data;  // without a path: the files are in the same folder
    for (const Part part : parts) {
        if (countOf(part) == 0) continue;
        const std::string list = nameOf(part) + ".txt";
        add(list, [&](std::ostream& out) {
            forEachOf(part, [&](const Json& record) { out << "./" << pictureOf(record) << "\n"; });
        });
        data += nameOf(part) + ": " + list + "\n";
    }
    if (countOf(Part::Val) == 0 && countOf(Part::Train) > 0)  // trainers require one
        data += "val: train.txt  # not a part of its own: the sweep's split has no val\n";
    data += "names:\n";
    for (size_t i = 0; i < classes_.names().size(); ++i)
        data += fmt::format("  {}: {}\n", i, textOf(Json(classes_.names()[i])));
    add("data.yaml", [&](std::ostream& out) { out << data; });
}

/** Writes a file per sequence: frame from 1, number of the object from 1, box, 1, class, 1. */
void Collection::writeTracks() {
    std::map<std::string, std::string> lines;  // by file
    forEach([&](const Json& record) {
        const Json& sequence = record["sequence"];
        std::string& text =
            lines[fmt::format("tracks_{:03}_{:03}.txt", sequence[0].get<int>(), sequence[1].get<int>())];
        for (const Json& each : record["annotations"]) {
            // a track has one box per frame
            if (each["shadow"].get<bool>() || each["object"].get<int>() < 0) continue;
            const Json& box = each["bbox"];
            text += fmt::format("{},{},{},{},{},{},1,{},1\n", record["frame"].get<uint64_t>() + 1,
                                each["object"].get<int>() + 1, box[0].get<int>(), box[1].get<int>(), box[2].get<int>(),
                                box[3].get<int>(), each["category"].get<int>());
        }
    });
    for (const auto& [name, text] : lines) add(name, [&](std::ostream& out) { out << text; });
}

void Collection::writeManifest() {
    std::map<std::string, std::string> all;
    std::map<std::string, uint64_t> in_part;
    forEach([&](const Json& record) {
        ++in_part[record["part"].get<std::string>()];
        const std::string name = store_.stemOf(record["index"]) + ".json";
        for (const auto& [file, sum] : record["files"].items()) all[file] = sum;
        all[name] = console::sha256OfFile(store_.folder() / name);
    });
    for (const auto& [name, sum] : files_.items()) all[name] = sum;
    Json manifest{{"version", title_.version},
                  {"deployment", title_.deployment},
                  {"sweep", title_.sweep},
                  {"digest", store_.digest()},
                  {"format", std::string(types::EnumNames<Format>::names[static_cast<size_t>(title_.format)])},
                  {"samples", count_},
                  {"parts", in_part},
                  {"classes", classes_.names()},
                  {"files", all}};
    store_.putText("manifest.json", manifest.dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
}

}  // namespace insonify::dataset
