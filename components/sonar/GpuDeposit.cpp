#include <cmath>
#include <string>

#include "components/gpu/EglContext.hpp"
#include "components/gpu/Program.hpp"
#include "components/sonar/BinDeposit.hpp"

namespace insonify::sonar {
namespace {

/** Tells the device a list, which has its whole room already, and binds it. */
template <class T>
void give(const std::vector<T>& items, gpu::Buffer& buffer, GLuint binding) {
    if (buffer.bytes() < items.capacity() * sizeof(T)) buffer = gpu::Buffer(items.capacity() * sizeof(T));
    if (!items.empty()) buffer.write(items.data(), items.size() * sizeof(T));
    buffer.bindBase(GL_SHADER_STORAGE_BUFFER, binding);
}

/** The deposit as a compute shader: pictures stay on the device, only the sums come back. */
class GpuDeposit final : public BinDeposit {
public:
    GpuDeposit(const DepositSetup& setup, const gpu::EglContext& context);
    void begin() override { cleared_ = false; }
    void take(size_t slab, const SurfacePass& surface) override;
    std::span<const uint64_t> finish() override;

private:
    struct SlabShares {
        gpu::Buffer starts, shares, commands;
    };
    void setUniforms(const Slab& slab, bool shares_per_row) const;
    GLint uniform(const char* name) const { return glGetUniformLocation(program_.id(), name); }

    DepositSetup setup_;
    const gpu::EglContext& context_;
    gpu::Program program_;
    gpu::Buffer edges_, objects_, device_sums_;
    std::vector<SlabShares> shares_;
    std::vector<uint64_t> sums_;
    bool cleared_ = false;
};

GpuDeposit::GpuDeposit(const DepositSetup& setup, const gpu::EglContext& context)
    : setup_(setup), context_(context), sums_(setup.sumCount()) {
    std::vector<std::string> defines;
    if (setup.model == Model::Cerqueira2017) defines.push_back("HAVE_CERQUEIRA2017");
    if (setup.published) defines.push_back("HAVE_PUBLISHED");
    if (setup.estimator != Estimator::Footprint) defines.push_back("HAVE_NEAREST");
    if (setup.estimator == Estimator::NearestJitter) defines.push_back("HAVE_JITTER");
    program_ = gpu::Program::compute("deposit.comp.glsl", defines);
    const auto edges = inverseEdges(setup.bins);
    edges_ = gpu::Buffer::of(std::span(edges));
    device_sums_ = gpu::Buffer(sums_.size() * sizeof(uint64_t));
    for (const ColumnShares& slab : setup.shares)
        shares_.push_back({gpu::Buffer::of(std::span(slab.starts)), gpu::Buffer::of(std::span(slab.shares)), {}});
}

void GpuDeposit::setUniforms(const Slab& slab, bool shares_per_row) const {
    glUniform2i(uniform("image_size"), slab.columns, slab.rows);
    glUniform1i(uniform("shares_per_row"), shares_per_row);
    glUniform1ui(uniform("bin_count"), static_cast<GLuint>(setup_.bins.bin_count));
    glUniform1d(uniform("bin_width"), setup_.bins.bin_width);
    glUniform1d(uniform("attenuation"), setup_.attenuation);
    glUniform1d(uniform("strength_scale"), setup_.strength_scale);
    glUniform2d(uniform("slab_axis"), std::cos(slab.azimuth), std::sin(slab.azimuth));
    glUniform2d(uniform("extent"), slab.extent_u, slab.extent_v);
    glUniform2d(uniform("pixel_size"), slab.du(), slab.dv());
}

void GpuDeposit::take(size_t slab, const SurfacePass& surface) {
    if (!std::exchange(cleared_, true)) device_sums_.clear();
    give(surface.objects(), objects_, OBJECTS_BINDING);
    give(surface.picture(slab).commands, shares_[slab].commands, COMMANDS_BINDING);
    program_.use();
    setUniforms(setup_.slabs[slab], setup_.shares[slab].per_row);
    surface.bindResults(slab);
    shares_[slab].shares.bindBase(GL_SHADER_STORAGE_BUFFER, SHARES_BINDING);
    shares_[slab].starts.bindBase(GL_SHADER_STORAGE_BUFFER, SHARE_STARTS_BINDING);
    edges_.bindBase(GL_SHADER_STORAGE_BUFFER, EDGES_BINDING);
    device_sums_.bindBase(GL_SHADER_STORAGE_BUFFER, SUMS_BINDING);
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_FRAMEBUFFER_BARRIER_BIT);
    const auto groups = [](int pixels) { return static_cast<GLuint>((pixels + 7) / 8); };
    glDispatchCompute(groups(setup_.slabs[slab].columns), groups(setup_.slabs[slab].rows), 1);
}

std::span<const uint64_t> GpuDeposit::finish() {
    const auto alone = context_.transferring();
    if (!std::exchange(cleared_, false)) device_sums_.clear();  // no slab held anything
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    device_sums_.read(sums_.data(), sums_.size() * sizeof(uint64_t));
    return sums_;
}

}  // namespace

std::unique_ptr<BinDeposit> makeGpuDeposit(const DepositSetup& setup, const gpu::EglContext& context) {
    return std::make_unique<GpuDeposit>(setup, context);
}

}  // namespace insonify::sonar
