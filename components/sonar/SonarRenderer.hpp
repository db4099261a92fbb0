#pragma once
#include <array>
#include <memory>
#include <span>
#include <vector>

#include "components/sonar/EchoRenderer.hpp"
#include "components/sonar/SonarConfig.hpp"
#include "types/Plan.hpp"
#include "types/Snapshot.hpp"
#include "types/Sonar.hpp"

namespace insonify::sonar {

/** Renders what a sonar hears of a geometry, noiseless, by rays or by drawing. Make it, use it and destroy it on one
 *  thread; one that draws is to be destroyed before another one is made there.
 *
 *      SonarRenderer renderer(config, geometry);
 *      renderer.render(snapshot, ping);    // ping.bins[beam * bin_count + bin]
 *
 *  Throws gpu::GlError where it draws without OpenGL 4.5 or loses it, std::runtime_error where Embree refuses. */
class SonarRenderer {
public:
    SonarRenderer(const SonarConfig& config, types::GeometryPtr geometry);
    ~SonarRenderer();

    /** One ping from snapshot.sonar (sonar frame in the world; orientation of unit length). Fills the whole sample;
     *  allocates nothing when `ping` has been filled by this renderer before. */
    void render(const types::Snapshot& snapshot, types::Sonar& ping);

    /** Renders from now on with so many rows of samples and columns per beam [1]; allocates. */
    void setQuality(int rows, int columns_per_beam);

    /** Where the time of the last ping went. */
    std::span<const Stage> stages() const;
    const RenderPlan& renderPlan() const;
    /** The same in words, with the device. */
    const types::Plan& plan() const;
    /** What is compiled into what renders. */
    Features compiled() const;
    /** Whether the last ping has any echo. */
    bool hasEchoes() const;
    /** What of the scene the last ping did not draw: objects, triangles, frusta; nothing with rays. */
    std::vector<LeftOut> culled() const;
    const std::string& device() const;  ///< What renders, with its driver.

private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace insonify::sonar
