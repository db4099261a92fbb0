// Requests of clients to the HTTP API of a Sonar 3D-15.
#include <gtest/gtest.h>

#include "components/device/sonar3d/Sonar3dEmulator.hpp"
#include "tests/support/Fuzz.hpp"

namespace insonify::fuzz {
namespace {

void expectSound(const device::Sonar3dState& state) {
    EXPECT_TRUE(state.range_min >= 0 && state.range_min < state.range_max && state.range_max <= 15);
    EXPECT_TRUE(state.speed_of_sound == 0 || (state.speed_of_sound >= 1000 && state.speed_of_sound <= 2000));
    EXPECT_TRUE(state.udp_mode == "multicast" || state.udp_mode == "disabled" || state.unicast_port > 0);
}

void readSonar3d(const Input& input) {
    device::Sonar3dEmulator sonar({}, {[](const types::SonarSettings& asked) { EXPECT_TRUE(asked.range > 0); },
                                       [](const std::string& address, uint16_t port, device::Bytes) {
                                           EXPECT_FALSE(address.empty());
                                           EXPECT_GT(port, 0);
                                       },
                                       [](const std::string&) {}});
    device::HttpReader reader;
    const auto bytes = input.octets();
    types::Time now{1'700'000'000'000'000};
    for (size_t at = 0; at < bytes.size(); at += 1000) {
        reader.add(bytes.subspan(at, std::min<size_t>(1000, bytes.size() - at)));
        while (const auto request = reader.next()) {
            const device::HttpReply reply = sonar.answer(*request, now);
            EXPECT_TRUE(reply.status == 200 || reply.status == 204 || (reply.status >= 400 && reply.status < 410));
            EXPECT_EQ(reply.status == 204, reply.body.empty());
            if (reply.status >= 400) expectOurWords(reply.body);
            device::httpBytes(reply, request->keep_alive);
            expectSound(sonar.state());
            now = now + types::Time::fromSeconds(0.1);
            sonar.tick(now);
            types::DepthMap silence;
            silence.time = now;
            sonar.setPing(silence);
        }
    }
    EXPECT_TRUE(!reader.refusal() || reader.refusal()->status >= 400);
}

TEST(Sonar3dFuzzTest, EveryRequestIsAnsweredAndNoneSetsWhatTheDeviceCannotHave) {
    push({"sonar3d",
          "requests.http",
          {"POST /api/v1/integration/",
           "GET ",
           " HTTP/1.1\r\n",
           "\r\n\r\n",
           "Content-Length: 4\r\n",
           "Transfer-Encoding: chunked\r\n",
           "acoustics/range",
           "acoustics/speed_of_sound",
           "acoustics/mode",
           "udp",
           "time/manual",
           "time/ntp/force-sync",
           "{\"min\":0,\"max\":",
           "[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[",
           "]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]",
           "{\"a\":{\"a\":{\"a\":{\"a\":{\"a\":{\"a\":{\"a\":{\"a\":",
           "\"high-frequency\"",
           "true",
           "1e308",
           "-1",
           "unicast_destination_ip",
           "unicast_destination_port",
           "2026-01-01T00:00:00Z"},
          readSonar3d});
}

}  // namespace
}  // namespace insonify::fuzz
