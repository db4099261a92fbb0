// Ports between threads; also run with ThreadSanitizer (scripts/test).
#include <gtest/gtest.h>

#include <future>

#include "components/framework/execution/Activity.hpp"
#include "tests/support/Ports.hpp"
#include "tests/support/Waiting.hpp"

namespace insonify::framework {
namespace {

using test::becomesTrue;

/** Reads one sample per cycle on its own thread until destroyed, and checks their order. */
class Listener : public TaskContext {
public:
    explicit Listener(std::string name = "listener") : TaskContext(std::move(name)) {
        configure();
        start();
        activity().release();
    }
    ~Listener() override { quieten(); }
    /** Stops the cycles of its thread. */
    void quieten() {
        activity().hold();
        stop();
    }
    InputPort<int64_t> in{this, "in", "rising numbers"};
    std::atomic<int> samples{0}, disordered{0};
    std::function<void()> during;

private:
    void updateHook() override {
        int64_t value = 0;
        if (!in.readNew(value)) return;
        if (value <= last_) ++disordered;
        last_ = value;
        if (during) during();
        ++samples;
    }
    int64_t last_ = 0;
};

/** Writes 1, 2, 3... as fast as possible until destroyed. */
class Chatter {
public:
    ~Chatter() {
        stop_ = true;
        thread_.join();
    }
    OutputPortBase& port() { return writer_.port; }

private:
    void run() {
        for (int64_t i = 1; !stop_; ++i) writer_.port.write(i);
    }
    test::Writer<int64_t> writer_;
    std::atomic<bool> stop_{false};
    std::thread thread_{&Chatter::run, this};
};

TEST(PortThreadsTest, EverySampleOfABurstRunsATriggeredTask) {
    test::Writer<int64_t> writer;
    Listener listener;
    writer.port.connectTo(listener.in, ConnPolicy::buffer(300));
    for (int64_t i = 1; i <= 300; ++i) writer.port.write(i);
    EXPECT_TRUE(becomesTrue([&] { return listener.samples == 300; })) << listener.samples;
    EXPECT_EQ(listener.disordered, 0);
}

TEST(PortThreadsTest, ASampleFromBeforeTheReleaseRunsTheTask) {
    test::Writer<int64_t> writer;
    Listener listener;
    listener.activity().hold();
    writer.port.connectTo(listener.in, {});
    writer.port.write(1);
    EXPECT_EQ(listener.samples, 0);
    listener.activity().release();
    EXPECT_TRUE(becomesTrue([&] { return listener.samples == 1; }));
}

TEST(PortThreadsTest, AHangingReaderDoesNotDelayItsWriter) {
    test::Writer<int64_t> writer;
    Listener listener;
    std::promise<void> hanging, let_go;
    listener.during = [&, done = let_go.get_future().share(), reported = false]() mutable {
        if (!std::exchange(reported, true)) hanging.set_value();
        done.wait();
    };
    writer.port.connectTo(listener.in, ConnPolicy::circularBuffer(2));
    writer.port.write(1);
    hanging.get_future().wait();
    for (int64_t i = 2; i <= 10001; ++i) writer.port.write(i);  // would never end if it waited for the reader
    EXPECT_EQ(listener.samples, 0);
    EXPECT_EQ(listener.in.channels().front()->lost(), 9998u);
    let_go.set_value();
    EXPECT_TRUE(becomesTrue([&] { return listener.samples == 3; }));
}

TEST(PortThreadsTest, PortsConnectAndDisconnectUnderLoad) {
    Listener first("first"), second("second");
    Chatter one, two;
    std::thread other([&] {
        for (int i = 0; i < 200; ++i) {
            two.port().connectTo(second.in, ConnPolicy::circularBuffer(3));
            std::this_thread::yield();
            two.port().disconnect(second.in);
        }
    });
    for (int i = 0; i < 200; ++i) {
        one.port().connectTo(first.in, i % 2 ? ConnPolicy::data() : ConnPolicy::buffer(5));
        EXPECT_TRUE(first.in.connected());
        const int before = first.samples;
        const auto received = [&] { return i % 20 != 0 || first.samples > before; };
        EXPECT_TRUE(becomesTrue(received));
        one.port().disconnect(first.in);
        EXPECT_FALSE(first.in.connected());
        EXPECT_FALSE(first.in.hasNew());
    }
    other.join();
    EXPECT_FALSE(one.port().connected());
    EXPECT_GT(first.samples, 0);
    EXPECT_EQ(first.disordered, 0);
    EXPECT_EQ(second.disordered, 0);
}

TEST(PortThreadsTest, ADestroyedTaskDisconnectsWhileOthersWrite) {
    Chatter chatter;
    for (int i = 0; i < 50; ++i) {
        Listener listener;
        chatter.port().connectTo(listener.in, ConnPolicy::circularBuffer(2));
        EXPECT_TRUE(becomesTrue([&] { return listener.samples > 0; }));
    }
    EXPECT_FALSE(chatter.port().connected());
}

TEST(PortThreadsTest, AnOutputMayBeDestroyedRightAfterItsReaderOnAnotherThread) {
    for (int i = 0; i < 50; ++i) {
        auto writer = std::make_unique<test::Writer<int64_t>>();
        auto reader = std::make_unique<test::Reader<int64_t>>();
        writer->port.connectTo(reader->port, {});
        std::atomic<bool> gone{false};
        std::thread other([&] {
            reader.reset();
            gone.store(true, std::memory_order_relaxed);  // orders nothing: the port must do that
        });
        while (!gone.load(std::memory_order_relaxed)) std::this_thread::yield();
        writer.reset();
        other.join();
    }
}

TEST(PortThreadsTest, TransitionsFromManyThreadsAreMadeOneAfterTheOther) {
    Chatter chatter;
    Listener listener;
    chatter.port().connectTo(listener.in, {});
    std::atomic<int> starts{0}, stops{0};
    std::vector<std::thread> threads;
    for (int t = 0; t < 3; ++t)
        threads.emplace_back([&] {
            for (int i = 0; i < 100; ++i) {
                if (listener.stop()) ++stops;
                if (listener.start()) ++starts;
            }
        });
    for (std::thread& thread : threads) thread.join();
    EXPECT_GT(stops, 0);
    EXPECT_EQ(starts, stops);  // it was running before, and is running now
    EXPECT_TRUE(listener.isRunning());
}

}  // namespace
}  // namespace insonify::framework
