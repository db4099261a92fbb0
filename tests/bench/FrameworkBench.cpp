// framework_bench [FILE.json]: costs of ports and activities on this machine, and their bounds. Exits with 1 if a cost
// exceeds its bound, or the file cannot be written.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <fstream>
#include <thread>

#include "tests/support/Allocations.hpp"
#include "tests/support/Ports.hpp"

namespace insonify::framework {
namespace {

using Clock = std::chrono::steady_clock;
using Small = std::array<double, 5>;  // 40 bytes
using Large = std::shared_ptr<const std::vector<float>>;

double nanoseconds(Clock::duration span) { return std::chrono::duration<double, std::nano>(span).count(); }

double quantile(std::vector<double> values, double q) {
    const auto at = values.begin() + static_cast<std::ptrdiff_t>(q * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), at, values.end());
    return *at;
}

/** Median over batches of the time of one `work` [ns]. */
double medianTime(int batches, int batch, auto&& work) {
    std::vector<double> times;
    for (int i = 0; i < batches; ++i) {
        const auto begin = Clock::now();
        for (int k = 0; k < batch; ++k) work();
        times.push_back(nanoseconds(Clock::now() - begin) / batch);
    }
    return quantile(times, 0.5);
}

struct Result {
    std::string name, unit;
    double value, at_most;
};

void smallSample(std::vector<Result>& results) {
    for (const auto& [policy, name] :
         {std::pair(ConnPolicy::data(), "data"), std::pair(ConnPolicy::buffer(16), "buffer of 16")}) {
        test::Writer<Small> writer;
        test::Reader<Small> reader;
        writer.port.connectTo(reader.port, policy);
        Small sample{};
        const double time = medianTime(200, 10000, [&] {
            ++sample[0];
            writer.port.write(sample);
            reader.port.read(sample);
        });
        results.push_back({fmt::format("40 B, write and read in one thread, {}", name), "ns", time, 100});
    }
}

void largeSample(std::vector<Result>& results) {
    for (const size_t count : {1u, 2u, 4u, 8u}) {
        test::Writer<Large> writer;
        std::vector<std::unique_ptr<test::Reader<Large>>> readers;
        for (size_t i = 0; i < count; ++i) {
            readers.push_back(std::make_unique<test::Reader<Large>>());
            writer.port.connectTo(readers.back()->port, ConnPolicy::buffer(4));
        }
        const Large sample = std::make_shared<std::vector<float>>(256 * 1000);
        Large got;
        const double time = medianTime(200, 1000, [&] {
            writer.port.write(sample);
            for (const auto& reader : readers) reader->port.readNew(got);
        });
        results.push_back({fmt::format("1 MB, write and read, per reader of {}", count), "us",
                           time * 1e-3 / static_cast<double>(count), 1});
    }
}

/** Waits only for its sample, which contains the time of writing. */
struct Woken : TaskContext {
    using TaskContext::TaskContext;
    InputPort<Clock::time_point> in{this, "in", "when it was written"};
    std::vector<double> latencies;
    std::atomic<size_t> woken{0};
    void updateHook() override {
        const auto now = Clock::now();
        Clock::time_point written;
        if (!in.readNew(written)) return;
        latencies.push_back(nanoseconds(now - written) * 1e-3);
        ++woken;
    }
};

/** The same with only a condition variable. */
class BareThread {
public:
    ~BareThread() {
        notify({});
        thread_.join();
    }
    void notify(Clock::time_point written) {
        {
            std::lock_guard lock(mutex_);
            written_ = written;
            set_ = true;
        }
        condition_.notify_one();
    }
    std::vector<double> latencies;
    std::atomic<size_t> woken{0};

private:
    void run() {
        std::unique_lock lock(mutex_);
        while (true) {
            condition_.wait(lock, [&] { return set_; });
            const auto now = Clock::now();
            if (written_ == Clock::time_point()) return;
            set_ = false;
            latencies.push_back(nanoseconds(now - written_) * 1e-3);
            ++woken;
        }
    }
    std::mutex mutex_;
    std::condition_variable condition_;
    Clock::time_point written_;
    bool set_ = false;
    std::thread thread_{&BareThread::run, this};
};

/** Wake-ups one after the other, each of a sleeping thread. */
void wakeUp(const std::atomic<size_t>& woken, auto&& wake) {
    const size_t before = woken;
    std::this_thread::sleep_for(std::chrono::microseconds(200));
    wake(Clock::now());
    while (woken == before) std::this_thread::yield();
}

void wakeUps(std::vector<Result>& results) {
    constexpr size_t count = 4000;
    test::Writer<Clock::time_point> writer;
    Woken task("woken");
    BareThread bare;
    task.latencies.reserve(count);
    bare.latencies.reserve(count);
    writer.port.connectTo(task.in, {});
    task.configure();
    task.start();
    task.activity().release();
    const auto allocations = test::allocationsOn(task, [&] {
        test::countHere(true);
        for (size_t i = 0; i < count; ++i) {
            wakeUp(task.woken, [&](auto now) { writer.port.write(now); });
            wakeUp(bare.woken, [&](auto now) { bare.notify(now); });
        }
        test::countHere(false);
    });
    task.activity().hold();
    task.stop();
    const double bare_median = quantile(bare.latencies, 0.5);
    results.push_back({"condition variable to its thread, median", "us", bare_median, NAN});
    results.push_back({"port to updateHook, median", "us", quantile(task.latencies, 0.5), bare_median + 1});
    results.push_back({"condition variable to its thread, p99", "us", quantile(bare.latencies, 0.99), NAN});
    results.push_back({"port to updateHook, p99", "us", quantile(task.latencies, 0.99), NAN});
    results.push_back({"heap allocations per sample, writer and reader", "1",
                       static_cast<double>(allocations.size()) / static_cast<double>(count), 0});
}

/** Keeps the first sample that it reads until released. */
struct Slow : TaskContext {
    using TaskContext::TaskContext;
    InputPort<Large> in{this, "in", "large samples"};
    std::atomic<bool> holding{false}, let_go{false};
    void updateHook() override {
        Large sample;
        if (!in.readNew(sample)) return;
        holding = true;
        while (!let_go) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
};

void slowReader(std::vector<Result>& results) {
    test::Writer<Large> writer;
    Slow task("slow");
    writer.port.connectTo(task.in, ConnPolicy::buffer(4));
    task.configure();
    task.start();
    task.activity().release();
    const Large sample = std::make_shared<std::vector<float>>(256 * 1000);
    writer.port.write(sample);
    while (!task.holding) std::this_thread::yield();
    std::vector<double> times;
    for (int i = 0; i < 100000; ++i) {
        const auto begin = Clock::now();
        writer.port.write(sample);
        times.push_back(nanoseconds(Clock::now() - begin) * 1e-3);
    }
    task.let_go = true;
    task.activity().hold();
    task.stop();
    results.push_back({"1 MB, write while its reader sleeps in updateHook, median", "us", quantile(times, 0.5), 1});
    results.push_back({"1 MB, write while its reader sleeps in updateHook, p99", "us", quantile(times, 0.99), 1});
}

bool isMissed(const Result& result) { return result.value > result.at_most; }

/** Returns whether the bound is met or missed; "" without a bound. */
const char* verdict(const Result& result) {
    if (std::isnan(result.at_most)) return "";
    return isMissed(result) ? "MISSED" : "met";
}

std::string json(const std::vector<Result>& results) {
    std::vector<std::string> entries;
    for (const Result& r : results)
        entries.push_back(fmt::format(R"({{"name": "{}", "unit": "{}", "value": {:.4g}, "at_most": {}}})", r.name,
                                      r.unit, r.value,
                                      std::isnan(r.at_most) ? "null" : fmt::format("{:.4g}", r.at_most)));
    return fmt::format("[\n  {}\n]\n", fmt::join(entries, ",\n  "));
}

}  // namespace
}  // namespace insonify::framework

int main(int count, char** words) {
    using namespace insonify::framework;
    std::vector<Result> results;
    BareThread second;  // with a single thread, the C library's locks cost nothing
    smallSample(results);
    largeSample(results);
    wakeUps(results);
    slowReader(results);
    for (const Result& r : results) {
        const std::string bound = std::isnan(r.at_most) ? "" : fmt::format("at most {:.3g}", r.at_most);
        fmt::print("{:58} {:9.3f} {:2}  {:14} {}\n", r.name, r.value, r.unit, bound, verdict(r));
    }
    if (count > 1 && !(std::ofstream(words[1]) << json(results))) {
        fmt::print(stderr, "framework_bench: {} cannot be written\n", words[1]);
        return 1;
    }
    return std::any_of(results.begin(), results.end(), isMissed) ? 1 : 0;
}
