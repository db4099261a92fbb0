#pragma once
#include <memory>
#include <span>
#include <vector>

#include "components/sonar/config/SonarConfig.hpp"
#include "components/sonar/plan/EchoRenderer.hpp"
#include "types/geometry/Snapshot.hpp"
#include "types/samples/Plan.hpp"
#include "types/samples/Sonar.hpp"
#include "types/samples/SonarElements.hpp"

namespace insonify::sonar {

/** Renders the noiseless pings of a sonar in a geometry, ray-traced or rasterised. Use it from one thread at a time.
 * Make, use and destroy a renderer that rasterises on one thread, and destroy it before making another on that thread.
 *
 *      SonarRenderer renderer(config, geometry);
 *      renderer.render(snapshot, ping);    // ping.bins[beam * bin_count + bin]
 *
 *  Throws gpu::GlError where it rasterises without OpenGL 4.5 or loses it, std::runtime_error where Embree refuses. */
class SonarRenderer {
public:
    SonarRenderer(const SonarConfig& config, types::GeometryPtr geometry, const RenderOptions& options = {});
    ~SonarRenderer();

    /** Renders one ping from snapshot.sonar (sonar frame in the world; orientation of unit length). Fills the whole
     *  sample. Allocates nothing when this renderer has filled `ping` before. */
    void render(const types::Snapshot& snapshot, types::Sonar& ping);

    /** Fills everything of a ping except its bins, which get their number. */
    void fillHeader(const types::Snapshot& snapshot, types::Sonar& ping) const;

    /** Returns whether a later ping may depend on this one: sonar or objects move, or sound paths bend. */
    bool isRemembered(const types::Snapshot& snapshot) const;
    /** Does only the part of a ping on which later pings depend. */
    void follow(const types::Snapshot& snapshot);

    /** Makes each later rendering of `ping` fill `truth` with what its bins show (types::SonarTruth; its list of names
     *  is left alone). Null: no more. Other pings have no truth, and nothing is computed or kept for them. A beam is
     *  formed from finer azimuth cells; its truth covers the cells up to halfway to the neighbouring beams. Echoes that
     *  arrive through sidelobes, or that the pulse spreads into a bin, have no truth. */
    void setTruth(const types::Sonar& ping, types::SonarTruth* truth);

    /** Makes each later rendering of `ping` fill `signals` with those of the array's elements, which takes some time
     * and allocates. Null: no more. Throws std::logic_error where the sonar has no `elements`. */
    void setElements(const types::Sonar& ping, types::SonarElements* signals);

    /** Fills the bins of `alike`, with the shape of the ping, with what every beam of the last ping records alike,
     *  whatever it looks at: the ring-down of the transmitter. Returns false, and changes nothing, where there is none.
     *  Allocates nothing when it has filled `alike` before. */
    bool computeAlike(const types::Sonar& ping, types::Sonar& alike) const;

    /** Forgets all pings, as if it had just been made. Returns false where a new renderer is needed: with motion in a
     *  ping, with bent rays, or where it rasterises. */
    bool forget();

    /** Switches to another geometry, at the current quality. Keeps threads and, with rays, the data of meshes that both
     *  geometries have. Takes more time where materials change, or where it rasterises. Returns whether the plan has
     *  changed. */
    bool setGeometry(types::GeometryPtr geometry);

    /** Switches to another configuration, such as another range, and forgets all pings. With rays it keeps threads and
     *  the data of the scene. Allocates memory. Throws as the constructor does; a configuration that cannot be planned
     *  changes nothing. */
    void setConfig(const SonarConfig& config);

    /** Switches to this number of rows of samples and columns per beam [1]. Allocates memory. */
    void setQuality(int rows, int columns_per_beam);

    /** Returns the time that the last ping spent in each stage. */
    std::span<const Stage> stages() const;
    const RenderPlan& renderPlan() const;
    /** Returns the scene with deforming meshes in the shapes of the last ping. */
    const types::GeometryPtr& geometry() const;
    /** Returns the plan in words, with the device. */
    const types::Plan& plan() const;
    /** Returns whether the last ping has any echo of a surface. */
    bool hasEchoes() const;
    /** Returns what the last ping omitted: objects, triangles and images that were not rasterised, point targets
     *  without echo, or a water surface that does not reflect. */
    std::vector<Omitted> omissions() const;
    /** Returns the number of things other than surfaces, such as point targets, with an echo in the last ping [1]. */
    size_t othersReceived() const;
    const std::string& device() const;  ///< Name of the rendering device, with its driver.

private:
    struct Parts;
    void computeElements(const types::Sonar& ping, types::SonarElements& signals);
    /** Adds what the bins contain in addition to the echoes of surfaces. */
    void finish(const types::Snapshot& snapshot, types::Sonar& ping);
    std::unique_ptr<Parts> parts_;
};

}  // namespace insonify::sonar
