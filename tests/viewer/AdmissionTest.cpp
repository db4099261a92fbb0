#include <gtest/gtest.h>

#include "components/viewer/Admission.hpp"

namespace insonify::viewer {
namespace {

unsigned judged(const std::string& token, const Admission::Request& request, bool secret = true, bool steers = true) {
    const auto refusal = Admission{token}.judge(request, secret, steers);
    return refusal ? refusal->status : 200;
}

TEST(AdmissionTest, ATokenComesInTheQueryOrAsABearer) {
    EXPECT_EQ(judged("a b", {"/?x=1&token=a%20b", "far.example", "", ""}), 200u);
    EXPECT_EQ(judged("ab", {"/", "far.example", "", "Bearer ab"}), 200u);
    EXPECT_EQ(judged("ab", {"/?token=ax", "127.0.0.1", "", ""}), 401u);
    EXPECT_EQ(judged("ab", {"/?token=", "127.0.0.1", "", ""}), 401u);
    EXPECT_EQ(judged("ab", {"/?token=abc", "127.0.0.1", "", ""}), 401u);
    EXPECT_EQ(judged("ab", {"/", "127.0.0.1", "", ""}), 401u);
    EXPECT_EQ(judged("ab", {"/fan.js", "127.0.0.1", "", ""}, false, false), 200u)
        << "files of the page hold nothing secret";
}

TEST(AdmissionTest, WithoutATokenOnlyPagesOfThisServerSteer) {
    EXPECT_EQ(judged("", {"/", "127.0.0.1:8765", "http://127.0.0.1:8765", ""}), 200u);
    EXPECT_EQ(judged("", {"/", "[::1]:8765", "http://[::1]:8765", ""}), 200u);
    EXPECT_EQ(judged("", {"/", "127.0.0.1:8765", "", ""}), 200u) << "a program, no browser";
    EXPECT_EQ(judged("", {"/", "127.0.0.1:8765", "http://evil.example", ""}), 403u);
    EXPECT_EQ(judged("", {"/", "127.0.0.1:8765", "http://evil.example", ""}, true, false), 200u)
        << "Foxglove only reads";
    EXPECT_EQ(judged("", {"/", "evil.example:8765", "http://evil.example:8765", ""}), 403u)
        << "a name that leads here today";
}

}  // namespace
}  // namespace insonify::viewer
