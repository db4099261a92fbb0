#pragma once
// A viewer on any free port, with a source of pings.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "components/viewer/ViewerTask.hpp"
#include "tests/support/Ports.hpp"
#include "tests/support/Waiting.hpp"

namespace insonify::viewer {

using test::becomesTrue;

/** 1 in bins 40 to 49 of beams 10 to 19, of 32 beams over 90 degrees and 100 bins of 0.15 m; 0 elsewhere. */
inline std::shared_ptr<types::Sonar> blockPing(int64_t time = 3'000'000, uint32_t beams = 32, uint32_t bins = 100) {
    auto ping = std::make_shared<types::Sonar>();
    ping->time = {time};
    ping->bin_duration = {100};
    ping->speed_of_sound = 1500;
    ping->resize(bins, beams);
    ping->setRegularBearings(types::Angle::fromDeg(-45 + 45.0 / beams), types::Angle::fromDeg(90.0 / beams));
    for (uint32_t beam = 0; beam < beams; ++beam)
        for (uint32_t bin = 0; bin < bins; ++bin)
            ping->bins[size_t{beam} * bins + bin] = beam >= 10 && beam < 20 && bin >= 40 && bin < 50 ? 1.0f : 0.0f;
    return ping;
}

template <class T>
struct Feed {
    test::Writer<T> writer;
    Feed(ViewerTask& viewer, const std::string& name) : writer(name) {
        writer.port.connectTo(*viewer.makeInput(name, writer.port), framework::ConnPolicy::buffer(64));
    }
    void write(const T& sample) { writer.port.write(sample); }
};

struct Bench {
    ViewerTask viewer{"viewer"};
    Feed<types::SonarPtr> sonar{viewer, "sonar"};

    /** Returns a configuration that disconnects no client: clients of these tests do not answer pings. */
    static ViewerConfig patient() {
        ViewerConfig config;
        config.idle_timeout = 3600;
        return config;
    }
    explicit Bench(ViewerConfig config = patient()) {
        config.port = 0;
        viewer.config.set(std::move(config));
        viewer.environment().now = [] { return types::Time{3'500'000}; };
    }
    void start() { ASSERT_TRUE(viewer.configure() && viewer.start()) << viewer.lastError(); }
    void show(const types::SonarPtr& ping) {
        sonar.write(ping);
        viewer.update();
    }
    uint16_t port() const { return viewer.port(); }
};

}  // namespace insonify::viewer
