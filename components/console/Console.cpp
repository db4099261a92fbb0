#include "components/console/Console.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <mutex>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>

#include "types/Thread.hpp"
#include "types/text/DidYouMean.hpp"

namespace insonify::console {
namespace {

constexpr size_t max_waiting = 256 << 10, results_at_once = 64 << 10;  // [B]
constexpr std::chrono::seconds patience{10};                           // without a byte
constexpr std::string_view wipe = "\r\033[K";

/** Writes all of a text; returns the error, 0: none. */
int writeAll(int file, std::string_view text) {
    while (!text.empty()) {
        const ssize_t written = ::write(file, text.data(), text.size());
        if (written >= 0) {
            text.remove_prefix(static_cast<size_t>(written));
        } else if (errno == EAGAIN) {  // another program has made the pipe or terminal non-blocking
            pollfd ready{file, POLLOUT, 0};
            poll(&ready, 1, -1);
        } else if (errno != EINTR) {
            return errno;
        }
    }
    return 0;
}

/** Whether the standard error is the journal of systemd, which takes the priority of a line from its beginning. */
bool isJournal() {
    const char* const journal = std::getenv("JOURNAL_STREAM");
    struct stat error {};
    return journal && fstat(STDERR_FILENO, &error) == 0 &&
           std::to_string(error.st_dev) + ":" + std::to_string(error.st_ino) == journal;
}

/** Returns a text with the priority of each line, as in sd-daemon(3): "<4>warning: ...". A line that begins with a
 * space continues the one before. */
std::string withPriorities(const std::string& text) {
    std::string lines, priority = "<3>";
    for (size_t begin = 0; begin < text.size();) {
        const size_t end = std::min(text.find('\n', begin), text.size() - 1) + 1;
        const std::string_view line = std::string_view(text).substr(begin, end - begin);
        if (!line.starts_with(' '))
            priority = line.starts_with("notice: ")                                  ? "<5>"
                       : line.starts_with("warning: ") || line.starts_with("lost: ") ? "<4>"
                                                                                     : "<3>";
        lines.append(priority).append(line);
        begin = end;
    }
    return lines;
}

/** The queue of diagnostics and the text of results. Never destroyed: its thread may wait for a console when the
 * process ends. */
class Console {
public:
    void start() {
        const std::lock_guard lock(mutex_);
        if (!thread_.joinable()) thread_ = types::startThread("the console", [this] { loop(); });
    }

    void finish() {
        std::unique_lock lock(mutex_);
        settle(lock);
        if (!thread_.joinable() || pending()) return;
        ending_ = true;
        work_.notify_one();
        std::thread ended = std::move(thread_);  // from here on, callers print
        lock.unlock();
        ended.join();
        lock.lock();
        ending_ = false;
    }

    void diagnostic(std::string_view text) {
        const std::lock_guard lock(mutex_);
        if (waiting_size_ + text.size() > max_waiting) return drop();
        if (const uint64_t missing = std::exchange(missing_, 0); missing > 0)
            add({"insonify: " + std::to_string(missing) + " lines are missing here, the console did not take them\n",
                 missing});
        add({std::string(text), 0});
    }

    void progress(std::string_view text) {
        const std::lock_guard lock(mutex_);
        progress_ = text;
        thread_.joinable() ? work_.notify_one() : writeProgress(*std::exchange(progress_, std::nullopt));
    }

    void result(std::string_view text) {
        std::unique_lock lock(mutex_);
        settle(lock);
        results_ += text;
        if (results_.size() > results_at_once || isatty(STDOUT_FILENO)) writeResults();
    }

    std::string flush() {
        std::unique_lock lock(mutex_);
        settle(lock);
        writeResults();
        return result_error_ == 0 ? "" : std::generic_category().message(std::exchange(result_error_, 0));
    }

    void dropOne() {
        const std::lock_guard lock(mutex_);
        drop();
    }

    uint64_t dropped() {
        const std::lock_guard lock(mutex_);
        return dropped_;
    }

private:
    struct Text {
        std::string text;
        uint64_t missing;  ///< Texts that it reports as missing; 0: it is a diagnostic.
    };

    bool pending() const { return !waiting_.empty() || progress_ || is_writing_; }

    /** Waits until the thread has written all, or the console takes no more. */
    void settle(std::unique_lock<std::mutex>& lock) {
        while (thread_.joinable() && pending()) {
            const uint64_t seen = written_;
            const auto limit = is_stuck_ ? std::chrono::seconds(0) : patience;
            is_stuck_ = !done_.wait_for(lock, limit, [&] { return !pending() || written_ != seen; });
            if (is_stuck_) return;
        }
    }

    void drop() {
        ++missing_;
        ++dropped_;
    }

    void add(Text text) {
        if (!thread_.joinable()) return noteWritten(text, write(text));
        waiting_size_ += text.text.size();
        waiting_.push_back(std::move(text));
        work_.notify_one();
    }

    /** Returns whether the console has taken it. */
    bool write(const Text& text) {
        const std::string before(has_progress_ ? wipe : "");
        has_progress_ = false;
        return writeAll(STDERR_FILENO, before + (is_journal_ ? withPriorities(text.text) : text.text)) == 0;
    }

    void noteWritten(const Text& text, bool is_written) {
        ++written_;
        if (is_written) return;
        missing_ += std::max<uint64_t>(text.missing, 1);
        if (text.missing == 0) ++dropped_;
    }

    void writeProgress(const std::string& text) {
        has_progress_ = !text.empty();
        writeAll(STDERR_FILENO, std::string(wipe) + text);
    }

    void writeResults() {
        const int error = writeAll(STDOUT_FILENO, results_);
        if (result_error_ == 0) result_error_ = error;
        results_.clear();
    }

    void loop() {
        std::unique_lock lock(mutex_);
        while (true) {
            work_.wait(lock, [this] { return ending_ || progress_ || !waiting_.empty(); });
            is_writing_ = true;
            if (!waiting_.empty()) {
                const Text text = std::move(waiting_.front());
                waiting_.pop_front();
                lock.unlock();
                const bool is_written = write(text);
                lock.lock();
                waiting_size_ -= text.text.size();
                noteWritten(text, is_written);
            } else if (const auto text = std::exchange(progress_, std::nullopt)) {
                lock.unlock();
                writeProgress(*text);
                lock.lock();
            } else {
                is_writing_ = false;
                return;
            }
            is_writing_ = false;
            done_.notify_all();
        }
    }

    const bool is_journal_ = isJournal();
    std::mutex mutex_;
    std::condition_variable work_, done_;
    std::thread thread_;
    std::deque<Text> waiting_;
    size_t waiting_size_ = 0;              ///< With the text that is being written [B].
    std::optional<std::string> progress_;  ///< To be shown next; only the newest matters.
    bool has_progress_ = false;            ///< On the terminal's last line.
    bool is_writing_ = false, ending_ = false, is_stuck_ = false;
    uint64_t written_ = 0;                ///< Texts so far.
    uint64_t missing_ = 0, dropped_ = 0;  ///< Texts since the last report of them, and in all.
    std::string results_;
    int result_error_ = 0;
};

Console& console() {
    static Console* const console = new Console;
    return *console;
}

/** Calls a function of the console; what it throws, for lack of memory or threads, is one text less. */
template <class F>
void guarded(F&& function) noexcept try {
    function(console());
} catch (...) {
    dropText();
}

}  // namespace

void prepareConsole() noexcept {
    std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGXFSZ, SIG_IGN);
    for (const int file : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
        if (fcntl(file, F_GETFD) < 0 && errno == EBADF)
            open("/dev/null", file == STDERR_FILENO ? O_WRONLY : O_RDONLY);  // results must not vanish without an error
}

void startPrinting() noexcept try { console().start(); } catch (...) {
    // Without a thread, callers print.
}

void finishPrinting() noexcept {
    guarded([](Console& all) { all.finish(); });
}

void addResult(std::string_view text) noexcept {
    guarded([&](Console& all) { all.result(text); });
}

std::string flushResults() noexcept try { return console().flush(); } catch (...) {
    return "no memory";
}

void addDiagnostic(std::string_view text) noexcept {
    guarded([&](Console& all) { all.diagnostic(text); });
}

void showProgress(std::string_view text) noexcept {
    guarded([&](Console& all) { all.progress(text); });
}

void dropText() noexcept try { console().dropOne(); } catch (...) {
    // Not even a mutex is left to count it with.
}

uint64_t droppedDiagnostics() noexcept try { return console().dropped(); } catch (...) {
    return 0;
}

std::string shellWord(const std::string& text) {
    const auto isPlain = [](char c) {
        return types::isLetter(c) || types::isDigit(c) || static_cast<unsigned char>(c) >= 0x80 ||
               std::strchr("/._-+,:@%", c);
    };
    if (!text.empty() && std::ranges::all_of(text, isPlain)) return text;
    std::string word = "'";
    for (const char c : text) word += c == '\'' ? "'\\''" : std::string(1, c);
    return word + "'";
}

}  // namespace insonify::console
