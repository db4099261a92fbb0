#pragma once
// Recordings, written, damaged and read back.
#include <gmock/gmock.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "tests/support/Folder.hpp"
#include "tests/support/RecordedBytes.hpp"
#include "tests/support/Refused.hpp"

namespace insonify::recordings {

using test::RecordedBytes;

/** Tests of the pings of a `File`, which next() returns one by one. */
template <class File>
struct RecordedFileTest : testing::Test {
    using Opener = std::function<std::unique_ptr<File>(const std::filesystem::path&)>;
    using Ping = typename decltype(std::declval<File&>().next())::value_type;

    RecordedFileTest(const char* name, Opener open) : name_(name), open_(std::move(open)) {}
    std::filesystem::path write(const RecordedBytes& bytes) const {
        writeBytes(folder_ / name_, bytes);
        return folder_ / name_;
    }
    /** Returns all pings of a file. Sets `notices_`. */
    std::vector<Ping> read(const RecordedBytes& bytes) { return readFile(write(bytes)); }
    std::vector<Ping> readFile(const std::filesystem::path& path) {
        const auto file = open_(path);
        std::vector<Ping> all;
        for (auto ping = file->next(); ping; ping = file->next()) all.push_back(std::move(*ping));
        notices_ = file->notices();
        return all;
    }
    std::string refusal(const RecordedBytes& bytes) {
        return test::errorOf<types::ConfigError>([&] { read(bytes); });
    }
    bool isNoticed(const std::string& text) const {
        return std::ranges::any_of(notices_,
                                   [&](const std::string& notice) { return notice.find(text) != notice.npos; });
    }
    /** Damages each byte from `from` on: pings or one error with the file's name and `place` are read. Returns how
     *  often a file was refused. */
    size_t refusedOf(const RecordedBytes& good, size_t from, const std::string& place = "") {
        const auto path = write(good);
        std::fstream file(path, std::ios::binary | std::ios::in | std::ios::out);
        const auto put = [&](size_t at, char byte) { file.seekp(static_cast<std::streamoff>(at)).put(byte).flush(); };
        size_t refused = 0;
        for (size_t at = from; at < good.size(); ++at) {
            for (const int flip : {0x01, 0x80, 0xFF}) {
                put(at, static_cast<char>(good[at] ^ flip));
                try {
                    for (const Ping& one : readFile(path)) EXPECT_NO_THROW(one.ping.validate()) << at;
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
    const Opener open_;
    std::vector<std::string> notices_;
};

/** Returns random samples of 8 bits. */
inline RecordedBytes randomSamples(size_t count, std::mt19937& random) {
    RecordedBytes samples(count);
    for (char& sample : samples) sample = static_cast<char>(random());
    return samples;
}

}  // namespace insonify::recordings
