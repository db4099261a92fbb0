// Data sets in parts, and joined. Samples are records that the tests write; DatasetCommandTest joins rendered ones.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <array>
#include <fstream>
#include <functional>
#include <map>
#include <random>
#include <set>

#include "components/dataset/Collection.hpp"
#include "components/dataset/SampleFiles.hpp"
#include "tests/support/Folder.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::dataset {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;
using testing::IsSupersetOf;

constexpr const char* version = "1.2";

Title getTitle(Format format, std::vector<Member> members) {
    return {version, "d.yml", "sweep.yml", "origin", format, true, false, 2, {"pile", "rock"}, std::move(members)};
}

Member member(uint64_t seed, uint64_t total, std::optional<uint64_t> count = {}) {
    return {seed, total, count, fmt::format("digest {} {}", seed, count.value_or(0))};
}

/** Writes a sample of a few boxes that depends on its digest and number alone. */
void putSample(Store& store, Format format, uint64_t index) {
    std::mt19937_64 random(std::hash<std::string>{}(store.makeStem(index)));
    const std::string stem = store.makeStem(index), picture = stem + (hasPictures(format) ? ".png" : ".npz");
    Json record{{"index", index},
                {"part", std::array{"train", "val", "test"}[random() % 3]},
                {"scene", "harbour.glb"},
                {"sequence", {index % 2, index / 2 % 2}},
                {"frame", index / 4},
                {"settings", {{"sonar.range", 20}}},
                {"picture", {{"width", 100}, {"height", 50}}},
                {"annotations", Json::array()}};
    for (uint64_t i = random() % 4; i-- > 0;)
        record["annotations"].push_back({{"object", i},
                                         {"name", fmt::format("pile_{}", i)},
                                         {"category", 1 + random() % 2},
                                         {"shadow", false},
                                         {"bbox", {i, 1, 9, 4}},
                                         {"area", 36},
                                         {"range_m", {4.0, 8.5}},
                                         {"segmentation", {{"size", {50, 100}}, {"counts", "0"}}}});
    record["files"] = {{picture, store.putText(picture, fmt::format("picture {}", random()))}};
    if (format == Format::Yolo) record["files"][stem + ".txt"] = store.putText(stem + ".txt", "0 0.5 0.5 0.1 0.1\n");
    store.putRecord(index, record);
}

std::string textIn(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

/** Bytes of all files of a folder, by name. */
std::map<std::string, std::string> getFiles(const fs::path& folder) {
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::directory_iterator(folder)) files[entry.path().filename()] = textIn(entry.path());
    return files;
}

struct JoinTest : testing::Test {
    /** Makes those samples of a set whose position in its selection is wanted. */
    fs::path make(const std::string& name, const Title& title, const std::function<bool(uint64_t)>& wanted) const {
        const fs::path folder = folder_ / name;
        fs::create_directories(folder);
        Collection set(title, folder);
        set.describe();
        for (size_t m = 0; m < title.members.size(); ++m)
            for (uint64_t i = 0; i < set.selection(m).size(); ++i)
                if (wanted(i)) putSample(set.store(m), title.format, set.selection(m)[i]);
        if (set.isWhole(true)) set.write();
        return folder;
    }
    fs::path whole(const std::string& name, const Title& title) const {
        return make(name, title, [](uint64_t) { return true; });
    }
    fs::path joined(const std::string& name, const std::vector<fs::path>& folders) const {
        const Parts parts(folders, version);
        fs::create_directories(folder_ / name);
        Collection set(parts.title(), folder_ / name);
        set.describe();
        parts.copyTo(set);
        set.write();
        return folder_ / name;
    }
    static std::string refusal(const std::vector<fs::path>& folders) {
        try {
            const Parts parts(folders, version);
        } catch (const types::ConfigError& error) {
            return error.what();
        }
        return "";
    }

    const Folder folder_;
};

TEST(SelectionTest, DrawsDifferentNumbersThatALargerCountKeeps) {
    std::mt19937_64 random(5);
    for (int i = 0; i < 300; ++i) {
        const uint64_t total = 1 + random() % 200, more = 1 + random() % total, fewer = 1 + random() % more,
                       seed = random();
        const auto numbers = [&](uint64_t count) {
            const Selection drawn(total, count, seed);
            std::vector<uint64_t> all;
            for (uint64_t k = 0; k < drawn.size(); ++k) all.push_back(drawn[k]);
            return all;
        };
        const std::vector<uint64_t> large = numbers(more), small = numbers(fewer);
        ASSERT_EQ(large.size(), more);
        EXPECT_TRUE(std::ranges::is_sorted(large));
        EXPECT_EQ(std::set<uint64_t>(large.begin(), large.end()).size(), more);
        EXPECT_LT(large.back(), total);
        EXPECT_THAT(large, IsSupersetOf(small));
    }
    const Selection few(100'000'000, 3, 1);  // without a list of all
    EXPECT_LT(few[0], few[2]);
}

TEST(SelectionTest, EachNumberIsEquallyLikely) {
    std::map<uint64_t, int> drawn;
    for (uint64_t seed = 1; seed <= 3000; ++seed) {
        const Selection selection(10, 3, seed);
        for (uint64_t k = 0; k < 3; ++k) ++drawn[selection[k]];
    }
    for (uint64_t number = 0; number < 10; ++number) EXPECT_NEAR(drawn[number], 900, 5 * 25.1) << number;  // 5 sigma
}

TEST(SelectionTest, RefusesACountThatTheSweepDoesNotHave) {
    EXPECT_THROW(Selection(24, 0, 1), types::ConfigError);
    EXPECT_THROW(Selection(24, 25, 1), types::ConfigError);
    EXPECT_THROW(Selection(max_samples, max_drawn + 1, 1), types::ConfigError);
    EXPECT_EQ(Selection(24, 24, 1)[23], 23u);
}

TEST_F(JoinTest, ASetThatIsJoinedFromRandomPartsIsTheWholeSetByteForByte) {
    std::mt19937_64 random(7);
    for (int round = 0; round < 30; ++round) {
        const auto format = static_cast<Format>(random() % 5);
        const uint64_t total = 1 + random() % 12;
        const std::optional<uint64_t> count =
            random() % 2 ? std::optional<uint64_t>(1 + random() % total) : std::nullopt;
        const Title title = getTitle(format, {member(random(), total, count)});
        const std::string name = std::to_string(round);
        const fs::path expected = whole(name + "whole", title);
        const size_t parts = 1 + random() % 4;
        std::vector<size_t> owner(total);
        for (size_t& each : owner) each = random() % parts;
        std::vector<fs::path> folders;
        for (size_t part = 0; part < parts; ++part)
            folders.push_back(
                make(fmt::format("{}part{}", name, part), title, [&](uint64_t i) { return owner[i] == part; }));
        std::ranges::shuffle(folders, random);
        EXPECT_EQ(getFiles(joined(name + "joined", folders)), getFiles(expected)) << round;
    }
}

TEST_F(JoinTest, SetsOfOtherSeedsAreJoinedInAnyOrderAndInSteps) {
    const Title one = getTitle(Format::Coco, {member(3, 8)}), two = getTitle(Format::Coco, {member(1, 8, 5)}),
                three = getTitle(Format::Coco, {member(9, 8)});
    const fs::path a = whole("a", one), b = whole("b", two),
                   even = make("even", three, [](uint64_t i) { return i % 2 == 0; }),
                   odd = make("odd", three, [](uint64_t i) { return i % 2 == 1; });
    const auto all = getFiles(joined("all", {a, b, odd, even}));
    EXPECT_EQ(getFiles(joined("other", {even, b, odd, a})), all);
    EXPECT_EQ(getFiles(joined("steps", {odd, joined("ab", {a, b}), even})), all);
    EXPECT_EQ(getFiles(whole("made", getTitle(Format::Coco, {member(1, 8, 5), member(3, 8), member(9, 8)}))), all);
    EXPECT_EQ(Json::parse(all.at("manifest.json"))["samples"], 21);
    EXPECT_TRUE(all.contains("tracks_005_001.txt"));  // scene 1 of the third seed
}

TEST_F(JoinTest, NumbersOfImagesAndAnnotationsAreUniqueOverAllParts) {
    std::mt19937_64 random(11);
    for (int round = 0; round < 10; ++round) {
        std::vector<Member> members;
        for (uint64_t seed = 1; seed <= 1 + random() % 3; ++seed) members.push_back(member(seed, 12));
        const fs::path folder = whole(std::to_string(round), getTitle(Format::Coco, members));
        std::set<uint64_t> images, annotations;
        size_t image_count = 0, annotation_count = 0;
        std::set<std::string> categories, pictures;
        for (const char* part : {"train", "val", "test"}) {
            const fs::path file = folder / fmt::format("instances_{}.json", part);
            if (!fs::exists(file)) continue;
            const Json coco = Json::parse(textIn(file));
            std::set<uint64_t> own;
            for (const Json& image : coco["images"]) {
                own.insert(image["id"].get<uint64_t>()), ++image_count;
                pictures.insert(image["file_name"]);
                EXPECT_TRUE(fs::exists(folder / image["file_name"].get<std::string>()));
            }
            for (const Json& each : coco["annotations"]) {
                EXPECT_TRUE(own.contains(each["image_id"].get<uint64_t>()));
                EXPECT_GT(each["id"], 0);
                annotations.insert(each["id"].get<uint64_t>()), ++annotation_count;
            }
            images.merge(own);
            categories.insert(coco["categories"].dump());
        }
        EXPECT_EQ(images.size(), 12 * members.size());
        EXPECT_EQ(image_count, images.size());
        EXPECT_EQ(pictures.size(), images.size());
        EXPECT_EQ(annotation_count, annotations.size());
        EXPECT_EQ(categories.size(), 1u);
    }
}

TEST_F(JoinTest, PartsThatDoNotFitAreRefused) {
    const Title title = getTitle(Format::Mask, {member(3, 6)});
    const auto is = [](uint64_t rest) { return [=](uint64_t i) { return i % 3 == rest; }; };
    const fs::path a = make("a", title, is(0)), b = make("b", title, is(1)), c = make("c", title, is(2));
    EXPECT_EQ(refusal({a, b, c}), "");
    const auto refused = [&](const char* name, auto change) {
        Title other = title;
        change(other);
        return refusal({a, b, make(name, other, is(2))});
    };
    EXPECT_THAT(
        refused("d", [](Title& other) { other.origin = "2", other.deployment = "e.yml"; }),
        AllOf(HasSubstr("d/dataset.json: origin: another deployment (e.yml), sweep (sweep.yml), scene or --set than "),
              HasSubstr("parts may differ in --shard, --seed and --count")));
    EXPECT_THAT(refused("e", [](Title& other) { other.format = Format::Coco; }),
                HasSubstr("e/dataset.json: format: is coco; that of "));
    EXPECT_THAT(refused("f", [](Title& other) { other.version = "1.1"; }),
                HasSubstr("f/dataset.json: version: is 1.1; this program is 1.2"));
    EXPECT_THAT(refused("g", [](Title& other) { other.members = {member(3, 6, 4)}; }),
                HasSubstr("g/dataset.json: members: samples of seed 3 would be in it twice"));
    EXPECT_THAT(refusal({a, b, c, a}), AllOf(HasSubstr("a/000000_"), HasSubstr("sample 0 of seed 3 is in "),
                                             HasSubstr("a as well; give each sample once")));
    EXPECT_THAT(refusal({a, c}), HasSubstr("2 of 6 samples of seed 3 are in none of the parts, the first is 1"));
    Title other = getTitle(Format::Mask, {member(4, 6)});
    const Title fixed = [&] {
        Title same = title;
        return same.one_seed = true, same;
    }();
    other.one_seed = true;
    EXPECT_THAT(refusal({whole("h", fixed), whole("i", other)}),
                HasSubstr("cannot be joined with seed 4: with each seed the poses are the same"));
}

TEST_F(JoinTest, FoldersThatAreNoSetsOrAreDamagedAreRefused) {
    const Title title = getTitle(Format::Npz, {member(3, 3)});
    const fs::path a = whole("a", title);
    EXPECT_THAT(refusal({a, folder_ / "nowhere"}), HasSubstr("nowhere: has no dataset.json"));
    for (const auto& [name, bytes] : getFiles(a)) {
        if (!name.ends_with(".npz")) continue;
        std::ofstream(a / name) << "other";
        EXPECT_THAT(refusal({a}), HasSubstr("the sample is damaged; make it again: run its shard with this --out"));
        std::ofstream(a / name) << bytes;
        EXPECT_EQ(refusal({a}), "");
    }
    const std::string bytes = textIn(a / "dataset.json");
    std::mt19937_64 random(2);
    for (int i = 0; i < 300; ++i) {
        std::string broken = bytes.substr(0, i % 3 ? bytes.size() : random() % bytes.size());
        if (i % 3) broken[random() % (broken.size() - 1)] ^= static_cast<char>(1 + random() % 255);
        if (Json::parse(broken, nullptr, false) == Json::parse(bytes)) continue;
        std::ofstream(a / "dataset.json") << broken;
        EXPECT_THAT(refusal({a}), HasSubstr("dataset.json: is damaged; run `insonify dataset` with this --out again"));
    }
    const Json wrong = Json::parse(
        R"([5, -1, 0.5, "x", null, [], {}, [[]], [{}], [{"seed": 3, "total": 1e18, "digest": ""}],
            [{"seed": 3, "total": 3, "count": 4, "digest": ""}], [{"seed": 3, "total": 3, "count": 0, "digest": ""}],
            [{"seed": 3, "total": 0, "digest": ""}]])");
    const Json right = Json::parse(bytes);
    for (const auto& [key, value] : right.items())
        for (const Json& other : wrong) {  // a right sum
            Json json = right;
            json.erase("sum"), json[key] = other;
            std::ofstream(a / "dataset.json") << signedText(json);
            const std::string refused = refusal({a});
            const bool is_checked = key == "version" || key == "format" || key == "members";
            EXPECT_TRUE(!is_checked || refused.find("dataset.json: ") != std::string::npos) << key << other << refused;
        }
}

TEST_F(JoinTest, ASampleThatNamesAFileOutsideOfItsFolderIsRefused) {
    const Title title = getTitle(Format::Npz, {member(3, 1)});
    const fs::path a = make("a", title, [](uint64_t) { return false; });
    std::ofstream(folder_ / "other.txt") << "other";  // with the right sum
    Store store(a, title.members[0].digest);
    Json record{{"index", 0}, {"part", "train"}, {"annotations", Json::array()}};
    record["files"] = {{"../other.txt", store.putText(store.makeStem(0) + ".txt", "other")}};
    store.putRecord(0, record);
    EXPECT_THAT(refusal({a}), HasSubstr("the sample is damaged"));
}

}  // namespace
}  // namespace insonify::dataset
