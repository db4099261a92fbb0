#include "components/deployer/Import.hpp"

#include "components/loader/ComponentLibrary.hpp"

namespace insonify::deployer {

Imported importOculus(const std::filesystem::path& recording, framework::DeploymentSpec spec,
                      const std::filesystem::path& to) {
    using Import =
        void(const std::filesystem::path&, framework::DeploymentSpec, const std::filesystem::path&, Imported&);
    Imported imported;
    loader::load("device").entry<Import>("insonify_import_oculus")(recording, std::move(spec), to, imported);
    return imported;
}

}  // namespace insonify::deployer
