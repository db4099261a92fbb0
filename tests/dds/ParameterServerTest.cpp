// The services of a node: their end, and random requests of a client.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <future>
#include <map>
#include <memory>
#include <random>
#include <thread>

#include "components/dds/Endpoints.hpp"
#include "components/dds/LifecycleServer.hpp"
#include "components/dds/ParameterServer.hpp"
#include "components/ros/Cdr.hpp"
#include "tests/dds/Ends.hpp"

using namespace insonify;
using namespace insonify::dds;

namespace {

/** A deployment that answers only when it is let. */
struct SlowDeployment final : types::DeploymentControl {
    types::DeploymentStatus status() const override {
        ++asked;
        released.wait();
        return {};
    }
    std::vector<types::TaskInterface> interfaces() const override { return {}; }
    std::string call(const std::string&, const std::vector<std::string>&) override { return ""; }
    void pause(bool) override {}
    void step() override {}

    mutable std::atomic<int> asked{0};
    std::promise<void> release;
    std::shared_future<void> released{release.get_future()};
};

/** A client of one service of /insonify, as rmw_cyclonedds_cpp makes it. */
template <class Request, class Response>
class Client {
public:
    Client(Node& node, const ros::Service<Request, Response>& service)
        : requests_(node, "rq/insonify/" + std::string(service.name) + "Request", Request::type_name, "", quality),
          replies_(node, "rr/insonify/" + std::string(service.name) + "Reply", Response::type_name, "", quality, {}) {
        EXPECT_TRUE(becomesTrue([&] { return requests_.hasReaders(); }));
        Bytes none;
        uint64_t sender = 0;
        EXPECT_TRUE(becomesTrue([&] {  // the server must know our reader as well
            requests_.write(numbered(Request{}, 0));
            return replies_.take(none, sender);
        }));
    }
    Response ask(const Request& request) {
        requests_.write(numbered(request, ++number_));
        Bytes reply;
        uint64_t sender = 0;
        Response response;
        const bool came = becomesTrue([&] {
            return replies_.take(reply, sender) && reply.at(12) == static_cast<char>(number_) &&
                   reply.at(13) == static_cast<char>(number_ >> 8);
        });
        EXPECT_TRUE(came);
        if (!came) return response;
        reply.erase(reply.begin() + 4, reply.begin() + 20);
        ros::decode(std::span<const char>(reply), response);
        return response;
    }

private:
    static Bytes numbered(const Request& request, int number) {
        Bytes bytes;
        ros::encode(request, bytes);
        bytes.insert(bytes.begin() + 4, 16, 0);  // the sender's identity and the number, after the encapsulation
        bytes[12] = static_cast<char>(number);
        bytes[13] = static_cast<char>(number >> 8);
        return bytes;
    }
    static constexpr Quality quality{.reliability = Reliability::Reliable, .depth = 100};
    Writer requests_;
    Reader replies_;
    int number_ = 0;
};

/** A deployment of one task, "sonar": with properties a to e from 0 to 10, and states of Orocos. */
struct OneTask final : types::DeploymentControl {
    types::DeploymentStatus status() const override {
        types::DeploymentStatus status;
        types::TaskStatus& task = status.tasks.emplace_back();
        task.record.name = "sonar";
        for (const auto& [name, value] : values) task.record.properties[name] = value;
        task.state = state;
        return status;
    }
    std::vector<types::TaskInterface> interfaces() const override {
        types::TaskInterface task;
        task.name = "sonar";
        for (const auto& [name, value] : values) task.properties.push_back({name, "double", "", "", 0, 10, ""});
        return {task};
    }
    std::string call(const std::string& operation, const std::vector<std::string>&) override {
        const std::map<std::string, std::array<std::string, 2>> moves{
            {"sonar.configure", {"PreOperational", "Stopped"}},
            {"sonar.start", {"Stopped", "Running"}},
            {"sonar.stop", {"Running", "Stopped"}},
            {"sonar.cleanup", {"Stopped", "PreOperational"}},
            {"sonar.recover", {"Exception", "PreOperational"}}};
        const auto& [from, to] = moves.at(operation);
        if (state != from || refuses) throw std::runtime_error("refused");
        if (breaks) {
            state = "Exception";
            throw std::runtime_error("broken");
        }
        state = to;
        return "";
    }
    void pause(bool) override {}
    void step() override {}

    std::map<std::string, double> values{{"a", 1}, {"b", 2}, {"c", 3}, {"d", 4}, {"e", 5}};
    std::string state = "PreOperational";
    bool refuses = false, breaks = false;
};

struct ParameterServerTest : Loopback {
    Node node{domainId({}), "/insonify", 16}, asking{domainId({}), "/asking", 16};
    std::unique_ptr<NodeServer> server = std::make_unique<NodeServer>(node, "/insonify");  ///< Ends first.
};

}  // namespace

TEST_F(ParameterServerTest, ItsEndWaitsForOneRequestOfAClientThatFloods) {
    constexpr auto a_while = std::chrono::milliseconds(300);
    SlowDeployment deployment;
    const ParameterServer parameters(*server, "ros", deployment, {}, [] { return false; });
    server->start();
    Writer requests(asking, "rq/insonify/list_parametersRequest", ros::ListParametersRequest::type_name, "",
                    {.reliability = Reliability::Reliable, .depth = 10});
    ASSERT_TRUE(becomesTrue([&] { return requests.hasReaders(); }));
    Bytes request;
    ros::encode(ros::ListParametersRequest{}, request);
    request.insert(request.begin() + 4, 16, 0);  // the sender's identity, after the encapsulation
    for (int i = 0; i < 8; ++i) ASSERT_TRUE(requests.write(request));
    ASSERT_TRUE(becomesTrue([&] { return deployment.asked == 1; }));
    std::this_thread::sleep_for(a_while);  // all have arrived
    std::thread end([&] { server.reset(); });
    std::this_thread::sleep_for(a_while);  // it ends by now, once this answer is there
    deployment.release.set_value();
    end.join();
    EXPECT_EQ(deployment.asked, 1);
}

TEST_F(ParameterServerTest, RandomListsAreSetAsAWholeOrNotAtAll) {
    OneTask deployment;
    const ParameterServer parameters(
        *server, "ros", deployment,
        [&](const std::map<std::string, std::string>& wanted) {
            for (const auto& [name, value] : wanted)
                if (std::stod(value) > 10) throw std::runtime_error(name + ": is " + value);
            for (const auto& [name, value] : wanted) deployment.values.at(name.substr(6)) = std::stod(value);
        },
        [] { return false; });
    server->start();
    Client client(asking, ros::set_parameters_atomically);
    std::mt19937 random(7);
    int all = 0, none = 0;
    for (int i = 0; i < 200; ++i) {
        auto wanted = deployment.values;
        std::vector<ros::Parameter> list;
        bool is_good = true;
        std::vector<std::string> names{"a", "b", "c", "d", "e", "f"};  // f is unknown
        std::ranges::shuffle(names, random);
        names.resize(random() % 5);
        for (const std::string& name : names) {
            ros::Parameter& one = list.emplace_back(ros::Parameter{"sonar." + name, {}});
            one.value.type = random() % 10 == 0 ? static_cast<uint8_t>(20) : static_cast<uint8_t>(3);
            one.value.double_value = static_cast<double>(random() % 11) + static_cast<double>(random() % 10 == 0) * 20;
            is_good = is_good && name != "f" && one.value.type == 3 && one.value.double_value <= 10;
            if (is_good) wanted[name] = one.value.double_value;
        }
        const auto before = deployment.values;
        const ros::SetParametersResult result = client.ask({list}).field;
        EXPECT_EQ(result.successful, is_good) << result.reason;
        EXPECT_EQ(result.reason.empty(), is_good);
        EXPECT_EQ(deployment.values, is_good ? wanted : before);
        ++(is_good ? all : none);
    }
    EXPECT_GT(std::min(all, none), 50);
    server.reset();
}

TEST_F(ParameterServerTest, RandomTransitionsFollowTheStateMachineOfRos) {
    OneTask deployment;
    std::vector<std::string> reported;
    const LifecycleServer lifecycle(*server, "sonar", deployment,
                                    [&](const std::string& line) { reported.push_back(line); });
    server->start();
    Reader events(asking, "rt/insonify/transition_event", ros::TransitionEvent::type_name, "",
                  {.reliability = Reliability::Reliable, .depth = 10'000}, {});
    Client change(asking, ros::change_state);
    Client available(asking, ros::get_available_transitions);
    Client present(asking, ros::get_state);
    std::mt19937 random(3);
    const auto labels = {"configure", "cleanup", "activate", "deactivate", "transition_success", "nonsense"};
    int successes = 0;
    for (int i = 0; i < 300; ++i) {
        const std::string before = present.ask({}).field.label;
        const auto open = available.ask({}).field;
        ros::Transition wanted;
        if (random() % 2)
            wanted.label = *(labels.begin() + random() % labels.size());
        else
            wanted.id = static_cast<uint8_t>(std::array{1, 2, 3, 4, 60, 99}[random() % 6]);
        const auto fits = [&](const ros::TransitionDescription& each) {
            return wanted.label.empty() ? each.transition.id == wanted.id : each.transition.label == wanted.label;
        };
        const bool is_open = std::ranges::any_of(open, fits);
        deployment.refuses = random() % 8 == 0;
        deployment.breaks = random() % 8 == 0;
        const bool works = is_open && !deployment.refuses && !deployment.breaks;
        const size_t reports = reported.size();
        EXPECT_EQ(change.ask({wanted}).field, works) << before << wanted.label << int(wanted.id);
        EXPECT_EQ(reported.size(), reports + !works);
        const std::string after = present.ask({}).field.label;
        if (!is_open || deployment.refuses) {
            EXPECT_EQ(after, before);
        }
        if (is_open && deployment.breaks && !deployment.refuses) {
            EXPECT_EQ(after, "errorprocessing");
        }
        successes += works;
    }
    EXPECT_GT(successes, 30);
    Bytes bytes;
    uint64_t sender = 0;
    std::string at;
    int count = 0;
    for (ros::TransitionEvent event; events.take(bytes, sender); ++count) {
        ros::decode(std::span<const char>(bytes), event);
        if (!at.empty()) {
            EXPECT_EQ(event.start_state.label, at) << "events are a chain";
        }
        at = event.goal_state.label;
    }
    EXPECT_GT(count, successes);
    EXPECT_EQ(at, present.ask({}).field.label);
    server.reset();
}
