#pragma once
#include <array>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "components/sonar/EchoRenderer.hpp"
#include "components/sonar/plan/SonarConfig.hpp"
#include "types/Plan.hpp"
#include "types/Snapshot.hpp"
#include "types/Sonar.hpp"
#include "types/SonarElements.hpp"

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
    SonarRenderer(const SonarConfig& config, types::GeometryPtr geometry, const RenderOptions& options = {});
    ~SonarRenderer();

    /** One ping from snapshot.sonar (sonar frame in the world; orientation of unit length). Fills the whole sample;
     *  allocates nothing when `ping` has been filled by this renderer before. */
    void render(const types::Snapshot& snapshot, types::Sonar& ping);

    /** Each time that `ping` is rendered from now on, `truth` is filled as well, with what its bins show
     *  (types::SonarTruth; its list of names is left alone); null: no more. Other pings tell nothing, and nothing is
     *  computed or kept for them. Of a beam that is formed from finer azimuth cells, the truth is that of the cells
     *  within half its spacing to its neighbours: what it hears in its sidelobes is not told, nor what the pulse
     *  spreads into a bin, nor what the water scatters. */
    void setTruth(const types::Sonar& ping, types::SonarTruth* truth);

    /** Of a sonar with `elements`: what they heard of `ping`, the last that was rendered. Takes some time and
     *  allocates. Throws std::logic_error where the sonar has none. */
    void takeElements(const types::Sonar& ping, types::SonarElements& signals);

    /** Forgets all pings, as if it had just been made. Returns false where another one has to be made: with motion in
     *  a ping, bent rays, or where it draws. */
    bool forget();

    /** Renders another geometry from now on, at the quality in force. Threads, and with rays whatever is made of meshes
     *  that both geometries have, are kept. Takes more time where materials change, or where it draws. Returns
     *  whether the plan is another one. */
    bool setGeometry(types::GeometryPtr geometry);

    /** Renders from now on with so many rows of samples and columns per beam [1]; allocates. */
    void setQuality(int rows, int columns_per_beam);

    /** Where the time of the last ping went. */
    std::span<const Stage> stages() const;
    const RenderPlan& renderPlan() const;
    /** The same in words, with the device. */
    const types::Plan& plan() const;
    /** Whether the last ping has any echo of a surface. */
    bool hasEchoes() const;
    /** What the last ping left out: objects, triangles and pictures that were not drawn, point targets that are not
     *  heard or not there, a water surface that does not reflect. */
    std::vector<LeftOut> leftOut() const;
    /** Of how many things other than surfaces the last ping has an echo: point targets [1]. */
    size_t othersHeard() const;
    const std::string& device() const;  ///< What renders, with its driver.

private:
    struct Parts;
    /** What comes into the bins beside the echoes of surfaces. */
    void finish(const types::Snapshot& snapshot, types::Sonar& ping);
    std::unique_ptr<Parts> parts_;
};

}  // namespace insonify::sonar
