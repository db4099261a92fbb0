#pragma once
#include <yaml-cpp/yaml.h>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "components/framework/config/ConfigReader.hpp"
#include "components/framework/config/DeploymentSpec.hpp"
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
    /** Reads the contents of a file, named `shown` in diagnostics, which are collected. */
    void read(const std::string& contents, const std::string& shown);
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

/** Merges the properties of a deployment's tasks: the deployment, over it the sections of property files, over them
 *  `--set`. Of two values for one property the later one counts. Blocks are merged, lists are merged element by
 *  element. A property with an alias is moved to the alias' target and keeps the place where it was written. A property
 *  in `copies` is copied. A property in `switches` inserts an empty block at its target or removes the block, after all
 *  other values. A property in `ignored_properties` is omitted. */
class PropertySources {
public:
    explicit PropertySources(DeploymentSpec& spec) : spec_(spec) {}
    /** Applies the values of the deployment and of its property files. */
    void apply();
    /** Applies a `--set`, with the rules of a live setter: blocks are merged, other values are replaced, null removes a
     *  value. @param from the value's place; for `--set`, only its path in the deployment */
    void set(TaskSpec& task, const std::string& property, const YAML::Node& value,
             const Origin& from = {set_origin, ""});

private:
    /** A value whose target differs from the place where it is written. */
    struct Moved {
        std::string target;  ///< "task.property"
        YAML::Node value;
        Origin origin;
        bool is_switch;
    };
    /** Returns `block` without aliased and ignored values. Adds aliased and copied values to `moved`. */
    YAML::Node withoutAliases(TaskSpec& task, const YAML::Node& block, const std::string& path, const Origin& origin,
                              std::vector<Moved>& moved);
    void applyFiles(TaskSpec& task);
    /** Applies moved values to their targets; keeps the last value of each switch for turn(). */
    void move(const std::vector<Moved>& moved);
    void turn(const std::string& target, bool on, const Origin& origin);
    /** Merges `over` into the properties of `task` at `path`. */
    void lay(TaskSpec& task, const std::string& path, const YAML::Node& over, const Origin& origin);
    YAML::Node laid(const YAML::Node& base, const YAML::Node& over, const std::string& path, const Origin& origin);
    /** Returns `base` with `over` set. */
    YAML::Node set(const YAML::Node& base, const YAML::Node& over, const std::string& path, const Origin& origin);
    void checkTargets();

    DeploymentSpec& spec_;
    std::map<std::string, std::pair<bool, Origin>> switches_;  ///< By target.
};

}  // namespace insonify::framework
