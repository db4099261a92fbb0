#include "components/output/PictureWriter.hpp"

#include "types/Thread.hpp"

namespace insonify::output {

types::Notices PictureHealth::notices() const {
    if (lost == 0) return {};
    return {types::warning(std::to_string(lost) + " pictures are in no file; the last reason: " + failure)};
}

PictureWriter::PictureWriter(PictureFiles files, AtPictureFailure at_failure, size_t queue)
    : files_(std::move(files)),
      at_failure_(at_failure),
      waiting_(queue),
      thread_(types::startThread("the files of pictures", [this] { loop(); })) {}

PictureWriter::~PictureWriter() { end(); }

void PictureWriter::write(types::ImagePtr picture) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return count_ < waiting_.size() || error_; });
    if (error_) std::rethrow_exception(error_);
    waiting_[(first_ + count_++) % waiting_.size()] = std::move(picture);
    changed_.notify_all();
}

void PictureWriter::skip() {
    std::lock_guard lock(mutex_);
    files_.skip();
}

void PictureWriter::close() {
    end();
    if (error_) std::rethrow_exception(error_);
}

void PictureWriter::end() {
    {
        std::lock_guard lock(mutex_);
        ending_ = true;
    }
    changed_.notify_all();
    if (thread_.joinable()) thread_.join();
}

PictureHealth PictureWriter::health() {
    std::lock_guard lock(mutex_);
    return health_;
}

void PictureWriter::put(const types::Image* picture) {
    std::string failure;
    try {
        picture ? files_.write(*picture) : files_.close();
    } catch (const std::exception& error) {
        if (at_failure_ == AtPictureFailure::Throw) throw;
        failure = error.what();
    }
    if (at_failure_ == AtPictureFailure::Throw) return;
    std::lock_guard lock(mutex_);
    if (picture || !failure.empty()) health_.fails = !failure.empty();
    if (failure.empty()) return;
    ++health_.lost;
    health_.failure = std::move(failure);
}

void PictureWriter::loop() try {
    std::unique_lock lock(mutex_);
    while (true) {
        changed_.wait(lock, [this] { return count_ > 0 || ending_; });
        if (count_ == 0) break;
        const types::ImagePtr picture = std::move(waiting_[first_]);
        first_ = (first_ + 1) % waiting_.size();
        --count_;
        lock.unlock();
        changed_.notify_all();
        put(picture.get());
        lock.lock();
    }
    lock.unlock();
    put(nullptr);
} catch (...) {
    std::lock_guard lock(mutex_);
    error_ = std::current_exception();
    changed_.notify_all();
}

}  // namespace insonify::output
