#pragma once
#include <string>
#include <vector>

#include "components/dataset/Sweep.hpp"

namespace insonify::dataset {

/** The classes that objects belong to, numbered from 1; 0 is no class. */
class Classes {
public:
    /** By the rules of a sweep, of which the first that matches counts; without any, an object's class is its name
     *  without the number at its end: "pile_07" is a pile. With AnnotationConfig::shadows the classes of their shadows
     *  follow, "pile_shadow", with AnnotationConfig::ghosts the class "ghost". Throws types::ConfigError for a pattern
     *  that matches none, and for a class named like one of these.
     *  @param objects names of all objects of all scenes; @param nodes those of nodes that have objects below them */
    Classes(const Sweep& sweep, const std::vector<std::string>& objects, const std::vector<std::string>& nodes = {});

    const std::vector<std::string>& names() const { return names_; }  ///< Of class 1 and on.
    uint32_t of(const std::string& object) const;
    /** The class of the shadows of a class; 0 where shadows have none. */
    uint32_t shadowOf(uint32_t category) const {
        return category == 0 || first_shadow_ == 0 ? 0 : first_shadow_ + category;
    }
    uint32_t ghost() const { return ghost_; }  ///< 0: ghosts have none.

private:
    void refuseTwice(const Sweep& sweep) const;

    std::vector<ClassRule> rules_;
    std::vector<std::string> names_;
    uint32_t first_shadow_ = 0;  ///< Number of classes before those of shadows.
    uint32_t ghost_ = 0;
};

/** "pile" of "pile_07", "pile.007" and "pile 7"; a name of digits alone stays. */
std::string withoutNumber(const std::string& name);

}  // namespace insonify::dataset
