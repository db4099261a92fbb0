#pragma once
#include <atomic>
#include <memory>
#include <vector>

namespace insonify::framework {

/** Reuses large samples once no reader holds them, so that a steady stream allocates nothing.
 *
 *      std::shared_ptr<types::Image> image = pool_.take();   // contents are those of an earlier use
 *      ... fill it ...
 *      pool_.stock(*image);
 *      port.write(image);
 *
 *  Grows while readers hold on to samples; never shrinks. For one thread. */
template <class T>
class SamplePool {
public:
    std::shared_ptr<T> take() {
        for (const auto& sample : samples_)
            if (sample.use_count() == 1) {
                std::atomic_thread_fence(std::memory_order_acquire);  // the last reader's reads are over
                return sample;
            }
        return samples_.emplace_back(std::make_shared<T>());
    }

    /** Allocates the samples that readers in step with the writer need, as copies of the first filled sample, so that
     *  later samples of that size allocate nothing. `prepare` reserves capacity that a copy does not have. Does nothing
     *  when the pool already has that many samples. */
    void stock(const T& filled, const auto& prepare) {
        while (samples_.size() < stocked) prepare(*samples_.emplace_back(std::make_shared<T>(filled)));
    }
    void stock(const T& filled) {
        stock(filled, [](T&) {});
    }

private:
    static constexpr size_t stocked = 4;  ///< One to fill, and one for each of three readers [1].

    std::vector<std::shared_ptr<T>> samples_;
};

}  // namespace insonify::framework
