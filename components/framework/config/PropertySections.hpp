#pragma once
#include <yaml-cpp/yaml.h>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "types/text/ConfigError.hpp"

namespace insonify::framework {

/** One section of a property file. */
struct PropertySection {
    std::string name, file;
    int line = 0;  ///< Line of its header, from 1.
    bool merge = true;
    std::vector<std::string> chain;
    YAML::Node body;
};

/** Rock's property files: sections of YAML, each headed by `--- name:NAME [merge:false] [chain:a,b]`.
 *
 *  A file may begin with the section `default` without a header. A section of a later file is merged over the sections
 *  of its name in earlier files; with `merge:false` it replaces them. The sections that a section chains are its base,
 *  below it. Ruby (`<%= %>`) is not run. */
class PropertySections {
public:
    /** Reads a file, named `shown` in diagnostics, which are collected. */
    void read(const std::filesystem::path& file, const std::string& shown);
    /** Returns the sections of `names` with their chained sections, the lowest first. */
    std::vector<const PropertySection*> inOrder(const std::vector<std::string>& names);
    const types::Diagnostics& diagnostics() const { return diagnostics_; }
    std::vector<std::string> names() const;
    bool contains(const std::string& name) const { return sections_.count(name) > 0; }

private:
    void take(PropertySection section, const std::string& body);
    PropertySection header(const std::string& line, const std::string& file, int number);
    void addChained(const std::string& name, std::vector<std::string>& open, std::vector<const PropertySection*>& all);
    void report(const std::string& file, int line, const std::string& path, const std::string& message);

    std::map<std::string, std::vector<PropertySection>> sections_;
    types::Diagnostics diagnostics_;
};

}  // namespace insonify::framework
