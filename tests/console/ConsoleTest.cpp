#include <fcntl.h>
#include <gmock/gmock.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <sstream>
#include <thread>

#include "components/console/Console.hpp"

namespace insonify::console {
namespace {

using testing::HasSubstr;

/** Puts a file in the place of a standard stream while it exists. */
class Replaced {
public:
    Replaced(int stream, int file) : stream_(stream), before_(dup(stream)) { dup2(file, stream); }
    ~Replaced() { back(); }
    void back() {
        if (before_ < 0) return;
        dup2(before_, stream_);
        close(std::exchange(before_, -1));
    }

private:
    int stream_, before_;
};

/** A pipe, and what has come out of it. */
class Pipe {
public:
    Pipe() {
        if (pipe2(ends_, O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
    }
    ~Pipe() {
        for (int& end : ends_) shut(end);
        if (reader_.joinable()) reader_.join();
    }
    int in() const { return ends_[1]; }
    void closeReader() { shut(ends_[0]); }
    void beginReading() {
        reader_ = std::thread([this] {
            char bytes[4096];
            for (ssize_t count; (count = read(ends_[0], bytes, sizeof bytes)) > 0;)
                text_.append(bytes, static_cast<size_t>(count));
        });
    }
    /** All bytes, once nobody writes any more. */
    std::string text() {
        shut(ends_[1]);
        reader_.join();
        return text_;
    }

private:
    static void shut(int& end) {
        if (end >= 0) close(std::exchange(end, -1));
    }
    int ends_[2] = {-1, -1};
    std::thread reader_;
    std::string text_;
};

double seconds(const auto& work) {
    const auto begin = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

std::vector<std::string> getLines(const std::string& text) {
    std::istringstream stream(text);
    std::vector<std::string> lines;
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
}

TEST(ConsoleTest, APipeThatNobodyReadsHoldsUpNoCallerAndKeepsTheOrder) {
    constexpr int count = 20'000;  // of 100 bytes: more than pipe and queue hold
    Pipe pipe;
    Replaced error(STDERR_FILENO, pipe.in());
    const uint64_t before = droppedDiagnostics();
    startPrinting();
    EXPECT_LT(seconds([] {
                  for (int i = 0; i < count; ++i) printDiagnostic("{:<99}\n", i);
              }),
              5);
    const uint64_t dropped = droppedDiagnostics() - before;
    EXPECT_GT(dropped, 0u);
    EXPECT_LT(dropped, uint64_t{count} - 2000) << "64 KiB and 256 KiB are kept";
    pipe.beginReading();
    finishPrinting();
    printDiagnostic("the end\n");  // prints on this thread
    error.back();
    std::vector<std::string> lines = getLines(pipe.text());
    ASSERT_FALSE(lines.empty());
    EXPECT_EQ(lines.back(), "the end");
    lines.pop_back();
    uint64_t next = 0, missing = 0;  // once, or again if the thread of the console began late
    for (const std::string& line : lines) {
        const std::string_view note = "insonify: ";
        if (line.starts_with(note)) {
            ASSERT_THAT(line, HasSubstr(" lines are missing here"));
            const uint64_t number = std::stoull(line.substr(note.size()));
            missing += number;
            next += number;
        } else {
            ASSERT_EQ(std::stoull(line), next++);
        }
    }
    EXPECT_EQ(missing, dropped);
    EXPECT_EQ(next, uint64_t{count});
}

TEST(ConsoleTest, WhatCannotBeWrittenIsCountedAndThrowsNothing) {
    std::signal(SIGPIPE, SIG_IGN);
    for (const bool has_thread : {false, true}) {
        Pipe closed;
        closed.closeReader();
        const int full = open("/dev/full", O_WRONLY | O_CLOEXEC);
        for (const int file : {closed.in(), full}) {
            const Replaced error(STDERR_FILENO, file);
            if (has_thread) startPrinting();
            const uint64_t before = droppedDiagnostics();
            for (int i = 0; i < 3; ++i) printDiagnostic("lost {}\n", i);
            finishPrinting();
            EXPECT_EQ(droppedDiagnostics(), before + 3) << has_thread;
        }
        close(full);
    }
}

TEST(ConsoleTest, ResultsFollowTheDiagnosticsBeforeThem) {
    Pipe both;
    both.beginReading();
    {
        const Replaced error(STDERR_FILENO, both.in()), out(STDOUT_FILENO, both.in());
        startPrinting();
        for (int i = 0; i < 500; ++i) {
            printDiagnostic("{}\n", 2 * i);
            printResult("{}\n", 2 * i + 1);
            EXPECT_EQ(flushResults(), "");
        }
        finishPrinting();
    }
    const std::vector<std::string> lines = getLines(both.text());
    size_t number = 0;
    for (const std::string& line : lines)
        if (line.find("missing") == line.npos) {  // of the tests before
            EXPECT_EQ(line, std::to_string(number++));
        }
    EXPECT_EQ(number, 1000u);
}

TEST(ConsoleTest, ResultsThatCannotBeWrittenAreOneErrorWithItsReason) {
    const int full = open("/dev/full", O_WRONLY | O_CLOEXEC);
    {
        const Replaced out(STDOUT_FILENO, full);
        for (int i = 0; i < 5000; ++i) printResult("{:<99}\n", i);
        EXPECT_EQ(flushResults(), "No space left on device");
    }
    close(full);
    EXPECT_EQ(flushResults(), "");
}

TEST(ConsoleTest, WaitsForANonBlockingPipeInsteadOfLosingResults) {
    Pipe pipe;
    fcntl(pipe.in(), F_SETFL, O_NONBLOCK);
    std::string reason;
    {
        const Replaced out(STDOUT_FILENO, pipe.in());
        std::thread late([&] {
            std::this_thread::sleep_for(std::chrono::milliseconds(50));
            pipe.beginReading();
        });
        for (int i = 0; i < 3000; ++i) printResult("{:<99}\n", i);
        reason = flushResults();
        late.join();
    }
    EXPECT_EQ(reason, "");
    EXPECT_EQ(getLines(pipe.text()).size(), 3000u);
}

TEST(ConsoleTest, AProgressLineIsWipedBeforeADiagnostic) {
    Pipe pipe;
    pipe.beginReading();
    {
        const Replaced error(STDERR_FILENO, pipe.in());
        showProgress("1 of 2");
        printDiagnostic("a warning\n");
        showProgress("2 of 2");
        showProgress("");
    }
    EXPECT_THAT(pipe.text(), testing::EndsWith("\r\033[K1 of 2\r\033[Ka warning\n\r\033[K2 of 2\r\033[K"));
}

}  // namespace
}  // namespace insonify::console
