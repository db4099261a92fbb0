#pragma once
// Files of side-scans, written and read back.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "components/output/SideScanFile.hpp"
#include "tests/support/Folder.hpp"
#include "types/ConfigError.hpp"

namespace insonify::output {

class SideScanFileTest : public testing::Test {
protected:
    explicit SideScanFileTest(const char* name) : name_(name) {}
    virtual std::unique_ptr<SideScanFile> open(const std::filesystem::path& path) const { return openSideScan(path); }
    std::filesystem::path write(const std::vector<char>& bytes) const {
        const auto path = folder_ / name_;
        std::ofstream(path, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
        return path;
    }
    /** Returns all lines of a file. Sets `notices_`. */
    std::vector<SideScanLine> read(const std::vector<char>& bytes) { return readFile(write(bytes)); }
    std::vector<SideScanLine> readFile(const std::filesystem::path& path) {
        const auto file = open(path);
        std::vector<SideScanLine> all;
        for (auto line = file->next(); line; line = file->next()) all.push_back(*line);
        notices_ = file->notices();
        return all;
    }
    std::string refusal(const std::vector<char>& bytes) {
        try {
            read(bytes);
        } catch (const types::ConfigError& error) {
            return error.what();
        }
        return "";
    }

    Folder folder_;
    const char* const name_;
    std::vector<std::string> notices_;
};

}  // namespace insonify::output
