#include "components/logger/LogFile.hpp"

#include "components/mcap/LogSource.hpp"
#include "components/mcap/SampleWriter.hpp"
#include "components/pocolog/Writer.hpp"

namespace insonify::logger {
namespace {

template <class Writer>
class TypedLog final : public LogFile {
public:
    template <class... Arguments>
    explicit TypedLog(Arguments&&... arguments) : writer_(std::forward<Arguments>(arguments)...) {}

    size_t addStream(size_t type, const std::string& name, const pocolog::Metadata& metadata) override {
        size_t number = 0;
        pocolog::forEachSampleType([&, place = size_t{0}]<class T>(std::type_identity<T>) mutable {
            if (place++ == type) number = writer_.template addStream<T>(name, metadata);
        });
        return number;
    }
    void write(size_t stream, types::Time received, const AnySample& sample) override {
        std::visit([&](const auto& held) { writer_.write(stream, received, pocolog::carriedSample(held)); }, sample);
    }
    void flush() override { writer_.flush(); }
    void close() override { writer_.close(); }
    void next(std::filesystem::path path) override { writer_.next(std::move(path)); }
    const std::filesystem::path& path() const override { return writer_.path(); }
    uint64_t size() const override { return writer_.size(); }
    uint64_t kept() const override { return writer_.kept(); }

private:
    Writer writer_;
};

}  // namespace

std::unique_ptr<LogFile> createLog(const std::filesystem::path& path, const mcap::McapConfig& mcap) {
    if (mcap::isMcap(path)) return std::make_unique<TypedLog<mcap::SampleWriter>>(path, mcap);
    return std::make_unique<TypedLog<pocolog::Writer>>(path);
}

}  // namespace insonify::logger
