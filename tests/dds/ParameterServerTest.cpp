// The end of a server of parameters.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <future>
#include <memory>
#include <thread>

#include "components/dds/Endpoints.hpp"
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

struct ParameterServerTest : Loopback {};

}  // namespace

TEST_F(ParameterServerTest, ItsEndWaitsForOneRequestOfAClientThatFloods) {
    constexpr auto a_while = std::chrono::milliseconds(300);
    Node node(domainId({}), "/insonify", 16), asking(domainId({}), "/asking", 16);
    SlowDeployment deployment;
    auto server = std::make_unique<ParameterServer>(node, "/insonify", "ros", deployment);
    Writer requests(asking, "rq/insonify/list_parametersRequest", ListParametersRequest::type_name, "",
                    {.reliability = Reliability::Reliable, .depth = 10});
    ASSERT_TRUE(becomesTrue([&] { return requests.hasReaders(); }));
    Bytes request;
    ros::encode(ListParametersRequest{}, request);
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
