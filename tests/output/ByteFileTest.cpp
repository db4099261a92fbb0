#include <fcntl.h>
#include <gmock/gmock.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <thread>

#include "components/output/ByteFile.hpp"
#include "tests/support/Folder.hpp"
#include "tests/support/ThreadLimit.hpp"
#include "tests/support/Waiting.hpp"

namespace insonify::output {
namespace {

/** A file whose disk does not take bytes until they are read here: a pipe. */
struct SlowDisk {
    Folder folder;
    std::filesystem::path path = folder / "slow";
    int end = -1;
    SlowDisk() {
        EXPECT_EQ(mkfifo(path.c_str(), 0600), 0);
        end = open(path.c_str(), O_RDONLY | O_NONBLOCK);
    }
    ~SlowDisk() { ::close(end); }
    /** Reads all bytes until the file is closed; returns their number. */
    size_t drain(std::atomic<bool>& closed) const {
        std::vector<char> room(1 << 20);
        size_t total = 0;
        while (true) {
            const ssize_t got = read(end, room.data(), room.size());
            if (got > 0) total += static_cast<size_t>(got);
            if (got == 0 && closed) return total;
            if (got <= 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
    }
};

const std::vector<char> mebibyte(1 << 20, 'x');

TEST(ByteFileTest, ADiskThatStandsStillTakesABoundedNumberOfBytes) {
    const SlowDisk disk;
    ByteFile file(disk.path);
    size_t taken = 0;
    for (int i = 0; i < 1000; ++i) taken += file.tryAppend(mebibyte) ? 1 : 0;
    EXPECT_GE(taken, ByteFile::max_waiting >> 20);
    EXPECT_LE(taken, 1 + 2 * (ByteFile::max_waiting >> 20)) << "those that wait, and those that are being written";
    std::atomic<bool> closed{false};
    size_t read = 0;
    std::thread reader([&] { read = disk.drain(closed); });
    file.append(mebibyte);  // waits
    file.close();
    closed = true;
    reader.join();
    EXPECT_EQ(read, (taken + 1) << 20) << "none is lost";
}

TEST(ByteFileTest, OneCallMayExceedTheBound) {
    const Folder folder;
    ByteFile file(folder / "large");
    const std::vector<char> large(ByteFile::max_waiting + 1);
    EXPECT_TRUE(file.tryAppend(large));
    file.close();
    EXPECT_EQ(std::filesystem::file_size(folder / "large"), large.size());
}

TEST(ByteFileTest, AFailureHasTheSystemsReason) {
    ByteFile file("/dev/full");
    const auto untilItFails = [&] { EXPECT_TRUE(test::becomesTrue([&] { return file.append({'x'}), false; })); };
    EXPECT_THAT(untilItFails, testing::ThrowsMessage<std::runtime_error>(
                                  testing::HasSubstr("/dev/full: cannot be written: No space left on device")));
    EXPECT_THROW(file.tryAppend({'x'}), std::runtime_error);
    EXPECT_THROW(file.close(), std::runtime_error);
}

TEST(ByteFileTest, WithoutAThreadThereIsAnError) {
    const Folder folder;
    const test::ThreadLimit limit(0);
    EXPECT_THROW(ByteFile(folder / "file"), std::runtime_error);
}

}  // namespace
}  // namespace insonify::output
