#include <gmock/gmock.h>

#include <future>
#include <nlohmann/json.hpp>

#include "components/viewer/Publisher.hpp"
#include "tests/viewer/Client.hpp"

namespace insonify::viewer {
namespace {

/** The next answer, whatever else comes. */
nlohmann::json answer(Client& client) {
    while (const auto message = client.hear()) {
        const auto json = nlohmann::json::parse(*message, nullptr, false);
        if (json.is_object() && json["type"] == "answer") return json;
    }
    return nullptr;
}

std::string call(uint64_t id, const std::string& operation) {
    return nlohmann::json{{"id", id}, {"call", operation}}.dump();
}

/** Of tasks of which one does not answer until it is let go. */
class Blocked : public types::DeploymentControl {
    std::promise<void> release_;
    std::shared_future<void> released_{release_.get_future()};

public:
    Publisher publisher{config(), {}, {"viewer", this, [](const std::string&) {}}};

    types::DeploymentStatus status() const override { return {}; }
    std::vector<types::TaskInterface> interfaces() const override { return {{"deaf", {}, {}}, {"lively", {}, {}}}; }
    std::string call(const std::string& operation, const std::vector<std::string>&) override {
        if (operation == "deaf.ask") released_.wait();
        return operation;
    }
    void pause(bool) override {}
    void step() override {}
    void release() { release_.set_value(); }

private:
    static ViewerConfig config() {
        ViewerConfig config;
        config.port = 0;
        config.idle_timeout = 3600;
        return config;
    }
};

TEST(PublisherTest, ATaskThatDoesNotAnswerHoldsUpNoOther) {
    Blocked blocked;
    Client client(blocked.publisher.port());
    ASSERT_THAT(client.upgrade(page_protocol), testing::HasSubstr("101"));
    client.say(call(1, "deaf.ask"));
    client.say(call(2, "lively.ask"));
    EXPECT_EQ(answer(client)["id"], 2);
    client.say(R"({"id":3,"pause":false})");
    EXPECT_EQ(answer(client)["id"], 3);
    client.say(call(4, "unknown.ask"));
    EXPECT_EQ(answer(client)["id"], 4);
    blocked.release();
    EXPECT_EQ(answer(client)["result"], "deaf.ask");
}

TEST(PublisherTest, TheViewerAndTheStatesOfTasksAreNotForPages) {
    Blocked blocked;
    Client client(blocked.publisher.port());
    ASSERT_THAT(client.upgrade(page_protocol), testing::HasSubstr("101"));
    client.say(call(1, "viewer.setControl"));
    EXPECT_THAT(answer(client)["refused"], testing::HasSubstr("the viewer does not steer itself"));
    client.say(call(2, "lively.stop"));
    EXPECT_THAT(answer(client)["refused"], testing::HasSubstr("states of tasks are the deployment's to change"));
    client.say(call(3, "lively.stopwatch"));
    EXPECT_EQ(answer(client)["result"], "lively.stopwatch");
}

TEST(PublisherTest, OneRequestTooManyIsRefusedByItsId) {
    Blocked blocked;
    Client client(blocked.publisher.port());
    ASSERT_THAT(client.upgrade(page_protocol), testing::HasSubstr("101"));
    for (uint64_t id = 1; id <= SerialExecutors::max_waiting + 2; ++id) client.say(call(id, "deaf.ask"));
    const auto refused = answer(client);
    EXPECT_GT(refused["id"], SerialExecutors::max_waiting);
    EXPECT_THAT(refused["refused"], testing::HasSubstr("too many requests wait"));
    blocked.release();
}

}  // namespace
}  // namespace insonify::viewer
