#pragma once
// What the tests of `insonify dataset` share.
#include <gtest/gtest.h>

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "tests/dataset/HarbourDeployment.hpp"
#include "tests/deployer/Command.hpp"
#include "tests/support/Paths.hpp"

namespace insonify::dataset {

/** A folder with a deployment of a small sonar in the harbour, and a sweep of it. */
struct DatasetFolder : testing::Test {
    using json = deployer::json;
    using Outcome = deployer::Outcome;

    inline static const std::filesystem::path root = test::source_dir;
    inline static const std::string sweep = R"(seed: 3
poses:
  random: {count: 4, x: {uniform: [0, 20]}, y: {uniform: [-8, 0]}, z: -5.5, yaw_deg: {uniform: [-60, 30]}}
settings:
  sonar.range: [20, 30]
objects:
  - {names: [rock_00*], count: [2, 8], x: [4, 20], y: [-8, 4], frame: vehicle, ground: sea_floor, avoid: [quay_wall, hull, pile_*]}
classes: {pile: pile_*, wreck: hull, rock: rock_*, pipeline: [pipeline, saddle_*]}
split: {train: 0.5, val: 0.5, test: 0}
picture: {height: 200}
annotations: {min_pixels: 30}
)";

    /** Bytes of all files of a folder, by name. */
    static std::map<std::string, std::string> getFiles(const std::filesystem::path& folder) {
        std::map<std::string, std::string> files;
        for (const auto& entry : std::filesystem::directory_iterator(folder))
            files[entry.path().filename()] = deployer::readFile(entry.path());
        return files;
    }

    static std::vector<std::string> getNames(const std::filesystem::path& folder) {
        std::vector<std::string> names;
        for (const auto& [name, bytes] : getFiles(folder)) names.push_back(name);
        return names;
    }

    static std::string replaced(std::string text, const std::string& old, const std::string& by) {
        return text.replace(text.find(old), old.size(), by);
    }

    DatasetFolder() {
        deployer::writeFile(folder_ / "d.yml", deployment);
        deployer::writeFile(folder_ / "sweep.yml", sweep);
    }
    std::vector<std::string> words(const std::string& out, std::vector<std::string> more = {}) const {
        std::vector<std::string> all = {"dataset", "d.yml", "--sweep", "sweep.yml", "--out", out};
        all.insert(all.end(), more.begin(), more.end());
        return all;
    }
    Outcome make(const std::string& out, std::vector<std::string> more = {}) const {
        return deployer::callInsonify(folder_, words(out, std::move(more)));
    }
    json makeRecord(const std::string& out, const std::string& index) const {
        for (const auto& [name, bytes] : getFiles(folder_ / out))
            if (name.starts_with(index) && name.ends_with(".json")) return json::parse(bytes);
        return {};
    }

    const deployer::TestFolder folder_;
};

}  // namespace insonify::dataset
