#include "components/logger/LogThread.hpp"

#include <chrono>

namespace insonify::logger {

LogThread::LogThread(log::Writer& log, Rotation& rotation, size_t capacity, double flush_period)
    : log_(log),
      rotation_(rotation),
      kept_before_(log.kept()),
      flush_period_(std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::duration<double>(flush_period))),
      ring_(capacity),
      thread_(&LogThread::run, this) {}

LogThread::~LogThread() {
    try {
        finish();
    } catch (const std::exception&) {
        // A destructor has nobody to tell; finish() does.
    }
}

LogThread::Entry& LogThread::freeEntry() {
    std::unique_lock lock(mutex_);
    room_.wait(lock, [&] { return count_ < ring_.size() || failed_; });
    if (failed_) tellFailure();
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
    if (!failure_.empty()) tellFailure();
}

void LogThread::declare(Declare declaration) {
    freeEntry().declaration = std::move(declaration);
    commit();
}

void LogThread::tellFailure() {
    const std::string why = std::exchange(failure_, {});
    const uint64_t lost = pushed_ - (kept_ - kept_before_);
    throw std::runtime_error(why.empty() ? "the log has failed"
                                         : why + "; " + std::to_string(lost) + " samples did not reach it");
}

void LogThread::run() {
    try {
        writeAll();
        log_.flush();
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
    Clock::time_point next_flush = Clock::now() + flush_period_;
    while (true) {
        work_.wait_until(lock, next_flush, [&] { return count_ > 0 || ending_; });
        if (count_ == 0 && ending_) return;
        const bool has_entry = count_ > 0;
        lock.unlock();
        if (has_entry) write(ring_[first_]);
        if (Clock::now() >= next_flush) {
            log_.flush();
            next_flush = Clock::now() + flush_period_;
        }
        lock.lock();
        if (!has_entry) continue;
        first_ = (first_ + 1) % ring_.size();
        --count_;
        room_.notify_one();
    }
}

void LogThread::write(Entry& entry) {
    if (const Declare declare = std::exchange(entry.declaration, nullptr)) {
        declare(log_);
        return;
    }
    rotation_.before(entry.received);
    const auto write = [&](const auto& sample) {
        log_.write(entry.stream, entry.received, *types::carriedSample(sample));
    };
    std::visit(write, entry.sample);
    entry.sample = types::AnySample{};  // a large sample goes back to its writer's pool
}

}  // namespace insonify::logger
