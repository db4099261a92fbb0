#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <variant>

#include "components/mcap/Config.hpp"
#include "components/pocolog/Metadata.hpp"
#include "components/pocolog/SampleTypes.hpp"

namespace insonify::logger {

template <class Types>
struct AnyCarried;
template <class... T>
struct AnyCarried<std::tuple<T...>> {
    using type = std::variant<pocolog::Carried<T>...>;
};
/** Any sample that a log takes, as it travels on ports; alternatives as in pocolog::SampleTypes. */
using AnySample = AnyCarried<pocolog::SampleTypes>::type;

/** A log of one format or the other, that is being written: see pocolog::Writer, mcap::SampleWriter. */
class LogFile {
public:
    virtual ~LogFile() = default;

    /** Declares a stream of the type at this place in pocolog::SampleTypes. */
    virtual size_t addStream(size_t type, const std::string& name, const pocolog::Metadata& metadata) = 0;
    virtual void write(size_t stream, types::Time received, const AnySample& sample) = 0;
    virtual void flush() = 0;
    virtual void close() = 0;
    virtual void next(std::filesystem::path path) = 0;
    virtual const std::filesystem::path& path() const = 0;
    virtual uint64_t size() const = 0;  ///< [B]
    virtual uint64_t kept() const = 0;  ///< Samples that were flushed, in all files [1].
};

/** The format follows from the name: *.mcap or pocolog. Throws ConfigError when the file cannot be created. */
std::unique_ptr<LogFile> createLog(const std::filesystem::path& path, const mcap::McapConfig& mcap);

}  // namespace insonify::logger
