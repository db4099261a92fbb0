#include <gmock/gmock.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "components/viewer/Publisher.hpp"

namespace insonify::viewer {
namespace {

using nlohmann::json;

Request readRequest(const std::string& text) {
    Request request;
    viewer::readRequest(text, request);
    return request;
}

TEST(StatusTextTest, AStatusHasTasksPlansAndLosses) {
    types::DeploymentStatus status;
    status.lockstep = true;
    types::TaskStatus task;
    task.record = {"sonar", "sonar::SonarTask", {{"range", 50.5}, {"model", std::string("physical")}}, ""};
    task.state = "Running";
    task.plan.emplace();
    task.plan->omitted = {{"multipath", "not configured"}};
    task.plan->predicted_error = std::numeric_limits<double>::quiet_NaN();
    task.playback = {1.5, 60, true};
    task.recording = {"x.0.log", 5, 7};
    status.tasks = {task};
    status.connections = {{"a.b", "c.d", "buffer", 3, 4}};
    const json text = json::parse(statusText(status, {2, 1, 5}));
    EXPECT_EQ(text["tasks"][0]["properties"]["range"], 50.5);
    EXPECT_EQ(text["tasks"][0]["plan"]["omitted"][0]["reason"], "not configured");
    EXPECT_TRUE(text["tasks"][0]["plan"]["predicted_error"].is_null());
    EXPECT_EQ(text["tasks"][0]["playback"], (json{{"at_s", 1.5}, {"length_s", 60}, {"paused", true}}));
    EXPECT_EQ(text["tasks"][0]["recording"], (json{{"file", "x.0.log"}, {"bytes", 5}, {"free_bytes", 7}}));
    EXPECT_EQ(text["connections"][0]["lost"], 3);
    EXPECT_EQ(text["connections"][0]["passed_over"], 4);
    EXPECT_EQ(text["clients"], 2);
    EXPECT_EQ(text["dropped"], 5);
}

TEST(StatusTextTest, HidesATokenInTheStatus) {
    types::DeploymentStatus status;
    status.tasks.emplace_back();
    status.tasks.back().record = {
        "viewer", "viewer::ViewerTask", {{"token", std::string("sesame")}, {"address", std::string("0.0.0.0")}}, ""};
    EXPECT_EQ(statusText(status, {}).find("sesame"), std::string::npos);
    EXPECT_EQ(json::parse(statusText(status, {}))["tasks"][0]["properties"]["token"], "...");
}

TEST(StatusTextTest, ReplacesTextThatIsNotUtf8) {
    types::DeploymentStatus status;
    status.tasks.emplace_back();
    status.tasks.back().error = "bad \xff byte";
    EXPECT_EQ(json::parse(statusText(status, {}))["tasks"][0]["error"], "bad \xef\xbf\xbd byte");
}

TEST(StatusTextTest, InfiniteBoundsAreNull) {
    const double infinite = std::numeric_limits<double>::infinity();
    const json text = json::parse(interfacesText(
        {{"sonar", {{"range", "double", "m", "", 0, infinite, "far edge"}}, {"start void()"}, {"range"}}}, true));
    EXPECT_EQ(text["tasks"][0]["properties"][0]["fixed"], true);
    EXPECT_EQ(text["tasks"][0]["properties"][0]["min"], 0);
    EXPECT_TRUE(text["tasks"][0]["properties"][0]["max"].is_null());
}

TEST(StatusTextTest, ReadsRequests) {
    const Request call = readRequest(R"({"id":3,"call":"sonar.setRange","arguments":["30"]})");
    EXPECT_EQ(call.id, 3u);
    EXPECT_EQ(call.operation, "sonar.setRange");
    EXPECT_EQ(call.arguments, std::vector<std::string>{"30"});
    EXPECT_TRUE(readRequest(R"({"pause":true})").on);
    EXPECT_EQ(readRequest(R"({"step":true})").kind, Request::Kind::Step);
}

TEST(StatusTextTest, RefusesADeeplyNestedRequestLikeAnother) {
    const std::string open(30'000, '['), close(30'000, ']');
    EXPECT_THROW(readRequest(R"({"call":"a.b","arguments":)" + open + close + "}"), std::invalid_argument);
    EXPECT_THROW(readRequest(R"({"id":)" + open + close + R"(,"step":true})"), std::invalid_argument);
}

TEST(StatusTextTest, RefusesInvalidRequests) {
    for (const char* text : {"", "[]", "{}", "{\"id\":-1,\"step\":true}", R"({"call":1})", R"({"pause":1})",
                             R"({"call":"a.b","arguments":[1]})", R"({"call":"a.b","arguments":"5"})",
                             R"({"call":"a.b","arguments":{"x":"5"}})", R"({"call":"a.b","arguments":null})", "\xff"})
        EXPECT_THROW(readRequest(text), std::invalid_argument) << text;
}

TEST(StatusTextTest, ARefusalHasTheIdOfTheRequest) {
    Request request;
    EXPECT_THROW(viewer::readRequest(R"({"id":7,"call":"a.b","arguments":"5"})", request), std::invalid_argument);
    EXPECT_EQ(request.id, 7u);
}

}  // namespace
}  // namespace insonify::viewer
