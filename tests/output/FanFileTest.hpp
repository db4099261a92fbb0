#pragma once
// Recordings of forward-looking sonars, written and read back.
#include <gmock/gmock.h>

#include <fstream>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "components/output/FanFile.hpp"
#include "tests/support/Folder.hpp"
#include "tests/support/RecordedBytes.hpp"
#include "types/ConfigError.hpp"

namespace insonify::output {

using test::RecordedBytes;

class FanFileTest : public testing::Test {
protected:
    explicit FanFileTest(const char* name) : name_(name) {}
    std::filesystem::path write(const RecordedBytes& bytes) const {
        writeBytes(folder_ / name_, bytes);
        return folder_ / name_;
    }
    /** Returns all pings of a file. Sets `notices_`. */
    std::vector<FanFrame> read(const RecordedBytes& bytes) { return readFile(write(bytes)); }
    std::vector<FanFrame> readFile(const std::filesystem::path& path) {
        const auto file = openFan(path);
        std::vector<FanFrame> all;
        for (auto frame = file->next(); frame; frame = file->next()) all.push_back(std::move(*frame));
        notices_ = file->notices();
        return all;
    }
    std::string refusal(const RecordedBytes& bytes) {
        try {
            read(bytes);
        } catch (const types::ConfigError& error) {
            return error.what();
        }
        return "";
    }
    bool isNoticed(const std::string& text) const {
        return std::ranges::any_of(notices_,
                                   [&](const std::string& notice) { return notice.find(text) != notice.npos; });
    }
    /** Damages each byte from `from` on: pings or one error are read. Returns how often a file was refused. */
    size_t refusedOf(const RecordedBytes& good, size_t from) {
        const auto path = write(good);
        std::fstream file(path, std::ios::binary | std::ios::in | std::ios::out);
        const auto put = [&](size_t at, char byte) { file.seekp(static_cast<std::streamoff>(at)).put(byte).flush(); };
        size_t refused = 0;
        for (size_t at = from; at < good.size(); ++at) {
            for (const int flip : {0x01, 0x80, 0xFF}) {
                put(at, static_cast<char>(good[at] ^ flip));
                try {
                    for (const FanFrame& frame : readFile(path)) EXPECT_NO_THROW(frame.ping.validate()) << at;
                } catch (const types::ConfigError& error) {
                    ++refused;
                    EXPECT_EQ(error.diagnostics().size(), 1u);
                    EXPECT_THAT(error.what(), testing::HasSubstr(name_)) << at;
                }
            }
            put(at, good[at]);
        }
        return refused;
    }

    Folder folder_;
    const char* const name_;
    std::vector<std::string> notices_;
};

/** Returns random samples of 8 bits. */
inline RecordedBytes randomSamples(size_t count, std::mt19937& random) {
    RecordedBytes samples(count);
    for (char& sample : samples) sample = static_cast<char>(random());
    return samples;
}

}  // namespace insonify::output
