#include "components/dataset/Collection.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <stdexcept>
#include <utility>

#include "components/dataset/SampleFiles.hpp"
#include "components/dataset/StatisticsPage.hpp"
#include "types/text/ConfigError.hpp"
#include "types/text/Sha256.hpp"

namespace insonify::dataset {
namespace {

namespace fs = std::filesystem;

constexpr Part parts[] = {Part::Train, Part::Val, Part::Test};

template <class Enum>
std::string getName(Enum value) {
    return std::string(types::EnumNames<Enum>::names[static_cast<size_t>(value)]);
}

/** Returns the digests of the members of a set. */
std::vector<std::string> getDigests(const Title& title) {
    std::vector<std::string> all;
    for (const Member& member : title.members) all.push_back(member.digest);
    return all;
}

/** Returns the picture file of a sample. */
std::string makePicture(const Json& record) {
    for (const auto& [name, sum] : record["files"].items())
        if (name.ends_with(".png") && !name.ends_with("_instances.png") && !name.ends_with("_classes.png")) return name;
    throw std::runtime_error("a sample has no picture");
}

Json cocoImage(const Json& record, uint64_t id) {
    return {{"id", id},
            {"file_name", makePicture(record)},
            {"width", record["picture"]["width"]},
            {"height", record["picture"]["height"]}};
}

Json cocoAnnotation(const Json& each, uint64_t image, uint64_t id) {
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

std::string Title::text() const {
    Json json{{"version", version},        {"deployment", deployment}, {"sweep", sweep},       {"origin", origin},
              {"format", getName(format)}, {"tracks", tracks},         {"one_seed", one_seed}, {"scenes", scenes},
              {"classes", classes},        {"members", Json::array()}};
    for (const Member& member : members) {
        Json& added = json["members"].emplace_back(Json{{"seed", member.seed}, {"total", member.total}});
        if (member.count) added["count"] = *member.count;
        added["digest"] = member.digest;
    }
    return signedText(std::move(json));
}

Title Title::read(const fs::path& folder, const std::string& version) {
    const fs::path file = folder / description_file;
    if (!fs::exists(file))
        throw types::ConfigError(folder, "",
                                 fmt::format("has no {}, which `insonify dataset` writes with the first sample; give "
                                             "its --out",
                                             description_file));
    const std::optional<Json> json = readSigned(file);
    const types::ConfigError damaged(file, "", "is damaged; run `insonify dataset` with this --out again");
    if (!json) throw damaged;
    try {
        Title title;
        const auto read = [&](const char* key, auto& value) { json->at(key).get_to(value); };
        read("version", title.version);
        if (title.version != version)
            throw types::ConfigError(file, "version",
                                     fmt::format("is {}; this program is {}: join sets with the version that made them",
                                                 title.version, version));
        read("deployment", title.deployment), read("sweep", title.sweep), read("origin", title.origin);
        read("tracks", title.tracks), read("one_seed", title.one_seed), read("scenes", title.scenes);
        read("classes", title.classes);
        const auto& formats = types::EnumNames<Format>::names;
        const auto* const format = std::ranges::find(formats, json->at("format").get<std::string>());
        if (format == std::end(formats)) throw damaged;
        title.format = static_cast<Format>(format - std::begin(formats));
        for (const Json& each : json->at("members")) {
            Member& member = title.members.emplace_back();
            each.at("seed").get_to(member.seed), each.at("total").get_to(member.total);
            each.at("digest").get_to(member.digest);
            if (each.contains("count")) member.count = each.at("count").get<uint64_t>();
            if (member.total > max_samples || member.count.value_or(1) - 1 >= member.total) throw damaged;
        }
        if (title.members.empty()) throw damaged;
        return title;
    } catch (const Json::exception&) {
        throw damaged;
    }
}

Collection::Collection(Title title, const fs::path& folder) : title_(std::move(title)) {
    for (const Member& member : title_.members) {
        stores_.emplace_back(folder, member.digest, getDigests(title_));
        selections_.push_back(member.selection());
    }
}

void Collection::describe() { stores_[0].putText(description_file, title_.text()); }

bool Collection::isWhole(bool closely, const std::set<uint64_t>& known) const {
    for (size_t member = 0; member < stores_.size(); ++member)
        for (uint64_t i = 0; i < selections_[member].size(); ++i) {
            const Store& store = stores_[member];
            const uint64_t index = selections_[member][i];
            if (known.contains(index)) continue;
            if (!(closely ? store.has(index) : fs::exists(store.folder() / (store.makeStem(index) + ".json"))))
                return false;
        }
    return true;
}

bool Collection::Listed::isInPart(Part part) const { return record["part"] == getName(part); }

void Collection::forEach(const std::function<void(const Listed&)>& visit) const {
    uint64_t number = 0;
    for (size_t member = 0; member < stores_.size(); ++member)
        for (uint64_t i = 0; i < selections_[member].size(); ++i, ++number) {
            const std::optional<Json> record = stores_[member].record(selections_[member][i]);
            if (!record) throw std::runtime_error(fmt::format("sample {} is gone; run again", selections_[member][i]));
            visit({number, member, *record});
        }
}

void Collection::forEachIn(Part part, const std::function<void(const Listed&)>& visit) const {
    forEach([&](const Listed& sample) {
        if (sample.isInPart(part)) visit(sample);
    });
}

uint64_t Collection::countEach(Part part) const {
    uint64_t count = 0;
    forEachIn(part, [&](const Listed&) { ++count; });
    return count;
}

void Collection::add(const std::string& name, const std::function<void(std::ostream&)>& writer) {
    files_[name] = stores_[0].put(name, [&](const std::filesystem::path& file) {
        std::ofstream out(file, std::ios::binary);
        writer(out);
        out.close();
        if (!out) throw std::runtime_error("cannot write " + file.string());
    });
}

void Collection::write() {
    files_ = {{description_file, stores_[0].putText(description_file, title_.text())}};
    if (title_.format == Format::Coco)
        for (const Part part : parts) writeCoco(part);
    if (title_.format == Format::Yolo) writeYolo();
    if (title_.tracks && hasPictures(title_.format)) writeTracks();
    StatisticsPage page(title_.sweep, title_.classes);
    forEach([&](const Listed& sample) {
        page.add(sample.record, hasPictures(title_.format) ? makePicture(sample.record) : "");
    });
    add("statistics.html", [&](std::ostream& out) { out << page.text(); });
    writeManifest();
    stores_[0].removeLeftovers();
}

void Collection::writeCoco(Part part) {
    if (countEach(part) == 0) return;
    add("instances_" + getName(part) + ".json", [&](std::ostream& out) {
        out << R"({"info":{"description":)" << toText(Json(title_.sweep)) << R"(},"licenses":[],"categories":[)";
        for (size_t i = 0; i < title_.classes.size(); ++i)
            out << (i ? ",\n" : "\n")
                << toText(Json{{"id", i + 1}, {"name", title_.classes[i]}, {"supercategory", ""}});
        out << "],\n\"images\":[";
        const char* between = "\n";
        forEachIn(part, [&](const Listed& sample) {
            out << between << toText(cocoImage(sample.record, sample.number));
            between = ",\n";
        });
        out << "],\n\"annotations\":[";
        writeCocoAnnotations(part, out);
        out << "]}\n";
    });
}

/** Writes the annotations of a part. They are numbered over all parts, so that parts may be put together. */
void Collection::writeCocoAnnotations(Part part, std::ostream& out) const {
    uint64_t id = 0;
    const char* between = "\n";
    forEach([&](const Listed& sample) {
        for (const Json& each : sample.record["annotations"]) {
            ++id;
            if (!sample.isInPart(part)) continue;
            out << between << toText(cocoAnnotation(each, sample.number, id));
            between = ",\n";
        }
    });
}

void Collection::writeYolo() {
    std::string data;  // without a path: the files are in the same folder
    for (const Part part : parts) {
        if (countEach(part) == 0) continue;
        const std::string list = getName(part) + ".txt";
        add(list, [&](std::ostream& out) {
            forEachIn(part, [&](const Listed& sample) { out << "./" << makePicture(sample.record) << "\n"; });
        });
        data += getName(part) + ": " + list + "\n";
    }
    if (countEach(Part::Val) == 0 && countEach(Part::Train) > 0)  // trainers require one
        data += "val: train.txt  # not a part of its own: no pose is drawn for val\n";
    data += "names:\n";
    for (size_t i = 0; i < title_.classes.size(); ++i)
        data += fmt::format("  {}: {}\n", i, toText(Json(title_.classes[i])));
    add("data.yaml", [&](std::ostream& out) { out << data; });
}

/** Writes a file per sequence: frame from 1, number of the object from 1, box, 1, class, 1. Scenes of a further member
 *  have the next numbers. */
void Collection::writeTracks() {
    std::map<std::string, std::string> lines;  // by file
    forEach([&](const Listed& sample) {
        const Json& record = sample.record;
        const Json& sequence = record["sequence"];
        std::string& text =
            lines[fmt::format("tracks_{:03}_{:03}.txt", sequence[0].get<uint64_t>() + sample.member * title_.scenes,
                              sequence[1].get<uint64_t>())];
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
    uint64_t samples = 0;
    forEach([&](const Listed& sample) {
        const Json& record = sample.record;
        const Store& store = stores_[sample.member];
        ++samples, ++in_part[record["part"].get<std::string>()];
        const std::string name = store.makeStem(record["index"]) + ".json";
        for (const auto& [file, sum] : record["files"].items()) all[file] = sum;
        all[name] = types::sha256OfFile(store.folder() / name);
    });
    for (const auto& [name, sum] : files_.items()) all[name] = sum;
    const std::vector<std::string> digests = getDigests(title_);
    Json manifest{
        {"version", title_.version},
        {"deployment", title_.deployment},
        {"sweep", title_.sweep},
        {"digest", digests.size() == 1 ? digests[0] : types::sha256(fmt::format("{}", fmt::join(digests, "\n")))},
        {"format", getName(title_.format)},
        {"samples", samples},
        {"parts", in_part},
        {"classes", title_.classes},
        {"files", all}};
    stores_[0].putText("manifest.json", manifest.dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
}

Parts::Parts(std::vector<fs::path> folders, const std::string& version) : folders_(std::move(folders)) {
    for (size_t i = 0; i < folders_.size(); ++i) {
        titles_.push_back(Title::read(folders_[i], version));
        if (i == 0)
            title_ = titles_[0];
        else
            add(titles_[i], i);
    }
    std::ranges::sort(title_.members, {}, &Member::seed);
    if (title_.one_seed && title_.members.size() > 1)
        throw types::ConfigError(
            folders_[0], "",
            fmt::format(
                "cannot be joined with seed {}: with each seed the poses are the same, but their parts are not, "
                "so that what trains would be tested; give random poses, or a split of one part",
                title_.members[1].seed));
    find();
}

/** Adds the members of another part. */
void Parts::add(const Title& other, size_t folder) {
    const std::string file = folders_[folder] / description_file, first = folders_[0];
    if (other.format != title_.format)
        throw types::ConfigError(
            file, "format",
            fmt::format("is {}; that of {} is {}", getName(other.format), first, getName(title_.format)));
    if (other.origin != title_.origin)
        throw types::ConfigError(file, "origin",
                                 fmt::format("another deployment ({}), sweep ({}), scene or --set than {} ({}, {}); "
                                             "parts may differ in --shard, --seed and --count",
                                             other.deployment, other.sweep, first, title_.deployment, title_.sweep));
    for (const Member& member : other.members) {
        const auto known = std::ranges::find(title_.members, member.seed, &Member::seed);
        if (known == title_.members.end())
            title_.members.push_back(member);
        else if (known->digest != member.digest)
            throw types::ConfigError(
                file, "members",
                fmt::format("samples of seed {} would be in it twice: there are {} by --count or the sweep, and {} in "
                            "another part; give one --count, or other seeds",
                            member.seed, member.selection().size(), known->selection().size()));
    }
}

/** Finds the folder of each sample, and reads its files. */
void Parts::find() {
    for (const Member& member : title_.members) {
        const Selection selection = member.selection();
        std::map<uint64_t, const fs::path*>& places = places_.emplace_back();
        for (size_t i = 0; i < folders_.size(); ++i) {
            const std::vector<std::string> digests = getDigests(titles_[i]);
            if (std::ranges::count(digests, member.digest) == 0) continue;
            const Store store(folders_[i], member.digest, digests);
            for (const uint64_t index : store.recorded()) {
                const fs::path record = folders_[i] / (store.makeStem(index) + ".json");
                if (!selection.contains(index) || !store.has(index))
                    throw types::ConfigError(record, "",
                                             "the sample is damaged; make it again: run its shard with this --out");
                if (const auto [place, is_new] = places.emplace(index, &folders_[i]); !is_new)
                    throw types::ConfigError(record, "",
                                             fmt::format("sample {} of seed {} is in {} as well; give each sample once",
                                                         index, member.seed, place->second->string()));
            }
        }
        uint64_t whole = 0;  // samples before the first that is missing
        while (whole < selection.size() && places.contains(selection[whole])) ++whole;
        if (whole < selection.size())
            throw types::ConfigError(
                "", "dataset join",
                fmt::format("{} of {} samples of seed {} are in none of the parts, the first is {}; "
                            "make them by their --shard, and name its folder",
                            selection.size() - places.size(), selection.size(), member.seed, selection[whole]));
    }
}

void Parts::copyTo(Collection& set) const {
    for (size_t member = 0; member < title_.members.size(); ++member) {
        Store& store = set.store(member);
        for (const auto& [index, folder] : places_[member]) {
            if (store.has(index)) continue;
            const fs::path& from = *folder;
            const auto copy = [&](const std::string& name) {
                return store.put(name, [&](const fs::path& to) { fs::copy_file(from / name, to); });
            };
            const std::string record = store.makeStem(index) + ".json";
            const std::optional<Json> read = readSigned(from / record);
            bool is_same = read.has_value();
            const Json files = is_same ? read->at("files") : Json::object();
            for (const auto& [name, sum] : files.items()) is_same &= sum == copy(name);
            if (!is_same) throw std::runtime_error(fmt::format("{} has changed; join again", (from / record).string()));
            copy(record);
        }
    }
}

}  // namespace insonify::dataset
