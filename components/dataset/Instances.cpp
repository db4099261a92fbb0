#include "components/dataset/Instances.hpp"

#include <algorithm>
#include <map>

namespace insonify::dataset {

Instances::Instances(const Classes& classes, const std::vector<Lineage>& objects) {
    std::map<std::string, int32_t> first_of;
    for (const Lineage& names : objects) {
        const auto hasClass = [&](const std::string& name) { return classes.of(name) != 0; };
        const auto nearest = std::ranges::find_if(names, hasClass);
        const uint32_t category = nearest == names.end() ? 0 : classes.of(*nearest);
        std::string name = names.front();
        for (auto above = nearest; above != names.end(); ++above)
            if (classes.of(*above) == category) name = *above;
        const auto object = static_cast<int32_t>(instances_.size());
        const int32_t first = category == 0 ? object : first_of.try_emplace(name, object).first->second;
        instances_.push_back({first, std::move(name), category, classes.shadow(category)});
    }
}

std::vector<int32_t> Instances::parts(int32_t instance) const {
    std::vector<int32_t> all;
    for (size_t i = 0; i < instances_.size(); ++i)
        if (instances_[i].first == instance) all.push_back(static_cast<int32_t>(i));
    return all;
}

}  // namespace insonify::dataset
