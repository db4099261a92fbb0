#pragma once
// Recordings, written, damaged and read back.
#include <gmock/gmock.h>

#include <algorithm>
#include <fstream>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "components/recordings/RecordingReader.hpp"
#include "tests/support/Folder.hpp"
#include "tests/support/RecordedBytes.hpp"
#include "tests/support/Refused.hpp"

namespace insonify::recordings {

using test::RecordedBytes;

/** Tests of the pings of files of one format, which are recognised by their content. */
struct RecordedFileTest : testing::Test {
    explicit RecordedFileTest(const char* name) : name_(name) {}
    std::filesystem::path write(const RecordedBytes& bytes) const {
        writeBytes(folder_ / name_, bytes);
        return folder_ / name_;
    }
    /** Returns all pings of a file; none where it is refused for having none. Sets `notices_`. */
    std::vector<RecordedPing> read(const RecordedBytes& bytes) { return readFile(write(bytes)); }
    std::vector<RecordedPing> readFile(const std::filesystem::path& path) {
        const auto reader = RecordingReader::open(path);
        std::vector<RecordedPing> all;
        try {
            for (auto ping = reader->next(); ping; ping = reader->next()) all.push_back(std::move(*ping));
        } catch (const types::ConfigError& error) {
            if (std::string(error.what()).find("holds no ping of ") == std::string::npos) throw;
        }
        notices_ = reader->notices();
        return all;
    }
    std::string refusal(const RecordedBytes& bytes) {
        return test::computeError<types::ConfigError>([&] { read(bytes); });
    }
    bool isNoticed(const std::string& text) const {
        return std::ranges::any_of(notices_,
                                   [&](const std::string& notice) { return notice.find(text) != notice.npos; });
    }
    /** Damages each byte from `from` on: pings or one error with the file's name and `place` are read. Returns how
     *  often a file was refused. */
    size_t countRefused(const RecordedBytes& good, size_t from, const std::string& place = "") {
        const auto path = write(good);
        std::fstream file(path, std::ios::binary | std::ios::in | std::ios::out);
        const auto put = [&](size_t at, char byte) { file.seekp(static_cast<std::streamoff>(at)).put(byte).flush(); };
        size_t refused = 0;
        for (size_t at = from; at < good.size(); ++at) {
            for (const int flip : {0x01, 0x80, 0xFF}) {
                put(at, static_cast<char>(good[at] ^ flip));
                try {
                    for (const RecordedPing& one : readFile(path)) EXPECT_NO_THROW(one.ping.validate()) << at;
                } catch (const types::ConfigError& error) {
                    ++refused;
                    EXPECT_EQ(error.diagnostics().size(), 1u);
                    EXPECT_THAT(error.what(), testing::HasSubstr(name_ + place)) << at;
                }
            }
            put(at, good[at]);
        }
        return refused;
    }

    Folder folder_;
    const std::string name_;
    std::vector<std::string> notices_;
};

/** Returns random samples of 8 bits. */
inline RecordedBytes randomSamples(size_t count, std::mt19937& random) {
    RecordedBytes samples(count);
    for (char& sample : samples) sample = static_cast<char>(random());
    return samples;
}

}  // namespace insonify::recordings
