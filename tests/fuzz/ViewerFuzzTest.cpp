#include <gtest/gtest.h>

#include "components/viewer/Foxglove.hpp"
#include "components/viewer/Publisher.hpp"
#include "components/viewer/Server.hpp"
#include "tests/support/Fuzz.hpp"

namespace insonify::fuzz {
namespace {

void ask(const Input& input) {
    static viewer::Subscriptions subscriptions(3);
    subscriptions.take(input.bytes());
    EXPECT_LE(subscriptions.all().size(), 3u);
    try {
        const viewer::ParameterRequest asked = viewer::readParameterRequest(input.bytes());
        viewer::ParameterSubscriptions().take(asked);
    } catch (const std::invalid_argument& error) {
        expectOurWords(error.what());
    }
    viewer::Request request;
    try {
        viewer::readRequest(input.bytes(), request);
    } catch (const std::invalid_argument& error) {
        expectOurWords(viewer::refusalText(request.id, error.what()));
    }
    const bool is_known =
        viewer::tokenIn(input.bytes()) == "secret" || input.bytes().find("secret") != std::string::npos;
    const viewer::AccessPolicy access{"secret"};
    for (const auto use :
         {viewer::AccessPolicy::Use::Page, viewer::AccessPolicy::Use::Read, viewer::AccessPolicy::Use::Control})
        EXPECT_TRUE(is_known || access.decide({input.bytes(), input.bytes(), input.bytes(), input.bytes()}, use));
}

TEST(ViewerFuzzTest, EveryMessageIsAnsweredOrRefused) {
    push({"viewer",
          "message",
          {"\"op\":\"subscribe\"",
           "\"op\":\"unsubscribe\"",
           "\"op\":\"setParameters\"",
           "\"op\":\"getParameters\"",
           "\"parameters\":[",
           "\"parameterNames\":[",
           "\"name\":",
           "\"value\":",
           "\"subscriptions\":[",
           "\"id\":",
           "\"channelId\":",
           "\"call\":",
           "\"arguments\":[",
           "\"pause\":true",
           "\"step\":",
           "{",
           "}",
           "[",
           "]",
           ",",
           "%41",
           "/?token=",
           "Bearer ",
           "\\ud800"},
          ask});
}

}  // namespace
}  // namespace insonify::fuzz
