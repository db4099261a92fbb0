#pragma once
#include <map>
#include <string>
#include <vector>

#include "components/framework/ConfigReader.hpp"
#include "components/framework/DeploymentSpec.hpp"

namespace insonify::framework {

/** Puts the properties of a deployment's tasks together: what stands in the deployment, over it the sections of
 *  property files, over that `--set`; of two values for one property the later counts, blocks are merged, lists element
 *  by element. A property with an alias goes to where the alias leads, with the place where it was written; one of
 *  `copies` stays as well; one of `switches` puts an empty block in there, or takes the block out, once all else is in
 *  its place; one of `ignored_properties` is left out. */
class PropertySources {
public:
    explicit PropertySources(DeploymentSpec& spec) : spec_(spec) {}
    /** Of the deployment and its property files. */
    void apply();
    /** Of `--set`, as a live setter has it: blocks are merged, all else takes the place of what is there, null takes it
     *  out. @param from where the value stands; with `--set` it has no place but its path in the deployment */
    void set(TaskSpec& task, const std::string& property, const YAML::Node& value,
             const Origin& from = {set_origin, ""});

private:
    /** A value that goes to another place than where it stands. */
    struct Moved {
        std::string target;  ///< "task.property"
        YAML::Node value;
        Origin origin;
        bool is_switch;
    };
    /** `block` without the values that have an alias or are ignored; the former, and those that are copied, are added
     *  to `moved`. */
    YAML::Node withoutAliases(TaskSpec& task, const YAML::Node& block, const std::string& path, const Origin& origin,
                              std::vector<Moved>& moved);
    void applyFiles(TaskSpec& task);
    /** Lays values where they lead; of switches the last is kept, for turn(). */
    void move(const std::vector<Moved>& moved);
    void turn(const std::string& target, bool on, const Origin& origin);
    /** Lays `over` on the properties of `task` at `path`. */
    void lay(TaskSpec& task, const std::string& path, const YAML::Node& over, const Origin& origin);
    YAML::Node laid(const YAML::Node& base, const YAML::Node& over, const std::string& path, const Origin& origin);
    /** What becomes of `base` with `over` set. */
    YAML::Node set(const YAML::Node& base, const YAML::Node& over, const std::string& path, const Origin& origin);
    void checkTargets();

    DeploymentSpec& spec_;
    std::map<std::string, std::pair<bool, Origin>> switches_;  ///< By target.
};

}  // namespace insonify::framework
