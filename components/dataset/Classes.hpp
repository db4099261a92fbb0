#pragma once
#include <string>
#include <vector>

#include "components/dataset/Sweep.hpp"

namespace insonify::dataset {

/** The classes of objects, numbered from 1; 0 is no class. */
class Classes {
public:
    /** Takes the rules of a sweep, of which the first match counts. Without rules an object's class is its name without
     *  the number at its end: "pile_07" is a "pile". With AnnotationConfig::shadows classes of shadows follow
     *  ("pile_shadow"), with AnnotationConfig::ghosts the class "ghost". Throws types::ConfigError if no pattern has
     *  a match, and for a class that has the name of a shadow or ghost class.
     *  @param objects names of all objects of all scenes
     *  @param nodes names of the nodes that have objects below them */
    Classes(const Sweep& sweep, const std::vector<std::string>& objects, const std::vector<std::string>& nodes = {});

    const std::vector<std::string>& names() const { return names_; }  ///< Names of the classes from 1 on.
    /** Returns the patterns without a match, with their places, and classes whose names are all of classes before. */
    const std::vector<std::string>& notices() const { return notices_; }
    uint32_t of(const std::string& object) const;
    /** Returns the class of the shadows of a class; 0 if shadows have no class. */
    uint32_t shadow(uint32_t category) const {
        return category == 0 || first_shadow_ == 0 ? 0 : first_shadow_ + category;
    }
    uint32_t ghost() const { return ghost_; }  ///< The class of ghosts; 0 if ghosts have no class.

private:
    void refuseTwice(const Sweep& sweep) const;
    void noteLost(const std::vector<std::string>& names);

    std::vector<ClassRule> rules_;
    std::vector<std::string> names_, notices_;
    uint32_t first_shadow_ = 0;  ///< Number of classes before those of shadows.
    uint32_t ghost_ = 0;
};

/** Returns a name without its number: "pile" for "pile_07", "pile.007" and "pile 7". A name of digits alone is
 *  unchanged. */
std::string withoutNumber(const std::string& name);

}  // namespace insonify::dataset
