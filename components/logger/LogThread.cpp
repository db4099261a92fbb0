#include "components/logger/LogThread.hpp"

#include <algorithm>
#include <iterator>
#include <map>
#include <utility>

#include "components/log/Files.hpp"
#include "types/Thread.hpp"
#include "types/Time.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::logger {
namespace {

/** Returns the files that follow `log` from an earlier run by their number, also after missing numbers. */
std::map<unsigned, std::filesystem::path> findSequels(const std::filesystem::path& log) {
    auto sequels = log::findSequence(log);
    std::erase_if(sequels, [&](const auto& file) { return file.first <= *log::sequenceNumber(log); });
    return sequels;
}

constexpr std::chrono::seconds retry_period{1};

std::chrono::nanoseconds nanoseconds(double seconds) {
    return std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::duration<double>(seconds));
}

/** Returns x.1.log for x.0.log and for x.log. */
std::filesystem::path findSequel(const std::filesystem::path& log) {
    if (log::sequenceNumber(log)) return nextInSequence(log);
    return log.parent_path() / (log.stem().string() + ".1" + log.extension().string());
}

}  // namespace

void refuseSequels(const std::filesystem::path& log) {
    for (const auto& [number, sequel] : findSequels(log))
        if (log::isBeingWritten(sequel))
            throw types::ConfigError(sequel, "", "the log cannot be removed: another logger writes it");
}

void removeSequels(const std::filesystem::path& log) {
    for (auto sequels = findSequels(log); !sequels.empty(); sequels.erase(std::prev(sequels.end())))
        log::removeLog(sequels.rbegin()->second);
}

Rotation::Rotation(const LoggerConfig& config, log::Writer& log)
    : log_(log),
      max_size_(config.max_file_size),
      max_duration_(config.max_file_duration),
      max_total_(config.max_total_size),
      first_(log::sequenceNumber(log.path()).value_or(0)) {}

bool Rotation::due(types::Time now) const {
    return (max_size_ && static_cast<double>(log_.size()) >= *max_size_) ||
           (max_duration_ && types::due(*began_, types::Time::fromSeconds(*max_duration_), now));
}

void Rotation::before(types::Time now) {
    if (!began_) began_ = now;
    if (!due(now)) return;
    began_ = now;  // also of a file that is opened later, because that fails now
    if (max_total_) removeOldest();
    log_.next(nextInSequence(log_.path()));
}

void Rotation::removeOldest() const {
    const double room = *max_total_ - *max_size_;  // without that of the file that begins
    auto files = log::findSequence(log_.path());
    std::erase_if(files, [&](const auto& file) { return file.first < first_; });
    const auto getSize = [&](const std::filesystem::path& file) {  // a file exceeds its limit by a part of a sample
        std::error_code none;
        const uintmax_t size = file == log_.path() ? log_.size() : std::filesystem::file_size(file, none);
        return std::min(static_cast<double>(size), *max_size_);
    };
    double total = 0;
    for (const auto& [number, file] : files) total += getSize(file);
    for (auto oldest = files.begin(); total > room && oldest != files.end() && oldest->second != log_.path();
         ++oldest) {
        const double size = getSize(oldest->second);
        if (log::removeLog(oldest->second)) total -= size;
    }
}

types::Recording reportOn(const std::filesystem::path& file, uint64_t bytes) {
    std::error_code unknown;
    const auto disk = std::filesystem::space(file.parent_path(), unknown);
    return {file.string(), bytes, unknown ? 0 : disk.available};
}

LogThread::LogThread(log::Writer& log, Rotation& rotation, size_t capacity, double flush_period, AtFailure at_failure,
                     double sync_period, RecordingBoard* board)
    : log_(log),
      rotation_(rotation),
      kept_before_(log.kept()),
      flush_period_(nanoseconds(std::min(flush_period, sync_period))),
      sync_period_(nanoseconds(sync_period)),
      at_failure_(at_failure),
      opened_(log.path()),
      next_sync_(Clock::now() + sync_period_),
      board_(board),
      ring_(capacity),
      thread_(types::startThread("the log", [this] { run(); })) {}

LogThread::~LogThread() {
    try {
        finish();
    } catch (const std::exception&) {
        // A destructor cannot report errors; finish() does.
    }
}

LogThread::Entry& LogThread::freeEntry(size_t bytes) {
    std::unique_lock lock(mutex_);
    const auto hasRoom = [&] { return count_ < ring_.size() && (count_ == 0 || waiting_bytes_ + bytes <= max_bytes); };
    room_.wait(lock, [&] { return hasRoom() || failed_; });
    if (failed_) reportFailure();
    waiting_bytes_ += bytes;
    return ring_[(first_ + count_) % ring_.size()];
}

void LogThread::commit() {
    std::lock_guard lock(mutex_);
    ++count_;
    work_.notify_one();
}

void LogThread::finish() {
    {
        std::lock_guard lock(mutex_);
        ending_ = true;
        work_.notify_one();
    }
    if (thread_.joinable()) thread_.join();
    if (!failure_.empty()) reportFailure();
}

void LogThread::declare(Declare declaration) {
    freeEntry().declaration = std::move(declaration);
    commit();
}

void LogThread::reportFailure() {
    const std::string why = std::exchange(failure_, {});
    const uint64_t lost = pushed_ - (kept_ - kept_before_);
    throw std::runtime_error(why.empty() ? "the log has failed"
                                         : why + "; " + std::to_string(lost) + " samples did not reach it");
}

LogHealth LogThread::health() const {
    std::lock_guard lock(mutex_);
    return health_;
}

void LogThread::run() {
    try {
        writeAll();
        next_try_ = {};
        if (health_.fails) tryAgain();
        if (health_.fails) throw std::runtime_error(health_.failure);
        log_.flush();
        report(true);
    } catch (const std::exception& error) {
        std::lock_guard lock(mutex_);
        failed_ = true;
        failure_ = error.what();
        kept_ = log_.kept();
        room_.notify_all();
    }
}

void LogThread::writeAll() {
    std::unique_lock lock(mutex_);
    next_flush_ = Clock::now() + flush_period_;
    while (true) {
        work_.wait_until(lock, next_flush_, [&] { return count_ > 0 || ending_; });
        if (count_ == 0 && ending_) return;
        const bool has_entry = count_ > 0;
        lock.unlock();
        work(has_entry ? &ring_[first_] : nullptr);
        report(false);
        lock.lock();
        if (!has_entry) continue;
        waiting_bytes_ -= std::exchange(ring_[first_].bytes, 0);
        first_ = (first_ + 1) % ring_.size();
        --count_;
        room_.notify_one();
    }
}

void LogThread::report(bool at_once) {
    if (!board_ || !log_.isOpen()) return;
    const uint64_t size = log_.size();
    if (size < present_bytes_ || written_.file.empty()) written_.file = log_.path().string();
    written_.bytes += size < present_bytes_ ? size : size - present_bytes_;  // smaller: the next file
    present_bytes_ = size;
    if (!at_once && Clock::now() < next_report_) return;
    next_report_ = Clock::now() + std::chrono::milliseconds(250);
    board_->set(reportOn(written_.file, written_.bytes));
}

void LogThread::work(Entry* entry) {
    if (health_.fails) tryAgain();
    try {
        if (entry) health_.fails ? pass(*entry) : write(*entry);
        entry = nullptr;  // a failing flush does not concern this entry
        if (Clock::now() < next_flush_) return;
        next_flush_ = Clock::now() + flush_period_;
        if (!health_.fails) flush();
    } catch (const std::exception& error) {
        const bool is_refused = log_.isOpen();  // the file works, and cannot store this entry
        if (at_failure_ == AtFailure::Throw || (is_refused && (!entry || entry->declaration))) throw;
        is_refused ? refuse(*entry, error.what()) : beginOutage(error.what());
        if (entry && !is_refused) pass(*entry);
    }
}

void LogThread::flush() {
    const Clock::time_point begin = Clock::now();
    if (begin + flush_period_ <= next_sync_) return log_.flush();  // the next flush is in time
    log_.sync();
    next_sync_ = begin + sync_period_;
}

void LogThread::write(Entry& entry) {
    if (entry.declaration) {
        entry.declaration(log_);
        entry.declaration = nullptr;
        return;
    }
    rotation_.before(entry.received);
    opened_ = log_.path();
    const auto write = [&](const auto& sample) {
        log_.write(entry.stream, entry.received, *types::carriedSample(sample));
    };
    std::visit(write, entry.sample);
    pass(entry);
}

void LogThread::pass(Entry& entry) {
    if (entry.declaration) return pending_.push_back(std::exchange(entry.declaration, nullptr));
    ++handed_;
    entry.sample = types::AnySample{};  // returns a large sample to its writer's pool
}

void LogThread::refuse(Entry& entry, const std::string& why) {
    entry.sample = types::AnySample{};
    std::lock_guard lock(mutex_);
    ++health_.refused;
    health_.failure = why;
}

void LogThread::beginOutage(const std::string& why) {
    const bool is_empty = kept_at_opening_ == log_.kept();  // continues in the same empty file
    const bool is_unopened = log_.path() != opened_;        // at the rotation
    sequel_ = is_empty || is_unopened ? log_.path() : findSequel(log_.path());
    next_try_ = Clock::now() + retry_period;
    std::lock_guard lock(mutex_);
    ++health_.outages;
    health_.fails = true;
    health_.failure = why;
}

void LogThread::tryAgain() {
    if (Clock::now() < next_try_) return;
    next_try_ = Clock::now() + retry_period;
    std::string failure;
    try {
        if (std::filesystem::is_directory(sequel_)) sequel_ = findSequel(sequel_);
        log_.next(sequel_);
        opened_ = sequel_;
        for (; !pending_.empty(); pending_.erase(pending_.begin())) pending_.front()(log_);
        log_.flush();
    } catch (const std::exception& error) {
        failure = error.what();
    }
    kept_at_opening_ = log_.kept();
    std::lock_guard lock(mutex_);
    health_.fails = !failure.empty();
    if (health_.fails) {
        health_.failure = failure;
    } else {
        health_.lost = handed_ - (log_.kept() - kept_before_);
        health_.file = log_.path();
    }
}

}  // namespace insonify::logger
