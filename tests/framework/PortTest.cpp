#include <gmock/gmock.h>

#include <set>

#include "components/framework/Port.hpp"
#include "components/framework/execution/Activity.hpp"
#include "tests/support/Ports.hpp"
#include "tests/support/Refused.hpp"
#include "types/samples/Pose.hpp"
#include "types/samples/Sonar.hpp"

namespace insonify::framework {
namespace {

/** Returns what a reader gets after `count` writes of 0, 1, 2... */
std::pair<std::vector<int32_t>, uint64_t> slowReader(ConnPolicy policy, int count) {
    test::Writer<int32_t> writer;
    test::Reader<int32_t> reader;
    writer.port.connectTo(reader.port, policy);
    for (int i = 0; i < count; ++i) writer.port.write(i);
    std::vector<int32_t> got;
    for (int32_t value; reader.port.readNew(value);) got.push_back(value);
    return {got, reader.port.channels().front()->lost()};
}

using Got = std::pair<std::vector<int32_t>, uint64_t>;

TEST(PortTest, DataKeepsTheNewest) { EXPECT_EQ(slowReader(ConnPolicy::data(), 4), (Got{{3}, 3})); }
TEST(PortTest, AFullBufferRefusesTheNewest) { EXPECT_EQ(slowReader(ConnPolicy::buffer(2), 4), (Got{{0, 1}, 2})); }
TEST(PortTest, AFullCircularBufferDropsTheOldest) {
    EXPECT_EQ(slowReader(ConnPolicy::circularBuffer(2), 4), (Got{{2, 3}, 2}));
}
TEST(PortTest, NothingIsLostWithinCapacity) { EXPECT_EQ(slowReader(ConnPolicy::buffer(3), 3), (Got{{0, 1, 2}, 0})); }

TEST(PortTest, ReadReturnsNoOldOrNewData) {
    test::Writer<int32_t> writer;
    test::Reader<int32_t> reader;
    writer.port.connectTo(reader.port, {});
    int32_t value = -1;
    EXPECT_EQ(reader.port.read(value), FlowStatus::NoData);
    writer.port.write(7);
    EXPECT_EQ(reader.port.read(value), FlowStatus::NewData);
    value = -1;
    EXPECT_EQ(reader.port.read(value, false), FlowStatus::OldData);
    EXPECT_EQ(value, -1);
    EXPECT_EQ(reader.port.read(value), FlowStatus::OldData);
    EXPECT_EQ(value, 7);
}

TEST(PortTest, ReadNewestDrains) {
    test::Writer<int32_t> writer;
    test::Reader<int32_t> reader;
    writer.port.connectTo(reader.port, ConnPolicy::buffer(4));
    for (int i = 0; i < 3; ++i) writer.port.write(i);
    int32_t value = -1;
    EXPECT_EQ(reader.port.readNewest(value), FlowStatus::NewData);
    EXPECT_EQ(value, 2);
    EXPECT_FALSE(reader.port.hasNew());
}

/** Returns the samples that a task processes of three, and the number of skipped samples of its connections. */
std::pair<std::vector<int32_t>, uint64_t> workedOn(bool realtime) {
    test::Writer<int32_t> writer;
    test::Reader<int32_t> reader;
    writer.port.connectTo(reader.port, ConnPolicy::buffer(4));
    if (realtime) reader.activity().release(), reader.activity().hold();
    for (int i = 0; i < 3; ++i) writer.port.write(i);
    std::vector<int32_t> got;
    for (int32_t value = -1; reader.port.readNext(value);) got.push_back(value);
    return {got, reader.port.channels().front()->passedOver()};
}

TEST(PortTest, InLockstepTheNextSampleCounts) { EXPECT_EQ(workedOn(false), (Got{{0, 1, 2}, 0})); }
TEST(PortTest, InRealtimeTheNewestIsReadAndSkippedSamplesAreCounted) { EXPECT_EQ(workedOn(true), (Got{{2}, 2})); }

TEST(PortTest, CountsSkippedSamplesPerConnection) {
    test::Writer<int32_t> few, many;
    test::Reader<int32_t> reader;
    many.port.connectTo(reader.port, ConnPolicy::buffer(8));
    few.port.connectTo(reader.port, ConnPolicy::buffer(8));
    for (int i = 0; i < 5; ++i) many.port.write(i);
    for (int i = 0; i < 2; ++i) few.port.write(10 + i);
    int32_t value = -1;
    EXPECT_EQ(reader.port.readNewest(value), FlowStatus::NewData);
    EXPECT_EQ(value, 11);
    EXPECT_EQ(reader.port.channels()[0]->passedOver(), 5u);
    EXPECT_EQ(reader.port.channels()[1]->passedOver(), 1u);
    EXPECT_EQ(reader.port.readNewest(value), FlowStatus::OldData);
    EXPECT_EQ(reader.port.channels()[1]->lost(), 0u);
}

TEST(PortTest, InitHandsTheLastSampleToALaterReader) {
    test::Writer<int32_t> writer;
    test::Reader<int32_t> first, late;
    ConnPolicy policy;
    policy.init = true;
    writer.port.connectTo(first.port, policy);
    writer.port.write(5);
    writer.port.connectTo(late.port, policy);
    int32_t value = 0;
    EXPECT_TRUE(late.port.readNew(value));
    EXPECT_EQ(value, 5);
}

TEST(PortTest, ANullPointerToASampleIsRefused) {
    test::Writer<types::SonarPtr> writer("source");
    test::Reader<types::SonarPtr> reader;
    writer.port.connectTo(reader.port, ConnPolicy::buffer(2));
    EXPECT_EQ(test::computeError<std::logic_error>([&] { writer.port.write(nullptr); }),
              "source.port: a null pointer was written; a sample is needed");
    EXPECT_FALSE(reader.port.hasNew());
}

TEST(PortTest, EachTypeHasItsOwnName) {
    struct Own {};
    const std::set<std::string> names{typeName<std::string>(),         typeName<uint64_t>(),
                                      typeName<std::vector<double>>(), typeName<Own>(),
                                      typeName<types::SonarPtr>(),     typeName<int32_t>()};
    EXPECT_EQ(names.size(), 6u);
    EXPECT_THAT(typeName<Own>(), testing::HasSubstr("Own"));
    EXPECT_EQ(typeName<std::string>(), "/std/string");
}

TEST(PortTest, ASharedSampleIsTheSameAddressAtBothEnds) {
    using Large = std::shared_ptr<const std::vector<float>>;
    test::Writer<Large> writer;
    test::Reader<Large> reader;
    writer.port.connectTo(reader.port, ConnPolicy::buffer(2));
    const Large sent = std::make_shared<std::vector<float>>(1000);
    writer.port.write(sent);
    Large got;
    ASSERT_TRUE(reader.port.readNew(got));
    EXPECT_EQ(got.get(), sent.get());
}

TEST(PortTest, ADisconnectedPortHasNoData) {
    test::Writer<int32_t> writer;
    test::Reader<int32_t> reader, stays;
    writer.port.connectTo(reader.port, ConnPolicy::buffer(2));
    writer.port.connectTo(stays.port, ConnPolicy::buffer(2));
    writer.port.write(1);
    writer.port.disconnect(reader.port);
    writer.port.write(2);
    int32_t value = 0;
    EXPECT_EQ(reader.port.read(value), FlowStatus::NoData);
    EXPECT_TRUE(stays.port.readNew(value));
    EXPECT_TRUE(stays.port.readNew(value));
    EXPECT_EQ(value, 2);
}

TEST(PortTest, DisconnectsInDestructor) {
    test::Writer<int32_t> writer;
    {
        test::Reader<int32_t> reader;
        writer.port.connectTo(reader.port, {});
    }
    EXPECT_FALSE(writer.port.connected());
    writer.port.write(1);
    test::Reader<int32_t> reader;
    {
        test::Writer<int32_t> other;
        other.port.connectTo(reader.port, {});
    }
    EXPECT_FALSE(reader.port.connected());
}

TEST(PortTest, PortsOfDifferentTypesDoNotConnect) {
    test::Writer<int32_t> writer;
    test::Reader<double> reader;
    EXPECT_FALSE(writer.port.connectTo(reader.port, {}));
    EXPECT_FALSE(reader.port.connected());
}

TEST(PortTest, StartClearsEarlierSamples) {
    test::Writer<int32_t> writer;
    test::Reader<int32_t> reader;
    writer.port.connectTo(reader.port, ConnPolicy::buffer(4));
    reader.configure();
    writer.port.write(1);
    ASSERT_TRUE(reader.start());
    int32_t value = 0;
    EXPECT_EQ(reader.port.read(value), FlowStatus::NoData);
}

/** Reads one sample per cycle. */
struct OneByOne : TaskContext {
    using TaskContext::TaskContext;
    InputPort<int32_t> in{this, "in", "numbers"};
    int cycles_run = 0, samples = 0;
    bool reads = true;
    void updateHook() override {
        int32_t value = 0;
        ++cycles_run;
        if (reads && in.readNew(value)) ++samples;
    }
};

TEST(PortTest, TheHookRunsAgainUntilItsPortsAreEmpty) {
    test::Writer<int32_t> writer;
    OneByOne task("slow");
    writer.port.connectTo(task.in, ConnPolicy::buffer(300));
    task.configure();
    task.start();
    for (int i = 0; i < 300; ++i) writer.port.write(i);
    task.update();
    EXPECT_EQ(task.samples, 300);
    EXPECT_EQ(task.cycles_run, 300);
}

TEST(PortTest, AHookThatReadsNothingIsNotRepeatedForever) {
    test::Writer<int32_t> writer;
    OneByOne task("blind");
    task.reads = false;
    writer.port.connectTo(task.in, ConnPolicy::buffer(3));
    task.configure();
    task.start();
    writer.port.write(1);
    task.update();
    EXPECT_EQ(task.cycles_run, 1);
}

/** Returns the newest of samples with these stamps [s], in the order of their connections. */
double findNewest(const std::vector<std::vector<double>>& stamps) {
    std::vector<std::unique_ptr<test::Writer<types::Pose>>> writers;
    test::Reader<types::Pose> reader;
    for (const auto& of_one : stamps) {
        auto& writer = *writers.emplace_back(std::make_unique<test::Writer<types::Pose>>());
        writer.port.connectTo(reader.port, ConnPolicy::buffer(8));
        for (const double stamp : of_one) {
            types::Pose pose;
            pose.time = types::Time::fromSeconds(stamp);
            writer.port.write(pose);
        }
    }
    types::Pose newest, again;
    EXPECT_EQ(reader.port.readNewest(newest), FlowStatus::NewData);
    EXPECT_EQ(reader.port.read(again), FlowStatus::OldData);
    EXPECT_EQ(again.time, newest.time);
    uint64_t passed_over = 0, count = 0;
    for (const auto& channel : reader.port.channels()) passed_over += channel->passedOver();
    for (const auto& of_one : stamps) count += of_one.size();
    EXPECT_EQ(passed_over, count - 1);
    return newest.time.seconds();
}

TEST(PortTest, TheNewestOfSeveralConnectionsHasTheLatestStamp) {
    EXPECT_EQ(findNewest({{2}, {1}}), 2);
    EXPECT_EQ(findNewest({{1}, {2}}), 2);
    EXPECT_EQ(findNewest({{1, 3}, {2}, {0.5, 1.5}}), 3);
    EXPECT_EQ(findNewest({{10, 5, 6}, {4}}), 6) << "the last of one connection, whose clock was set back";
    EXPECT_EQ(findNewest({{10, 5, 6}, {8}}), 8);
}

}  // namespace
}  // namespace insonify::framework
